"""One dotted name for every value, the same in Python, in studies and in `--set`."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from birdmb.errors import TopologyError
from birdmb.topology import PRESETS, Discretisation, load_bird, parse_assignment
from birdmb.topology.values import named_places, of_a_side

from .conftest import TOPOLOGIES

IBIS = load_bird(TOPOLOGIES / "ibis.toml")


@pytest.mark.parametrize("name", IBIS.value_names())
def test_value_put_back_changes_nothing(name):
    same = IBIS.with_values({name: IBIS.value(name)})
    for other in IBIS.value_names():
        if name.startswith(f"{other}.") and other.endswith(("discretisation", "left", "right")):
            continue  # set in parts, it is a table from then on
        value = IBIS.value(other)
        if isinstance(value, float):
            assert same.value(other) == pytest.approx(value, rel=1e-15)
        else:
            assert same.value(other) == value


NUMBERS = [
    name
    for name, place in named_places(IBIS).items()
    if isinstance(IBIS.value(name), float)
    and not name.endswith(("position", "rounding"))
    and not of_a_side(place)  # these follow the joint's own
]


@given(st.dictionaries(st.sampled_from(NUMBERS), st.floats(1e-6, 1e3), max_size=8))
def test_what_is_set_is_read_back(values):
    if any(f"{name}_deg" in values for name in values):
        return
    bird = IBIS.with_values(values)
    for name in NUMBERS:
        if name in values:
            assert bird.value(name) == pytest.approx(values[name], rel=1e-15)
        elif name.removesuffix("_deg") not in values and f"{name}_deg" not in values:
            follows = name.endswith("centre_of_mass")
            assert follows or bird.value(name) == IBIS.value(name)


def test_degrees_and_radians_are_one_value(ibis):
    bird = ibis.with_values({"forearm.roll.offset_deg": -5.5})
    assert bird.joint("forearm.roll").offset == math.radians(-5.5)
    assert bird.with_values({"forearm.roll.offset": 0.1}).value(
        "forearm.roll.offset_deg"
    ) == pytest.approx(math.degrees(0.1))


def test_default_mid_bone_follows_the_length(ibis):
    longer = ibis.with_values({"segments.hand.length": 0.1})
    assert longer.segments.hand.centre_of_mass == (0, 0.05, 0)
    fixed = ibis.with_values({"segments.hand.centre_of_mass": [0, 0.04, 0]})
    fixed = fixed.with_values({"segments.hand.length": 0.1})
    assert fixed.segments.hand.centre_of_mass == (0, 0.04, 0)


def test_spring_or_damper_makes_compliant(ibis):
    flap = ibis.with_joint("shoulder.flap", stiffness=20, damping=0.2).joint("shoulder.flap")
    assert (flap.mode, flap.stiffness, flap.damping) == ("compliant", 20, 0.2)
    undamped = ibis.with_values({"shoulder.flap.stiffness": 20})
    assert [joint.name for joint in undamped.compliant_joints] == ["shoulder.flap"]
    assert undamped.joint("shoulder.flap").damping == 0
    held = ibis.with_joint("shoulder.flap", stiffness=20, mode="prescribed")
    assert held.compliant_joints == ()
    assert held.with_joint("shoulder.flap", damping=0.1).value("shoulder.flap.stiffness") == 20


def test_fingerprint_follows_the_values_not_their_spelling(ibis):
    heavier = ibis.with_values({"body.mass": 1.3})
    assert heavier.fingerprint() != ibis.fingerprint()
    assert heavier.with_values({"body.mass": 1.2}).fingerprint() == ibis.fingerprint()
    spelt_out = ibis.with_values({"wing.discretisation": PRESETS["converged"].model_dump()})
    assert spelt_out.fingerprint() == ibis.fingerprint()


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        ("converged", PRESETS["converged"]),
        ("published", PRESETS["published"]),
        (64, Discretisation(**dict(PRESETS["converged"]) | {"elements": 64})),
        (np.int64(64), Discretisation(**dict(PRESETS["converged"]) | {"elements": 64})),
        (
            {"scheme": "orthogonal", "elements": 10, "rounding": 0.5},
            Discretisation(scheme="orthogonal", elements=10, rounding=0.5),
        ),
    ],
)
def test_discretisation(ibis, written, expected):
    wing = ibis.with_values({"wing.discretisation": written}).wing
    assert wing.resolved_discretisation == expected


def test_part_of_a_discretisation(ibis):
    bird = ibis.with_values({"wing.discretisation": "published"})
    bird = bird.with_values({"wing.discretisation.elements": 16})
    assert bird.wing.resolved_discretisation == Discretisation(
        **dict(PRESETS["published"]) | {"elements": 16}
    )


def test_arrays_and_table_values(ibis):
    bird = ibis.with_values(
        {"segments.hand.inertia": np.eye(3) * 1e-6, "feathers.3.shares": {"elbow.sweep": 0.9}}
    )
    assert bird.segments.hand.inertia == ((1e-6, 0, 0), (0, 1e-6, 0), (0, 0, 1e-6))
    assert bird.value("feathers.3.shares.elbow.sweep") == 0.9


HINGE = {"stiffness": 2.0, "damping": 0.002, "mass": 1.5e-3, "rest_deg": 3.0}


def test_a_hinge_is_put_on_and_taken_off_as_a_whole_and_varied_in_parts(ibis):
    assert ibis.value("feathers.5.hinge") is None
    hinged = ibis.with_values({"feathers.5.hinge": HINGE})
    assert hinged.hinged_feathers[0].hinge.rest == math.radians(3.0)
    assert hinged.angle_names == (*ibis.joint_names, "feathers.5.hinge")
    assert hinged.value("feathers.5.hinge.stiffness") == 2.0
    assert hinged.value("feathers.5.hinge.rest_deg") == pytest.approx(3.0)
    stiffer = hinged.with_values({"feathers.5.hinge.stiffness": 8, "feathers.5.hinge.rest": 0.0})
    assert stiffer.value("feathers.5.hinge") == {
        "stiffness": 8, "damping": 0.002, "mass": 1.5e-3, "rest": 0,
    }  # fmt: skip
    assert hinged.with_values({"feathers.5.hinge": None}) == ibis
    assert len({bird.fingerprint() for bird in (ibis, hinged, stiffer)}) == 3


def test_every_value_of_a_hinged_bird_put_back_changes_nothing(ibis):
    hinged = ibis.with_values({"feathers.5.hinge": HINGE})
    for name in hinged.value_names():
        if name.startswith("feathers.5") and not name.endswith("_deg"):  # there and back rounds
            assert hinged.with_values({name: hinged.value(name)}) == hinged
    assert {f"feathers.5.hinge.{key}" for key in (*HINGE, "rest")} < set(hinged.value_names())


def test_hinged_feathers_weigh_on_both_sides(ibis):
    hinged = ibis.with_values({"feathers.5.hinge": HINGE, "feathers.3.hinge": HINGE})
    assert hinged.total_mass == pytest.approx(ibis.total_mass + 4 * 1.5e-3)


def test_axis_is_normalised(ibis):
    assert ibis.with_joint("wrist.sweep", axis=[0, 3, -4]).joint("wrist.sweep").axis == (
        0,
        0.6,
        -0.8,
    )


def test_joint_without_a_segment_to_itself(ibis):
    stiff_hand = [joint for joint in ibis.model_dump()["joints"] if joint["segment"] != "hand"]
    feathers = [feather | {"shares": {}} for feather in ibis.model_dump()["feathers"]]
    document = ibis.model_dump() | {"joints": stiff_hand, "feathers": feathers}
    assert "wrist.sweep" not in type(ibis).model_validate(document).joint_names


def test_birds_do_not_change(ibis):
    with pytest.raises(AttributeError, match="immutable"):
        ibis.body.mass = 2
    before = ibis.fingerprint()
    assert ibis.with_values({"gait.frequency": 5}).period == 0.2
    assert ibis.fingerprint() == before


WRONG = {
    "value": (
        lambda bird: bird.with_joint("shoulder.flap", stiffness=-1),
        "ibis (with shoulder.flap.stiffness = -1): shoulder.flap.stiffness: "
        "must be 0 or more, not -1 (joint stiffness, N m/rad)",
    ),
    "damping without stiffness": (
        lambda bird: bird.with_joint("shoulder.flap", damping=0.2),
        "ibis (with shoulder.flap.damping = 0.2): shoulder.flap.stiffness: missing; "
        "a compliant joint needs a stiffness of 0 or more",
    ),
    "unknown name": (
        lambda bird: bird.with_values({"shoulder.flap.stifness": 1}),
        'ibis: no value is called "shoulder.flap.stifness"; the nearest: '
        "shoulder.flap.stiffness, shoulder.flap.stiffness_below, shoulder.flap.cubic_stiffness",
    ),
    "unknown name read": (
        lambda bird: bird.value("wing.roots.x"),
        'ibis: no value is called "wing.roots.x"; the nearest: '
        "wing.root.x, wing.root.z, wing.root.y",
    ),
    "unknown joint": (
        lambda bird: bird.with_joint("elbow.swep", stiffness=1),
        'ibis: no joint is called "elbow.swep"; the nearest: elbow.sweep',
    ),
    "whole and part": (
        lambda bird: bird.with_values(
            {"wing.discretisation": "published", "wing.discretisation.elements": 4}
        ),
        "ibis: wing.discretisation is set as a whole and in parts; keep one of the two",
    ),
    "whole hinge and part": (
        lambda bird: bird.with_values({"feathers.5.hinge": HINGE, "feathers.5.hinge.stiffness": 1}),
        "ibis: feathers.5.hinge is set as a whole and in parts; keep one of the two",
    ),
    "hinge without mass": (
        lambda bird: bird.with_values({"feathers.5.hinge": {**HINGE, "mass": 0.0}}),
        'ibis (with feathers.5.hinge = {"stiffness": 2.0, "damping": 0.002, "mass": 0.0, '
        '"rest_deg": 3.0}): feathers.5.hinge.mass: must be more than 0, not 0.0 '
        "(mass of the feather, spread evenly along it, kg)",
    ),
    "hinge incomplete": (
        lambda bird: bird.with_values({"feathers.5.hinge": {"damping": 1, "mass": 1}}),
        'ibis (with feathers.5.hinge = {"damping": 1, "mass": 1}): feathers.5.hinge.stiffness: '
        "missing; it should give the stiffness of the hinge, N m/rad",
    ),
    "hinge misspelt": (
        lambda bird: bird.with_values({"feathers.5.hinge": {**HINGE, "stifness": 1}}),
        'ibis (with feathers.5.hinge = {"stiffness": 2.0, "damping": 0.002, "mass": 0.0015, '
        '"rest_deg": 3.0, "stifne...): feathers.5.hinge.stifness: unknown key; '
        "the nearest known: stiffness",
    ),
    "hinge no table": (
        lambda bird: bird.with_values({"feathers.5.hinge": 3}),
        "ibis (with feathers.5.hinge = 3): feathers.5.hinge: must be a table, not 3 "
        "(hinge of the feather, a table; rooted firmly if left out)",
    ),
    "hinge along the feather": (
        lambda bird: bird.with_values({"feathers.1.hinge": HINGE}),
        'ibis (with feathers.1.hinge = {"stiffness": 2.0, "damping": 0.002, "mass": 0.0015, '
        '"rest_deg": 3.0}): feathers.1.hinge: a feather at 90 degrees points along its bone, '
        "about which a hinge would turn it; it must be rooted firmly",
    ),
    "degrees and radians": (
        lambda bird: bird.with_joint("wrist.sweep", offset=1, offset_deg=2),
        "ibis (with wrist.sweep.offset = 1, wrist.sweep.offset_deg = 2): wrist.sweep.offset_deg: "
        "given twice, as offset and offset_deg; keep one",
    ),
    "assignment on two lines": (
        lambda _: parse_assignment("body.mass=1.3\nname=2"),
        '"body.mass=1.3\\nname=2" must read NAME=VALUE; what follows on another line needs a --set '
        "of its own",
    ),
    "assignment and a table": (
        lambda _: parse_assignment("body.mass=1.3\n[air]"),
        '"body.mass=1.3\\n[air]" must read NAME=VALUE; what follows on another line needs a --set '
        "of its own",
    ),
    "assignment of too many digits": (
        lambda bird: bird.with_values(dict([parse_assignment(f"body.mass={'9' * 5000}")])),
        f'ibis (with body.mass = "{"9" * 76}...): body.mass: must be a number, not '
        f'"{"9" * 76}... (mass of the body without its wings, kg)',
    ),
    "assignment": (
        lambda _: parse_assignment("body.mass"),
        '"body.mass" must read NAME=VALUE, for instance body.mass=1.3',
    ),
}


@pytest.mark.parametrize(("do", "sentence"), WRONG.values(), ids=WRONG)
def test_sentence(ibis, do, sentence):
    with pytest.raises(TopologyError) as caught:
        do(ibis)
    assert str(caught.value) == sentence


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("shoulder.flap.stiffness=20", ("shoulder.flap.stiffness", 20)),
        ("body.mass = 1.3e0", ("body.mass", 1.3)),
        ("wing.discretisation=published", ("wing.discretisation", "published")),
        ('wing.discretisation="published"', ("wing.discretisation", "published")),
        ("forearm.roll.twist=false", ("forearm.roll.twist", False)),
        ("segments.hand.inertia=[1, 2, 2]", ("segments.hand.inertia", [1, 2, 2])),
        ('feathers.3.shares={"wrist.sweep" = 1}', ("feathers.3.shares", {"wrist.sweep": 1})),
        ("body.mass=1,3", ("body.mass", "1,3")),
        ("body.mass=1.3 # kg", ("body.mass", 1.3)),
        ("shoulder.flap.axis=[1,\n0, 0]", ("shoulder.flap.axis", [1, 0, 0])),
        ("name=" + 2000 * "[", ("name", 2000 * "[")),
    ],
)
def test_assignment(text, expected):
    assert parse_assignment(text) == expected


def test_published_preset_is_the_published_one():
    assert (PRESETS["published"].scheme, PRESETS["published"].elements) == ("one-step", 8)
