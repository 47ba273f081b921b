"""Points on the wing of the package's pigeon as cameras see them: `examples/pigeon_points.csv`.

python examples/pigeon_points.py [FILE]

Four beats at 240 frames a second, the bird flying past at 12 m/s, 1 mm of noise on every
coordinate, and a gap where the wrist was hidden. Axes: x forwards, y to the left, z up. A stand-in
for a measurement: `birdmb kinematics` gives back the gait that is put in here.
"""

import csv
import sys
from pathlib import Path

import numpy as np

import birdmb
from birdmb.aerodynamics.prescribed import driver_motion
from birdmb.wing.chain import joint_chain
from birdmb.wing.edges import feather_ends

RATE, FRAMES, SPEED, NOISE = 240.0, 140, 12.0, 1e-3
HIDDEN = range(60, 66)  # frames without the wrist


def points(model: birdmb.RigidModel, t: float) -> dict[str, np.ndarray]:
    """Markers (3,) m at t (s), body axes from the centre of mass."""
    angles = driver_motion(model.wing, t)[0].astype(complex)
    chain = joint_chain(model.wing, angles)
    _, tips = feather_ends(model.wing, chain, angles)
    places = {
        "shoulder": np.zeros(3),
        "elbow": chain.origin[1],
        "wrist": chain.origin[2],
        "hand_tip": chain.tip,
    }
    names = (f"feathers.{feather.name}" for feather in model.bird.feathers)
    places |= dict(zip(names, tips, strict=True))
    return {name: model.wing.root + place.real for name, place in places.items()}


def main(file: Path) -> None:
    """Write the table."""
    model = birdmb.RigidModel(birdmb.load_bird("pigeon"))
    noise = np.random.default_rng(20_0300)
    rows = []
    for frame in range(FRAMES):
        t = frame / RATE
        row = [f"{t:.5f}"]
        for name, place in points(model, t).items():
            x, y, z = place + noise.normal(0.0, NOISE, 3)
            seen = (x + SPEED * t, -y, -z)
            hidden = name == "wrist" and frame in HIDDEN
            row += ["" if hidden else f"{value:.4f}" for value in seen]
        rows.append(row)
    header = ["time", *(f"{name}_{axis}" for name in points(model, 0.0) for axis in "xyz")]
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("w", newline="", encoding="utf-8") as out:
        csv.writer(out).writerows([header, *rows])


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_suffix(".csv"))
