"""The lifting line's loads against exact wings and against themselves."""

import numpy as np
import pytest

from birdmb.aerodynamics.airframe import AeroConstants
from birdmb.aerodynamics.body_drag import BodyDrag
from birdmb.aerodynamics.elements import circulation_system, place_elements
from birdmb.aerodynamics.joints import torques, twist_per_joint_rate
from birdmb.aerodynamics.prescribed import (
    at_phase,
    driver_motion,
    prescribed_wing,
    symmetric_loads,
)
from birdmb.aerodynamics.slender_body import SlenderBody
from birdmb.aerodynamics.tail import TailSurface
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.chain import joint_chain
from birdmb.wing.shape import WingShape, wing_shape
from tests.aerodynamics.pairs import THIN, element_loads, resultant

# Small, so that what is left is the discretisation and not alpha squared.
DENSITY, SPEED, ALPHA = 1.225, 10.0, 1e-3
PROFILE = 0.02
NO_TAIL = TailSurface(0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0, 1.5e-5, False, False)


def flat_wing(chord_at, elements, semi_span=1.0, plunge=0.0):
    """A flat wing whose root lies on the centre line, chord(y), cosine stations."""
    theta = np.linspace(0.0, np.pi / 2, 2 * elements)
    y = semi_span * np.sin(theta)
    n = elements
    line = np.column_stack([np.zeros(2 * n), y, np.zeros(2 * n)])
    unit = np.tile
    velocity = np.zeros((n, 3))
    velocity[:, 2] = plunge
    return WingShape(
        line,
        velocity,
        unit([-1.0, 0.0, 0.0], (n, 1)),
        unit([0.0, 0.0, -1.0], (n, 1)),
        unit([0.0, 1.0, 0.0], (n, 1)),
        chord_at(y[0::2]),
        unit(THIN, (n, 1)),
        np.zeros((n, 2)),
        True,
        np.zeros((0, n, 6)),
        np.zeros((n, 3)),
    )


def coefficients(shape, area, u, w):
    """Lift and induced-drag coefficients in wind axes."""
    placed = place_elements(shape, np.zeros(3))
    fx, fz, _ = resultant(placed, element_loads(placed, DENSITY, 0.0, u, w, 0.0))
    V = np.hypot(u, w)
    lift, drag = (-fz * u + fx * w) / V, (-fx * u - fz * w) / V
    q = 0.5 * DENSITY * V**2 * area
    return lift / q, drag / q


def wind(alpha=ALPHA):
    return SPEED * np.cos(alpha), SPEED * np.sin(alpha)


@pytest.mark.parametrize("aspect_ratio", [6.0, 12.0])
def test_elliptic_wing(aspect_ratio):
    """C_L = 2 pi alpha/(1 + 2/AR), C_Di = C_L^2/(pi AR) (Prandtl); second order or better."""
    root = 8.0 / (np.pi * aspect_ratio)  # semi-span 1: AR = 4/(pi root/2)
    area = np.pi * root / 2
    exact = 2 * np.pi * ALPHA / (1 + 2 / aspect_ratio)
    errors = []
    for n in (16, 32, 64):
        shape = flat_wing(lambda y: root * np.sqrt(1 - y**2), n)
        cl, cd = coefficients(shape, area, *wind())
        errors.append(abs(cl / exact - 1))
        assert cd == pytest.approx(cl**2 / (np.pi * aspect_ratio), rel=1e-5)
    assert errors[-1] < 3e-5
    assert np.log2(errors[0] / errors[1]) > 1.8
    assert np.log2(errors[1] / errors[2]) > 1.8


def test_elliptic_wing_has_constant_downwash():
    root = 8.0 / (np.pi * 8.0)
    shape = flat_wing(lambda y: root * np.sqrt(1 - y**2), 64)
    placed = place_elements(shape, np.zeros(3))
    gamma = element_loads(placed, DENSITY, 0.0, *wind(), 0.0).circulation
    downwash = (placed.induced_z @ gamma)[:-4]
    np.testing.assert_allclose(downwash, SPEED * ALPHA * (2 / 8) / (1 + 2 / 8), rtol=1e-3)


@pytest.mark.parametrize(
    ("aspect_ratio", "slope", "delta"),
    [(6, 4.530425, 0.048290), (8, 4.837704, 0.067611), (10, 5.046791, 0.085907)],
)
def test_rectangular_wing(aspect_ratio, slope, delta):
    """Lift slope and induced-drag factor of the untwisted rectangle (Glauert's series)."""
    chord = 2.0 / aspect_ratio
    errors = []
    for n in (16, 32, 64):
        shape = flat_wing(lambda y: np.full_like(y, chord), n)
        cl, cd = coefficients(shape, 2 * chord, *wind())
        errors.append(
            [abs(cl / ALPHA / slope - 1), abs(cd * np.pi * aspect_ratio / cl**2 - 1 - delta)]
        )
    assert errors[-1][0] < 2e-5
    assert errors[-1][1] < 1e-5
    assert (np.log2(np.array(errors[:-1]) / errors[1:]) > 1.8).all()


