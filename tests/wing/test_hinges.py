"""Feathers on hinges: where they turn to, and how fast that moves the lifting line."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from birdmb.aerodynamics.elements import place_elements
from birdmb.aerodynamics.joints import torques
from birdmb.aerodynamics.prescribed import driver_motion
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.chain import joint_chain
from birdmb.wing.edges import feather_ends, wing_edges
from birdmb.wing.shape import wing_shape
from tests.aerodynamics.pairs import element_loads

HINGE = {"stiffness": 2.0, "damping": 0.002, "mass": 1e-3}
BOTH = {"feathers.5.hinge": HINGE | {"rest": 0.05}, "feathers.3.hinge": HINGE}
ROUNDING = 0.5
# Trailing edge from shoulder to tip: feathers 7, 5, 3, 1; angles: six joints, hinges of 5 and 3.
FIFTH, THIRD = 1, 2


@pytest.fixture(scope="module")
def hinged(ibis):
    return wing_arrays(ibis.with_values(BOTH))


@pytest.fixture(scope="module")
def firm(ibis):
    return wing_arrays(ibis)


def posed(wing, t):
    """Driven joints with both hinges swinging."""
    angles, rates, _ = driver_motion(wing, t)
    angles[6:], rates[6:] = (0.2, -0.1), (3.0, -5.0)
    return angles, rates


def test_drivers_of_hinges_stand_at_their_rest(hinged):
    for value, expected in zip(
        driver_motion(hinged, 0.07), ([0.05, 0], [0, 0], [0, 0]), strict=True
    ):
        np.testing.assert_array_equal(value[6:], expected)


def test_a_positive_angle_takes_the_tip_down(hinged):
    """Joints at zero, feather 5 straight aft: leading edge up is tip down, z positive."""
    angles = np.zeros(8) + 0j
    before = wing_edges(hinged, angles)[1].real
    angles[6] = 0.3
    moved = wing_edges(hinged, angles)[1].real - before
    expected = 0.15 * np.array([1 - np.cos(0.3), 0, np.sin(0.3)])
    np.testing.assert_allclose(moved[FIFTH], expected, atol=1e-16)
    np.testing.assert_array_equal(np.delete(moved, FIFTH, axis=0), 0.0)


@pytest.mark.parametrize("t", [0.0, 0.07, 0.16])
def test_a_feather_turns_about_its_bones_span_at_its_root(hinged, firm, t):
    """Against scipy's rotations of the firmly rooted feather, vector by vector."""
    angles, _ = posed(hinged, t)
    bones = joint_chain(firm, angles[:6] + 0j)
    roots, tips = (ends.real for ends in feather_ends(firm, bones, angles[:6] + 0j))
    found = wing_edges(hinged, angles + 0j)[1].real
    for feather, bone, angle in ((FIFTH, 0, 0.2), (THIRD, 1, -0.1)):
        span = bones.rotation[bone].real[:, 1]
        turn = Rotation.from_rotvec(angle * span)
        expected = roots[feather] + turn.apply(tips[feather] - roots[feather])
        np.testing.assert_allclose(found[feather], expected, atol=1e-15)
    np.testing.assert_array_equal(found[[0, 3]], tips[[0, 3]])


@pytest.mark.parametrize("published", [False, True])
def test_hinges_at_zero_leave_the_wing_as_it_is(hinged, firm, published):
    angles, rates = posed(hinged, 0.11)
    angles[6:] = rates[6:] = 0.0
    shape = wing_shape(hinged, angles, rates, 8, ROUNDING, published)
    expected = wing_shape(firm, angles[:6], rates[:6], 8, ROUNDING, published)
    for name in ("line", "velocity", "chord_direction", "normal", "chord"):
        np.testing.assert_allclose(getattr(shape, name), getattr(expected, name), atol=1e-13)
    assert expected.hinge_twist.shape == (0, 8, 6)


