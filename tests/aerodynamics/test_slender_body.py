"""Side force and Munk's moment of the body."""

import numpy as np
import pytest

import birdmb
from birdmb.aerodynamics.airframe import aero_constants, body_loads
from birdmb.aerodynamics.slender_body import SlenderBody, slender_body_loads

DENSITY = 1.225


def test_moment_of_a_slender_body_turns_it_across_the_stream():
    """1/2 rho V^2 sin(2 alpha) vol; 12 m/s at 0.1 rad, a litre: 0.017523 N m."""
    alpha = 0.1
    velocity = 12.0 * np.array([np.cos(alpha), 0.0, np.sin(alpha)])
    loads = slender_body_loads(SlenderBody(0.0, 1e-3), DENSITY, velocity)[:, 0]
    assert loads == pytest.approx([0, 0, 0, 0, 0.017523, 0], abs=1e-6)  # nose up, away from it
    sideways = velocity[[0, 2, 1]]
    loads = slender_body_loads(SlenderBody(0.0, 1e-3), DENSITY, sideways)[:, 0]
    # Moving to the right, the wind comes from there: the nose goes to the left.
    assert loads == pytest.approx([0, 0, 0, 0, 0, -0.017523], abs=1e-6)


def test_side_force_is_that_of_its_coefficient():
    """1/2 x 1.225 x 100 x 0.02 x 0.5 x 0.1 = 0.06125 N per 0.1 rad, against the slip."""
    body = SlenderBody(0.02 * 0.5, 0.0)
    velocity = 10.0 * np.array([np.cos(0.1), np.sin(0.1), 0.0])
    force = slender_body_loads(body, DENSITY, velocity)[:, 0]
    assert force == pytest.approx([0, -0.06125 * np.sin(0.1) / 0.1, 0, 0, 0, 0])


def test_derivatives_are_exact():
    body, at, h = SlenderBody(0.02, 1e-3), np.array([11.0, -1.5, 0.7]), 1e-4
    exact = slender_body_loads(body, DENSITY, at)[:, 1:]
    columns = [
        (slender_body_loads(body, DENSITY, at + e) - slender_body_loads(body, DENSITY, at - e))[
            :, 0
        ]
        for e in h * np.eye(3)
    ]
    np.testing.assert_allclose(exact, np.column_stack(columns) / (2 * h), atol=1e-9)
    assert not slender_body_loads(body, DENSITY, np.zeros(3)).any()


def test_it_unsettles_pitch_and_yaw_of_a_bird_and_costs_no_energy(ibis_tail):
    values = {"body.side_area": 0.02, "body.side_coefficient": 0.5, "body.volume": 1.2e-3}
    stout = ibis_tail.with_values(values | {"wing.discretisation": 16})
    slim = ibis_tail.with_values({"wing.discretisation": 16})
    assert not body_loads(aero_constants(slim), np.array([14.0, 1.0, -1.0]))[3:].any()
    slow = {}
    for bird in (stout, slim):
        cycle = birdmb.find_limit_cycle(birdmb.RigidModel(bird, motion="free"))
        assert cycle.energy_imbalance < 1e-6
        named = {mode.name: mode for mode in cycle.flight_modes}
        slow[bird.body.volume] = {name: mode.multiplier for name, mode in named.items()}
    short = "short period"
    # Without a restoring moment the short period and the Dutch roll swing more slowly.
    assert np.angle(slow[1.2e-3]["Dutch roll"]) ** 2 < np.angle(slow[None]["Dutch roll"]) ** 2
    assert slow[1.2e-3][short] != pytest.approx(slow[None][short], abs=1e-3)