def test_slowly_heaving_elliptic_wing_gives_the_thrust_of_leading_edge_suction():
    """C_T = 2 pi/(1 + 2/AR)^2 <alpha^2>, alpha the heave rate over the speed."""
    aspect_ratio, peak = 10.0, 0.01
    root = 8.0 / (np.pi * aspect_ratio)
    area = np.pi * root / 2
    thrusts = []
    for phase in np.linspace(0, 2 * np.pi, 16, endpoint=False):
        plunge = SPEED * peak * np.sin(phase)
        shape = flat_wing(lambda y: root * np.sqrt(1 - y**2), 64, plunge=plunge)
        thrusts.append(-coefficients(shape, area, SPEED, 0.0)[1])
    exact = 2 * np.pi / (1 + 2 / aspect_ratio) ** 2 * peak**2 / 2
    assert np.mean(thrusts) == pytest.approx(exact, rel=1e-4)


@pytest.fixture(scope="module")
def wing(ibis):
    return wing_arrays(ibis)


def placed_at(wing, t, elements=16):
    angles, rates, _ = driver_motion(wing, t)
    return place_elements(wing_shape(wing, angles, rates, elements, 0.5, False), wing.root)


def both_wings(placed):
    """Velocities along y and z by all filaments of both wings, left tip to right tip."""
    mirror = np.array([1.0, -1.0, 1.0])
    position = np.vstack([placed.position[::-1] * mirror, placed.position])
    node = np.vstack([placed.node[:0:-1] * mirror, placed.node])
    n = len(position)
    strength = np.zeros((n + 1, n))  # shed backwards by node k per circulation, left to right
    for k in range(n):
        strength[k, k] -= 1
        strength[k + 1, k] += 1
    ry = position[:, None, 1] - node[None, :, 1]
    rz = position[:, None, 2] - node[None, :, 2]
    shed = np.abs(node[:, 1]) > 0
    near = np.zeros((n, n + 1))
    near[:, shed] = 1 / (4 * np.pi * (ry**2 + rz**2)[:, shed])
    return (rz * near) @ strength, (-ry * near) @ strength


def test_the_folded_system_is_that_of_both_wings(wing):
    """Mirror symmetry, by an independently written influence of all filaments on all controls."""
    placed = placed_at(wing, 0.03)
    full_y, full_z = both_wings(placed)
    n = placed.chord.size
    gamma = np.random.default_rng(1).normal(size=n)
    symmetric = np.concatenate([gamma[::-1], gamma])
    np.testing.assert_allclose((full_y @ symmetric)[n:], placed.induced_y @ gamma, atol=1e-12)
    np.testing.assert_allclose((full_z @ symmetric)[n:], placed.induced_z @ gamma, atol=1e-12)
    # And the left wing sees the mirror image of what the right one sees.
    np.testing.assert_allclose(
        (full_y @ symmetric)[n - 1 :: -1], -placed.induced_y @ gamma, atol=1e-12
    )


def test_circulation_solves_its_equation(wing):
    """Gamma = 1/2 c 2 pi (|U| alpha - w), with w the downwash normal to the projected line."""
    placed = placed_at(wing, 0.21)
    loads = element_loads(placed, DENSITY, 0.0, 18.0, -2.0, 0.3)
    vy, vz = placed.induced_y @ loads.circulation, placed.induced_z @ loads.circulation
    d = np.diff(placed.node, axis=0)
    w = (vz * d[:, 1] - vy * d[:, 2]) / np.hypot(d[:, 1], d[:, 2])
    np.testing.assert_allclose(
        loads.circulation,
        np.pi * placed.chord * (loads.speed * loads.angle_of_attack - w),
        rtol=1e-11,
        atol=1e-13,
    )
    assert np.linalg.cond(circulation_system(placed)) < 1e3