@pytest.mark.parametrize("published", [False, True])
def test_velocities_per_hinge_are_the_derivatives_of_the_positions(hinged, published):
    angles, rates = posed(hinged, 0.07)
    h, n = 1e-5, 8 if published else 32
    shape = wing_shape(hinged, angles, rates, n, ROUNDING, published)
    for hinge in (0, 1):
        step = h * (np.arange(8) == 6 + hinge)
        ends = [
            wing_shape(hinged, angles + s, rates, n, ROUNDING, published) for s in (step, -step)
        ]
        difference = (ends[0].line - ends[1].line)[0::2] / (2 * h)
        assert np.abs(difference).max() > 0.01
        np.testing.assert_allclose(shape.hinge_twist[hinge, :, :3], difference, atol=1e-9)
        # The chord's direction turns with the angular velocity: c' = omega x c.
        turning = (ends[0].chord_direction - ends[1].chord_direction) / (2 * h)
        spun = np.cross(shape.hinge_twist[hinge, :, 3:], shape.chord_direction)
        assert np.abs(turning).max() > 0.1
        # Times the chord, for differences lose the direction of one that is next to nothing.
        chord = shape.chord[:, None]
        np.testing.assert_allclose(chord * spun, chord * turning, atol=1e-9)


def test_velocities_add_up(hinged):
    """Whatever moves, the line's velocity is the joints' part and each hinge's times its rate."""
    angles, rates = posed(hinged, 0.18)
    still = rates * (np.arange(8) < 6)
    whole = wing_shape(hinged, angles, rates, 16, ROUNDING, False)
    joints = wing_shape(hinged, angles, still, 16, ROUNDING, False)
    hinges = np.tensordot(rates[6:], whole.hinge_twist[:, :, :3], axes=1)
    np.testing.assert_allclose(whole.velocity, joints.velocity + hinges, atol=1e-13)


def test_sections_twist_with_the_feathers_that_carry_them(hinged):
    """Joints at zero: tips down is chords down at the rear, at most at the feather."""
    angles, zero = np.zeros(8), np.zeros(8)
    before = wing_shape(hinged, angles, zero, 32, ROUNDING, False)
    angles[6] = 0.1
    after = wing_shape(hinged, angles, zero, 32, ROUNDING, False)
    twist = (after.chord_direction - before.chord_direction)[:, 2]
    elbow = np.argmin(np.abs(before.line[0::2, 1] - 0.134))
    assert abs(np.argmax(twist) - elbow) <= 2
    assert 0.03 < twist.max() < 0.1
    assert (twist > -1e-12).all()
    # The next feather, 3, is firm here; outwards of its tip and the rounded corner nothing moves.
    tip = wing_edges(hinged, angles + 0j)[1].real[THIRD, 1]
    np.testing.assert_allclose(twist[before.line[0::2, 1] > tip + 0.1], 0.0, atol=1e-13)


def test_torque_about_a_hinge_is_the_work_of_the_loads(hinged):
    """Loads held, the work along a small turn of the hinge, by differences of positions."""
    angles, rates = posed(hinged, 0.03)
    shape = wing_shape(hinged, angles, rates, 16, ROUNDING, False)
    placed = place_elements(shape, hinged.root)
    wrench = element_loads(placed, 1.225, 0.0, 18.0, -2.0, 0.3).wrench
    torque, force = torques(shape.hinge_twist, wrench), wrench[:, :3]
    h = 1e-5
    for hinge in (0, 1):
        step = h * (np.arange(8) == 6 + hinge)
        work = [
            np.sum(force * wing_shape(hinged, angles + s, rates, 16, ROUNDING, False).line[0::2])
            for s in (step, -step)
        ]
        assert torque[hinge] == pytest.approx((work[0] - work[1]) / (2 * h), rel=1e-7)
    # In the downstroke the air lifts the feathers' tips.
    assert (torque < -0.01).all()
