"""`birdmb check`: what the bird is, and what to beware of."""

import math

import pytest

from birdmb import load_bird
from birdmb.cli.inertia import spring_of
from birdmb.cli.warnings import warnings_on, warnings_on_loads
from birdmb.studies.refinement import LoadChange

from .conftest import COMPLIANT, HINGED, IBIS

POINTS = {f"segments.{bone}.inertia": [0, 0, 0] for bone in ("humerus", "forearm", "hand")}
MASSLESS = POINTS | {f"segments.{bone}.mass": 0 for bone in ("humerus", "forearm", "hand")}

# Where no feather reaches across the plane of symmetry, m.
WIDE = 0.08


def test_what_the_bird_is(run):
    result = run("check", COMPLIANT, "--set", f"wing.root.y={WIDE}")
    assert result.exit_code == 0, result.stderr
    rows = [" ".join(line.split()) for line in result.stdout.splitlines()]
    for row in (
        "mass of the whole bird 1.26 kg",
        "span, joints at zero 1.420 m",
        "elements per wing 32 orthogonal",
        "humerus 0.134 0.01",
        "shoulder.flap humerus compliant 0.00 42.00 180.00",
        "shoulder.flap 20 0.2 0.00157 18 Hz",
        "Loads of a beat at mean trim, change",
        "from 32 to 64 elements",
        "No warnings.",
    ):
        assert row in rows
    assert max(map(len, result.stdout.splitlines())) <= 80


def test_hinges_of_feathers(run):
    """I = m l^2/3, of feathers at 15 and 30 degrees to straight aft, as the joints' offsets say."""
    result = run("check", HINGED)
    assert result.exit_code == 0, result.stderr
    rows = [" ".join(line.split()) for line in result.stdout.splitlines()]
    for row in (
        "mass of the whole bird 1.266 kg",
        "span, joints at zero 1.360 m",
        "feathers.5.hinge 1 0.002 1.05e-05 49.1 Hz",
        "feathers.3.hinge 1 0.002 1.5e-05 41.1 Hz",
    ):
        assert row in rows
    loose = run("check", HINGED, "--set", "feathers.5.hinge.stiffness=0")
    assert "feathers.5.hinge has stiffness 0: only the air holds" in loose.stdout
    slow = run("check", HINGED, "--set", "feathers.5.hinge.stiffness=0.0066")
    assert "feathers.5.hinge swings by itself at 3.99 Hz, close to" in " ".join(slow.stdout.split())


def test_warnings_are_printed_and_no_error(run):
    result = run("check", IBIS, "--set", "gravity=0")
    assert result.exit_code == 0
    assert "Warning: gravity is 0: nothing has to be carried." in result.stdout


def test_loads_that_change_much_are_told():
    assert warnings_on_loads(LoadChange(64, 0.019, 0.0)) == []
    (force,) = warnings_on_loads(LoadChange(64, 0.031, 0.0))
    assert "change by 3.1% on 64 elements" in force
    (circulation,) = warnings_on_loads(LoadChange(64, 0.0, 0.05))
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
}


@pytest.mark.parametrize(("values", "says"), CASES.values(), ids=CASES)
def test_warnings(values, says):
    warnings = warnings_on(load_bird(IBIS).with_values({"wing.root.y": WIDE} | values))
    assert len(warnings) == (says is not None), warnings
    assert says is None or says in warnings[0]


def test_inertia_of_a_straight_wing_about_the_flap_axis():
    straight = {f"{joint}.offset": 0.0 for joint in load_bird(COMPLIANT).joint_names}
    bird = load_bird(COMPLIANT).with_values(straight)
    spring = spring_of(bird, bird.joint("shoulder.flap"))
    expected, reached = 0.0, 0.0
    for bone in ("humerus", "forearm", "hand"):
        segment = getattr(bird.segments, bone)
        expected += segment.inertia[0][0] + segment.mass * (reached + segment.length / 2) ** 2
        reached += segment.length
    assert spring.inertia == pytest.approx(expected, rel=1e-12)
    assert spring.frequency == pytest.approx(math.sqrt(20 / expected) / (2 * math.pi))