def test_force_against_far_field_momentum():
    """Trefftz plane: lift = rho V sum Gamma dy, drag = rho/2 sum Gamma w dy, of a flat wing."""
    placed = place_elements(flat_wing(lambda y: 0.2 + 0 * y, 64), np.zeros(3))
    loads = element_loads(placed, DENSITY, 0.0, *wind(0.0), 0.0)
    tilted = element_loads(placed, DENSITY, 0.0, *wind(ALPHA), 0.0)
    assert np.abs(loads.wrench).max() < 1e-14
    gamma, dy = tilted.circulation, placed.width
    u, w = wind(ALPHA)
    fx, fz, _ = resultant(placed, tilted)
    # In the wing's plane the bound vortex feels half of the downwash far behind it.
    downwash = placed.induced_z @ gamma
    drag = 2 * DENSITY * np.sum(gamma * downwash * dy)
    assert -fz == pytest.approx(2 * DENSITY * u * np.sum(gamma * dy), rel=1e-12)
    assert -fx == pytest.approx(drag - 2 * DENSITY * w * np.sum(gamma * dy), rel=1e-12)
    # The far field by an independent sum: kinetic energy of the wake per length.
    _, far_z = both_wings(placed)
    both = np.concatenate([gamma[::-1], gamma])
    energy = 0.5 * DENSITY * np.sum(both * (2 * far_z @ both) * np.concatenate([dy[::-1], dy]))
    assert drag == pytest.approx(energy, rel=1e-12)


def test_loads_do_not_depend_on_the_axes(wing):
    """A rigid motion of frame about the span turns position, velocity and force alike.

    The wake leaves along the body's x axis, so only the undisturbed part is invariant: compare
    wind, speed and angle of attack.
    """
    placed = placed_at(wing, 0.07)
    u, w, q = 15.0, -1.0, 0.4
    base = element_loads(placed, DENSITY, 0.0, u, w, q)
    c, s = np.cos(0.3), np.sin(0.3)
    R = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    turned_elements = placed._replace(
        **{
            name: getattr(placed, name) @ R.T
            for name in ("position", "velocity", "chord_direction", "normal", "span_direction")
        }
    )
    u2, _, w2 = R @ [u, 0.0, w]
    moved = element_loads(turned_elements, DENSITY, 0.0, u2, w2, q)
    np.testing.assert_allclose(moved.speed, base.speed, rtol=1e-13)
    np.testing.assert_allclose(moved.angle_of_attack, base.angle_of_attack, atol=1e-14)


def test_derivatives_by_the_state_are_exact(wing):
    """Against central differences, whose error falls by four when their step is halved."""
    table = prescribed_wing(wing, NO_TAIL, np.array([0.04]), 16, 0.5, False)
    placed = at_phase(table.elements, 0)
    aero = AeroConstants(DENSITY, PROFILE, NO_TAIL, BodyDrag(0.0, 0.0), SlenderBody(0.0, 0.0))
    planar = np.array([0, 2, 4])
    twist = np.array([17.0, 0.0, -1.5, 0.0, 0.7, 0.0])

    def loads(twist):
        return symmetric_loads(table, 0, aero, twist, planar)

    exact = loads(twist)[:, 1:]
    errors = []
    for h in (1e-2, 5e-3):
        steps = h * np.eye(6)[planar]
        differences = [(loads(twist + e)[:, 0] - loads(twist - e)[:, 0]) / (2 * h) for e in steps]
        errors.append(np.abs(np.column_stack(differences) - exact).max())
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.05)
    direct = element_loads(placed, DENSITY, PROFILE, *twist[planar])
    np.testing.assert_allclose(loads(twist)[::2, 0], resultant(placed, direct), rtol=1e-12)


def test_the_split_between_bones_moves_no_load(wing):
    """Who carries an element changes the torques at elbow and wrist, never at the shoulder.

    And all of an element on the hand, or shares of it on each bone, add up to the same.
    """
    angles, rates, _ = driver_motion(wing, 0.03)
    shape = wing_shape(wing, angles, rates, 16, 0.5, False)
    placed = place_elements(shape, wing.root)
    wrench = element_loads(placed, DENSITY, 0.0, 18.0, -2.0, 0.3).wrench
    chain = joint_chain(wing, angles)

    def about_joints(beyond):
        moved = twist_per_joint_rate(wing.root, wing.segment, chain, placed.position, beyond)
        return torques(moved, wrench)

    found = about_joints(shape.distal_fraction)
    nothing, everything = about_joints(np.zeros((16, 2))), about_joints(np.ones((16, 2)))
    for other in (nothing, everything):
        np.testing.assert_allclose(other[:3], found[:3], rtol=1e-13)
        assert np.abs(other[3:] - found[3:]).max() > 1e-3
    np.testing.assert_array_equal(nothing[3:], 0.0)
    # By hand: the moment of all forces about the flap's axis through the shoulder.
    moment = np.cross(placed.position - wing.root, wrench[:, :3]).sum(axis=0)
    np.testing.assert_allclose(found[1], chain.axis[1] @ moment, rtol=1e-12)
