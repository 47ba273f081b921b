"""Warnings of what is possible, but probably not meant, about a bird."""

import pytest

from birdmb.studies.bird_warnings import bird_warnings, load_warnings
from birdmb.studies.refinement import LoadChange

POINTS = {f"segments.{bone}.inertia": [0, 0, 0] for bone in ("humerus", "forearm", "hand")}
MASSLESS = POINTS | {f"segments.{bone}.mass": 0 for bone in ("humerus", "forearm", "hand")}

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
        {"shoulder.flap.offset_deg": -90, "shoulder.flap.amplitude_deg": 100},
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
