"""Sections with a lift slope, a zero-lift angle and a moment of their own."""

import numpy as np
import pytest

import birdmb
from birdmb.aerodynamics.airframe import aero_constants
from birdmb.aerodynamics.elements import place_elements
from birdmb.aerodynamics.prescribed import free_loads, odd_wakes, prescribed_wing
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.shape import wing_shape

from .pairs import element_loads, resultant
from .test_circulation import DENSITY, flat_wing

CAMBERED = {
    "wing.profile.lift_slope": 5.7,
    "wing.profile.zero_lift_angle_deg": -3.0,
    "wing.profile.moment_coefficient": -0.06,
}
SPEED = 12.0


def with_profile(shape, slope, zero_lift, moment):
    return shape._replace(profile=np.tile([slope, zero_lift, moment], (shape.chord.size, 1)))


@pytest.mark.parametrize("slope", [2 * np.pi, 5.0])
def test_an_elliptic_wing_has_the_exact_lift(slope):
    """Prandtl: C_L = a (alpha - alpha_0)/(1 + a/(pi AR)), of any lift slope a; second order."""
    alpha, zero_lift = np.radians(0.2), np.radians(-0.4)
    aspect_ratio = 2.0**2 / (np.pi / 4 * 2.0 * 0.4)
    exact = slope * (alpha - zero_lift) / (1 + slope / (np.pi * aspect_ratio))
    area = np.pi / 4 * 2.0 * 0.4
    errors = []
    for n in (16, 32, 64):
        shape = flat_wing(lambda y: 0.4 * np.sqrt(1 - y**2), n)
        placed = place_elements(with_profile(shape, slope, zero_lift, 0.0), np.zeros(3))
        u, w = SPEED * np.cos(alpha), SPEED * np.sin(alpha)
        fx, fz, _ = resultant(placed, element_loads(placed, DENSITY, 0.0, u, w, 0.0))
        lift = -fz * np.cos(alpha) + fx * np.sin(alpha)
        errors.append(abs(lift / (0.5 * DENSITY * SPEED**2 * area) / exact - 1))
    assert errors[-1] < 1e-4
    assert np.log2(errors[0] / errors[1]) > 1.8


def test_the_moment_is_that_of_the_section():
    """A rectangle at zero lift: its moment is C_m q S c, whatever its incidence adds to others."""
    chord, coefficient = 0.2, -0.08
    shape = flat_wing(lambda y: chord + 0 * y, 32)
    placed = place_elements(with_profile(shape, 5.5, 0.0, coefficient), np.zeros(3))
    loads = element_loads(placed, DENSITY, 0.0, SPEED, 0.0, 0.0)
    assert np.abs(loads.wrench[:, :3]).max() < 1e-14
    moment = coefficient * 0.5 * DENSITY * SPEED**2 * (2.0 * chord) * chord
    assert resultant(placed, loads)[2] == pytest.approx(moment, rel=1e-12)


def test_derivatives_with_respect_to_the_twist_are_exact(ibis):
    bird = ibis.with_values(CAMBERED)
    wing, aero = wing_arrays(bird), aero_constants(bird)
    table = prescribed_wing(wing, aero.tail, np.array([0.02]), 12, 0.5, False)
    wakes, every = odd_wakes(table), np.arange(6)
    twist = np.array([15.0, 0.8, -1.0, 0.4, 0.6, -0.3])

    def loads(at):
        return free_loads(table, table, wakes, 0, aero, at, every)

    exact, errors = loads(twist)[:, 1:], []
    for h in (1e-2, 5e-3):
        steps = h * np.eye(6)
        differences = [(loads(twist + e)[:, 0] - loads(twist - e)[:, 0]) / (2 * h) for e in steps]
        errors.append(np.abs(np.column_stack(differences) - exact).max())
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.05)


def test_profiles_go_linearly_from_section_to_section():
    """A plate whose sections differ: between them the profile is their mean, by distance."""
    document = {
        "name": "plate", "gait": {"frequency": 4.0}, "body": {"mass": 0.2, "inertia_yy": 1e-3},
        "wing": {"root": {"x": 0.0, "y": 0.0}, "profile": {"lift_slope": 6.0}},
        "segments": {"bar": {"length": 0.3, "mass": 0.004, "inertia": [1e-5, 1e-7, 1e-5]}},
        "joints": [{"name": "a.flap", "segment": "bar", "axis": [-1, 0, 0], "amplitude_deg": 20}],
        "sections": [
            {"name": "root", "bone": "bar", "position": 0, "chord": 0.1},
            {"name": "mid", "bone": "bar", "position": 0.5, "chord": 0.1,
             "profile": {"lift_slope": 4.0, "zero_lift_angle_deg": -2.0}},
            {"name": "tip", "bone": "bar", "position": 1, "chord": 0.1,
             "profile": {"moment_coefficient": -0.1}},
        ],
    }  # fmt: skip
    bird = birdmb.Bird.model_validate(document)
    still = np.zeros(1)
    shape = wing_shape(wing_arrays(bird), still, still, 64, 0.2, False)
    y = shape.line[0::2, 1]
    outside = np.abs(y - 0.15) > 0.2 * 0.075  # of what the rounding of the middle section reaches
    for column, values in enumerate(
        ([6.0, 4.0, 2 * np.pi], [0.0, np.radians(-2.0), 0.0], [0.0, 0.0, -0.1])
    ):
        expected = np.interp(y, [0.0, 0.15, 0.3], values)
        np.testing.assert_allclose(
            shape.profile[outside, column], expected[outside], rtol=1e-12, atol=1e-15
        )


@pytest.mark.parametrize("model", [birdmb.RigidModel, birdmb.MultibodyModel])
def test_energy_closes_with_moments_acting(ibis_compliant, model):
    """And a cambered wing is trimmed elsewhere: nose down, at less incidence."""
    bird = ibis_compliant.with_values(CAMBERED)
    cycle = birdmb.find_limit_cycle(model(bird))
    assert cycle.energy_imbalance < 1e-6
    assert np.abs(cycle.beat.loads_along.stack.right.moment).max() > 1e-3
    if model is birdmb.RigidModel:  # without mass, what the wings deliver the air takes
        assert sum(cycle.dissipation.values()) == pytest.approx(cycle.corrected_power, rel=1e-6)


def test_hinged_feathers_feel_the_moment():
    """By virtual work: a nose-down moment turns a feather's hinge leading edge down."""
    bird = birdmb.load_bird("ibis_hinged_feathers")
    plain, cambered = (
        birdmb.RigidModel(b).loads(0.03, [17.0, -0.5, 0.0, 0.0]).right
        for b in (bird, bird.with_values({"wing.profile.moment_coefficient": -0.06}))
    )
    np.testing.assert_array_equal(plain.force, cambered.force)
    np.testing.assert_array_equal(plain.moment, 0.0)
    change = cambered.joint_torques - plain.joint_torques
    assert (change[-2:] < 0.0).all()
    # All of the wing's moment is about the shoulder.
    axis = np.array(bird.joints[0].axis)
    assert change[0] == pytest.approx(axis @ cambered.moment.sum(axis=0), rel=1e-12)
