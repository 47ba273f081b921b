"""Warnings of what is possible, but probably not meant, about a bird."""

import tomllib

import numpy as np
import pytest

from birdmb.studies.bird_warnings import bird_warnings, load_warnings
from birdmb.studies.refinement import LoadChange
from birdmb.topology import Bird, load_bird

from ..cli.pigeon import PIGEON

BONES = ("humerus", "forearm", "hand")
POINTS = {f"segments.{bone}.inertia": [0, 0, 0] for bone in BONES}
MASSLESS = POINTS | {f"segments.{bone}.mass": 0 for bone in BONES}

# Where no feather reaches across the plane of symmetry, m.
WIDE = 0.08


def test_loads_that_change_much_are_told():
    assert load_warnings(LoadChange(64, 0.019, 0.0)) == []
    (force,) = load_warnings(LoadChange(64, 0.031, 0.0))
    assert "change by 3.1% on 64 elements" in force
    (circulation,) = load_warnings(LoadChange(64, 0.0, 0.05))
    assert "change by 5.0% on 64 elements" in circulation


# values, and what the only warning must say
CASES = {
    "feathers across the plane": (
        {"wing.root.y": 0.05},
        "the tip of feather 7 reaches 19.2 mm across the plane of symmetry at t = 0.5 T",
    ),
    "a line across the plane": ({"wing.root.y": 0.005}, "wing.root.y must be 0.0166 m or more"),
    "no gap over the body": ({"wing.root.y": 0.0}, "wing.root.y must be 0.0166 m or more"),
    "wings through one another": (
        {"shoulder.flap.offset_deg": -85, "shoulder.flap.amplitude_deg": 85},
        "the wings swing through one another",
    ),
    "feathers forwards": (
        {f"feathers.{name}.rest_angle_deg": 180 for name in "7531"},
        "feathers point forwards",
    ),
    "none": ({}, None),
    "no gravity": ({"gravity": 0}, "gravity is 0"),
    "no air": ({"air.density": 0}, "air.density is 0"),
    "prescribed with a spring": (
        {"wrist.sweep.stiffness": 1, "wrist.sweep.mode": "prescribed"},
        "wrist.sweep is prescribed: its stiffness and damping are not used",
    ),
    "no mass": (
        MASSLESS | {"shoulder.flap.stiffness": 20},
        "shoulder.flap is compliant, but moves no mass",
    ),
    "points on the axis": (
        POINTS | {"forearm.roll.stiffness": 1, "wrist.sweep.offset": 0},
        "forearm.roll is compliant, but moves no mass",
    ),
    "no spring": ({"shoulder.flap.stiffness": 0}, "nothing pulls it towards its driver"),
    "resonance": ({"shoulder.flap.stiffness": 1}, "close to the wingbeat of 4 Hz"),
    "folded too far": (
        {"elbow.sweep.offset_deg": 150},
        "no line orthogonal to its chords fits the wing",
    ),
    "a glider": (
        {
            f"{joint}.amplitude": 0
            for joint in (
                "shoulder.pitch",
                "shoulder.flap",
                "shoulder.sweep",
                "elbow.sweep",
                "forearm.roll",
                "wrist.sweep",
            )
        },
        "the bird glides",
    ),
    "in mercury": (
        {"air.kinematic_viscosity": 1.1e-7},
        "the Reynolds number of the mean chord is 1.8e+07 at",
    ),
    "fast beats": ({"gait.frequency": 7.5}, "the reduced frequency is 0.21 at 14.7 m/s"),
    "degrees taken for rad": (
        {"elbow.sweep.amplitude": 1.6},
        "elbow.sweep turns through 183.3 degrees in a beat",
    ),
    "an offset in degrees taken for rad": (
        {"shoulder.pitch.offset": 4 * np.pi},
        "shoulder.pitch gets to 720.8 degrees, more than half a turn",
    ),
    "no amplitude, but harmonics": (
        {"shoulder.flap.amplitude": 0, "shoulder.flap.harmonics": [{"order": 1, "sine": -0.5}]},
        None,
    ),
    "a rough motion": (
        {"shoulder.flap.harmonics": [{"order": 12, "amplitude_deg": 0.5}]},
        "the driver of shoulder.flap moves in harmonics up to order 12 of the beat, rough for the "
        "usual 60 time steps a beat: let models take steps_per_beat=120 or more",
    ),
    "a faint high harmonic": (
        {"shoulder.flap.harmonics": [{"order": 12, "amplitude_deg": 0.05}]},
        None,
    ),
    "a short downstroke": ({"shoulder.flap.downstroke_fraction": 0.35}, None),
}


@pytest.mark.parametrize(("values", "says"), CASES.values(), ids=CASES)
def test_warnings(ibis, values, says):
    warnings = bird_warnings(ibis.with_values({"wing.root.y": WIDE} | values))
    assert len(warnings) == (says is not None), warnings
    assert says is None or says in warnings[0]


def test_a_pigeon_is_told_of_its_wings_through_one_another():
    pigeon = Bird.model_validate(tomllib.loads(PIGEON))
    (warning,) = bird_warnings(pigeon)
    assert "the tip of feather root reaches 20 mm across the plane of symmetry" in warning
    above = pigeon.with_values({"shoulder.flap.offset_deg": 60})
    assert "swing through one another" in bird_warnings(above)[0]


def test_each_side_has_its_own_motion(ibis):
    bird = ibis.with_values({"wing.root.y": WIDE, "elbow.sweep.left.amplitude": 1.6})
    assert any(w.startswith("elbow.sweep.left turns through 183") for w in bird_warnings(bird))


def test_a_wing_of_sections_that_crosses_the_plane_is_told_by_its_section():
    gull = load_bird("gull_glider").with_values({"shoulder.sweep.offset_deg": -40.0})
    (warning,) = [text for text in bird_warnings(gull) if "across the plane" in text]
    assert warning.startswith("the trailing end of section root reaches ")


def test_what_a_wing_of_sections_has_no_use_for_is_told():
    gull = load_bird("gull_glider").with_values({"wing.half_thickness": 0.01})
    told = "wing.half_thickness: not used, for sections span the wing. Leave it out."
    assert told in bird_warnings(gull)
