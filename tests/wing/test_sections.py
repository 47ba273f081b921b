"""Wings of sections along any chain of bones, against feathers and exact planforms."""

import numpy as np
import pytest

import birdmb
from birdmb.aerodynamics.elements import place_elements
from birdmb.topology.messages import validated
from birdmb.topology.unused import unused_values
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.edges import wing_edges
from birdmb.wing.outline import span_and_area
from birdmb.wing.shape import wing_shape
from tests.aerodynamics.pairs import element_loads, resultant
from tests.aerodynamics.test_circulation import ALPHA, DENSITY, SPEED, wind

from .test_square_tip import (
    EVEN,
    STILL,
    TAPERING,
    WIDENING,
    rectangular_lift_slope,
    straight_aft,
)


def section(bone, position, chord, **more):
    return {"name": f"{bone}{position:g}".replace(".", "_"), "bone": bone, "position": position,
            "chord": chord} | more  # fmt: skip


def with_sections(bird, *sections, **values):
    """The bird with sections in place of its feathers."""
    document = bird.model_dump(exclude_unset=True)
    del document["feathers"]
    bird = birdmb.Bird.model_validate(document | {"sections": sections})
    return bird.with_values(values) if values else bird


def plate(chord=0.1, length=0.3, segments=("bar",), **more):
    """A bird whose wings are flat rectangular plates on bars of equal length, flapped at x."""
    part = {"length": length / len(segments), "mass": 0.004, "inertia": [1e-5, 1e-7, 1e-5]}
    document = {
        "name": "plate",
        "gait": {"frequency": 4.0},
        "body": {"mass": 0.2, "inertia_yy": 1e-3},
        "wing": {"root": {"x": 0.0, "y": 0.0}},
        "segments": dict.fromkeys(segments, part),
        "joints": [
            {"name": "shoulder.flap", "segment": segments[0], "axis": [-1, 0, 0],
             "amplitude_deg": 20.0}
        ],
        "sections": [section(segments[0], 0.0, chord), section(segments[-1], 1.0, chord)],
    }  # fmt: skip
    return birdmb.Bird.model_validate(document | more)


def lift(wing, elements):
    still = np.zeros(wing.offset.size)
    shape = wing_shape(wing, still, still, elements, 0.5, False)
    assert shape.converged
    placed = place_elements(shape, wing.root)
    fx, fz, _ = resultant(placed, element_loads(placed, DENSITY, 0.0, *wind(), 0.0))
    return -fz * np.cos(ALPHA) + fx * np.sin(ALPHA)


@pytest.mark.parametrize("lengths", [EVEN, WIDENING, TAPERING])
def test_sections_that_are_feathers_are_the_same_wing(ibis, lengths):
    """Feathers straight aft end chords: half-thickness, length and half-thickness again."""
    feathers = straight_aft(ibis, lengths)
    thickness = 2 * ibis.wing.half_thickness
    ends = [("humerus", 0.0), ("humerus", 1.0), ("forearm", 1.0), ("hand", 1.0)]
    sections = [
        section(
            bone,
            position,
            thickness + length,
            offset=ibis.wing.half_thickness - 0.25 * (thickness + length),
        )
        for (bone, position), length in zip(ends, lengths, strict=True)
    ]
    of_sections = with_sections(ibis, *sections, **{"wing.root.y": 0.0})
    sectioned = wing_arrays(of_sections)
    for by_feathers, by_sections in zip(
        wing_edges(feathers, STILL + 0j), wing_edges(sectioned, STILL + 0j), strict=True
    ):
        np.testing.assert_allclose(by_sections, by_feathers[: len(by_sections)], atol=1e-15)
    assert lift(sectioned, 32) == pytest.approx(lift(feathers, 32), rel=1e-12)
    shapes = [wing_shape(w, STILL, STILL, 32, 0.5, False) for w in (feathers, sectioned)]
    np.testing.assert_allclose(shapes[1].distal_fraction, shapes[0].distal_fraction, atol=1e-12)


