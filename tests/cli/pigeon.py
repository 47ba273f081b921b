"""A bird as a beginner writes it by hand: it has no flight until it is trimmed."""

from pathlib import Path

# With this roll of the forearm it flies level, as `birdmb trim` found with the rigid model.
TRIMMED = ("--set", "forearm.roll.offset_deg=-9.83317")

PIGEON = """
name = "pigeon"

[gait]
frequency = 7.0

[body]
mass = 0.31
inertia_yy = 0.0009

[wing]
root = { x = 0.02, y = 0.02, z = -0.01 }
half_thickness = 0.005
discretisation = 12

[segments]
humerus = { length = 0.047, mass = 0.010, inertia = [2.0e-6, 1.0e-7, 2.0e-6] }
forearm = { length = 0.055, mass = 0.006, inertia = [1.6e-6, 1.0e-7, 1.6e-6] }
hand = { length = 0.040, mass = 0.004, inertia = [6.0e-7, 1.0e-7, 6.0e-7] }

[[joints]]
name = "shoulder.pitch"
segment = "humerus"
axis = [0, 1, 0]
offset_deg = 10

[[joints]]
name = "shoulder.flap"
segment = "humerus"
axis = [-1, 0, 0]
offset_deg = 5
amplitude_deg = 50
phase_deg = 180

[[joints]]
name = "shoulder.sweep"
segment = "humerus"
axis = [0, 0, -1]
offset_deg = -10
amplitude_deg = 15
phase_deg = 90

[[joints]]
name = "elbow.sweep"
segment = "forearm"
axis = [0, 0, -1]
offset_deg = 20
amplitude_deg = 20
phase_deg = -90

[[joints]]
name = "forearm.roll"
segment = "forearm"
axis = [0, 1, 0]
amplitude_deg = 25
phase_deg = -90
twist = true

[[joints]]
name = "wrist.sweep"
segment = "hand"
axis = [0, 0, -1]
offset_deg = -20
amplitude_deg = 20
phase_deg = 90

[[feathers]]
name = "root"
bone = "humerus"
position = 0
length = 0.09

[[feathers]]
name = "elbow"
bone = "humerus"
position = 1
length = 0.10
shares = { "elbow.sweep" = 0.5 }

[[feathers]]
name = "wrist"
bone = "forearm"
position = 1
length = 0.12
rest_angle_deg = 40
shares = { "wrist.sweep" = 0.5 }

[[feathers]]
name = "tip"
bone = "hand"
position = 1
length = 0.165
rest_angle_deg = 90
"""


def written(directory: Path) -> str:
    """The path of the pigeon's file, in a directory."""
    path = directory / "pigeon.toml"
    path.write_text(PIGEON, encoding="utf-8")
    return str(path)