@pytest.mark.parametrize("segments", [("bar",), ("arm", "hand"), ("a", "b", "c", "d", "e")])
def test_a_plate_has_the_lift_of_the_exact_rectangle(segments):
    """On one bar or five, by Glauert's series; of second order in the elements."""
    bird = plate(chord=0.1, length=0.3, segments=segments)
    exact = rectangular_lift_slope(6.0) * ALPHA * 0.5 * DENSITY * SPEED**2 * 0.6 * 0.1
    wing = wing_arrays(bird)
    errors = np.array([abs(lift(wing, n) / exact - 1) for n in (16, 32, 64)])
    assert errors[-1] < 3e-5
    assert (np.log2(errors[:-1] / errors[1:]) > 1.8).all()
    assert span_and_area(bird) == pytest.approx((0.6, 0.06))


def test_a_chord_lies_where_offset_and_twist_say():
    """By hand: the quarter chord 2 cm ahead of a bone along y, nose up by 30 degrees."""
    twisted = section("bar", 1.0, 0.08, offset=0.02, twist_deg=30.0)
    bird = plate(sections=[section("bar", 0.0, 0.08), twisted])
    leading, trailing = wing_edges(wing_arrays(bird), np.zeros(1, complex))
    forward = np.array([np.cos(np.radians(30)), 0.0, -np.sin(np.radians(30))])
    tip = np.array([0.0, 0.3, 0.0])
    np.testing.assert_allclose(leading[1].real, tip + 0.04 * forward, atol=1e-15)
    np.testing.assert_allclose(trailing[1].real, tip - 0.04 * forward, atol=1e-15)


def test_a_section_at_a_joint_stands_midway_between_the_bones():
    """The hand swept back by 40 degrees: the chord at the wrist is turned by 20."""
    bird = plate(segments=("arm", "hand"))
    joints = [
        *bird.model_dump()["joints"],
        {"name": "wrist.sweep", "segment": "hand", "axis": [0, 0, 1]},
    ]
    sections = [section("arm", 0.0, 0.1), section("arm", 1.0, 0.1), section("hand", 1.0, 0.1)]
    bird = plate(segments=("arm", "hand"), joints=joints, sections=sections)
    angles = np.array([0.0, np.radians(40)], complex)
    leading, trailing = wing_edges(wing_arrays(bird), angles)
    chords = (trailing - leading).real
    np.testing.assert_allclose(np.linalg.norm(chords, axis=1), 0.1, rtol=1e-14)
    swept = np.degrees(np.arctan2(-chords[:, 1], -chords[:, 0]))
    np.testing.assert_allclose(swept, [0.0, 20.0, 40.0], atol=1e-12)


def test_the_twist_of_a_bone_is_felt_up_to_a_section():
    joints = [{"name": "arm.roll", "segment": "bar", "axis": [0, 1, 0], "twist": True}]
    places = (0.0, 0.25, 1.0)
    bird = plate(joints=joints, sections=[section("bar", p, 0.1) for p in places])
    leading, trailing = wing_edges(wing_arrays(bird), np.array([0.4 + 0j]))
    chords = (trailing - leading).real
    np.testing.assert_allclose(np.arctan2(chords[:, 2], -chords[:, 0]), 0.4 * np.array(places))


def test_loads_are_carried_by_the_bone_abreast_of_them():
    """A plate on two bars, loaded on one spar: the joint's torque is that of what is beyond it."""
    bird = plate(segments=("arm", "hand"), length=0.4)
    still = np.zeros(1)
    shape = wing_shape(wing_arrays(bird), still, still, 32, 0.5, False)
    beyond = shape.distal_fraction[:, 0]
    across = shape.line[0::2, 1]
    assert shape.distal_fraction.shape == (32, 1)
    # The rounding of the corner: half of 0.2 m times 0.2 m over 0.4 m.
    np.testing.assert_array_equal(beyond[across < 0.149], 0.0)
    np.testing.assert_array_equal(beyond[across > 0.251], 1.0)
    assert (np.diff(beyond) >= 0.0).all()
    assert np.interp(0.2, across, beyond) == pytest.approx(0.5, abs=0.01)


def test_a_bar_in_five_pieces_flies_as_the_whole_one():
    """Exudyn's tree of a bar cut into pieces without joints is that of the whole bar."""
    whole = plate()
    part = {"length": 0.06, "mass": 0.004 / 5, "inertia": [1e-6, 2e-8, 1e-6]}
    cut = plate(segments=("a", "b", "c", "d", "e")).model_dump()
    cut = birdmb.Bird.model_validate(cut | {"segments": dict.fromkeys("abcde", part)})
    # By Steiner: five rods of mass m/5 along 0.3 m about their common centre.
    about = 5 * 1e-6 + 0.004 / 5 * 2 * (0.06**2 + 0.12**2)
    whole = whole.with_values({"segments.bar.inertia": [about, 1e-7, about]})
    state = np.array([9.0, 0.4, 0.2, 0.1])
    rates = [birdmb.MultibodyModel(bird).rhs(0.03, state) for bird in (whole, cut)]
    np.testing.assert_allclose(rates[0], rates[1], rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"sections": []}, "feathers: missing; a wing is spanned by [[feathers]] or by "
                           "[[sections]]"),
        ({"sections": [section("bar", 0.0, 0.1), section("bar", 0.9, 0.1)]},
         "sections: none is at the bar's tip; one must be (bone bar, position 1)"),
        ({"sections": [section("bar", 0.0, 0.0), section("bar", 1.0, 0.1)]},
         "sections.bar0.chord: must be more than 0; only the section at the wing's tip may be a "
         "point"),
        ({"sections": [section("rod", 0.0, 0.1), section("bar", 1.0, 0.1)]},
         'sections.rod0.bone: no segment is called "rod"; the nearest: bar'),
        ({"sections": [section("bar", 0.0, 0.1, profile={"slope": 6.0}), section("bar", 1.0, 0.1)]},
         "sections.bar0.profile.slope: unknown key; the nearest known: lift_slope"),
        ({"segments": {}}, "segments: empty; a wing needs one segment at least, as [segments.arm]"),
        ({"wing": {"root": {"x": 0.0, "y": 0.0}, "propatagium": "elbow"}},
         'wing.propatagium: no segment is called "elbow"; the nearest: bar'),
    ],
)  # fmt: skip
def test_what_no_wing_can_be_is_one_sentence(change, sentence):
    document = plate().model_dump(exclude_unset=True) | change
    with pytest.raises(birdmb.TopologyError) as caught:
        validated(birdmb.Bird, document, "plate.toml")
    assert str(caught.value).startswith(f"plate.toml: {sentence}")


@pytest.mark.parametrize("motion", ["planar", "free"])
def test_a_wing_without_joints_is_fixed_to_the_body(motion):
    """As one whose only joint never moves, in both models."""
    still = plate(joints=[{"name": "a.flap", "segment": "bar", "axis": [-1, 0, 0]}])
    inertia = {"body.inertia_xx": 2e-4, "body.inertia_zz": 1.1e-3}
    birds = [bird.with_values(inertia) for bird in (still, plate(joints=[]))]
    for model in (birdmb.RigidModel, birdmb.MultibodyModel):
        models = [model(bird, motion=motion) for bird in birds]
        x = 0.05 * np.arange(1.0, 1.0 + len(models[0].state_names))
        x[0] = 9.0
        rates = [one.rhs(0.03, x) for one in models]
        np.testing.assert_allclose(rates[1], rates[0], rtol=1e-11, atol=1e-11)
        ends = [one.flow(x, 0.0, 0.02) for one in models]
        np.testing.assert_allclose(ends[1], ends[0], rtol=1e-9, atol=1e-9)


def test_values_that_sections_leave_unused_are_told():
    unused = unused_values(plate())
    assert unused["wing.half_thickness"] == "sections span the wing, not feathers"
    assert "wing.profile.lift_slope" not in unused
    own = [section("bar", place, 0.1, profile={"lift_slope": 6.0}) for place in (0.0, 1.0)]
    assert "wing.profile.lift_slope" in unused_values(plate(sections=own))
