"""The wake's lags against what vortices of finite length induce, and against Jones's wings."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from birdmb.aerodynamics.elements import place_elements
from birdmb.aerodynamics.pair import pair_system
from birdmb.aerodynamics.unsteady_circulation import lag_system, unsteady_circulations
from birdmb.aerodynamics.wake_lags import (
    AT_ONCE,
    BOUND_SHARES,
    TRAILING_RATES,
    TRAILING_SHARES,
    wake_lags,
)
from birdmb.wing.line import station_parameters
from birdmb.wing.shape import WingShape

THIN = [2.0 * np.pi, 0.0, 0.0]


def elliptic_wing(aspect_ratio, elements):
    """Half of a flat elliptic wing of half span 1."""
    y = station_parameters(2 * elements)
    line = np.column_stack([np.zeros_like(y), y, np.zeros_like(y)])
    root = 8.0 / (np.pi * aspect_ratio)
    each = (elements, 1)
    still = np.zeros((elements, 3))
    return WingShape(
        line, still, np.tile([-1.0, 0.0, 0.0], each), np.tile([0.0, 0.0, -1.0], each),
        np.tile([0.0, 1.0, 0.0], each), root * np.sqrt(1.0 - y[0::2] ** 2), np.tile(THIN, each),
        np.zeros((elements, 2)), True, np.zeros((0, elements, 6)), still,
    )  # fmt: skip


def test_what_acts_at_once_and_what_lags_make_the_whole():
    assert AT_ONCE + sum(BOUND_SHARES) == pytest.approx(1.0, abs=1e-15)
    assert sum(TRAILING_SHARES) == pytest.approx(1.0, abs=1e-15)


def test_trailing_vortices_grow_as_horseshoes_do():
    """Horseshoes of finite length on an elliptic wing, without the two-dimensional shed vortex."""
    count = 400
    theta = np.pi * np.arange(count + 1) / count
    node, y = -np.cos(theta), -np.cos(0.5 * (theta[1:] + theta[:-1]))
    circulation = np.sqrt(1.0 - y**2)
    away = y[:, None] - node

    def downwash(length):
        whole = np.isinf(length)
        trailing = 1.0 if whole else length / np.hypot(length, away)
        trailing = trailing / (4.0 * np.pi * away)
        found = (trailing[:, :-1] - trailing[:, 1:]) @ circulation
        found = found if found[count // 2] > 0 else -found
        if whole:
            return found
        ends = -away / np.hypot(length, away)
        shed = (ends[:, 1:] - ends[:, :-1]) / (4.0 * np.pi * length)
        return found + shed @ circulation - circulation / (2.0 * np.pi * length)

    weight = circulation * np.diff(node)
    whole = weight @ downwash(np.inf)
    assert whole == pytest.approx(0.25 * weight.sum(), rel=1e-4)  # elliptic: G/(4 half spans)
    for length in (0.05, 0.1, 0.3, 0.7, 1.5, 3.0, 6.0):
        kept = 1.0 - sum(
            c * np.exp(-d * length) for c, d in zip(TRAILING_SHARES, TRAILING_RATES, strict=True)
        )
        assert kept == pytest.approx(weight @ downwash(length) / whole, abs=0.045), length


# R. T. Jones, NACA Report 681 (1940): indicial lift relative to its final value.
JONES = {3: (0.283, 0.540), 6: (0.361, 0.381)}


@pytest.mark.parametrize("aspect_ratio", JONES)
def test_the_start_of_an_elliptic_wing(aspect_ratio):
    """Below 5 % of the final lift from one half chord on: 2.4 % and 1.6 % at the most."""
    elements, points = 24, 24
    shape = elliptic_wing(aspect_ratio, elements)
    placed = place_elements(shape, np.zeros(3))
    lags = wake_lags(elements, points)
    influence = pair_system(placed, placed, True)
    system = lag_system(placed, placed, influence.induced_y, influence.induced_z, lags)
    driving = speed = np.ones((elements, 1))

    def unsteady(states):
        return unsteady_circulations(system, lags, driving, speed, states, False)

    half_chord = 4.0 / (np.pi * aspect_ratio)
    travelled = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 15.0, 20.0])
    start = np.zeros(4 * lags.kept.size)
    found = solve_ivp(
        lambda _, x: unsteady(x).lag_rates[:, 0], (0.0, 20.0 * half_chord), start,
        "LSODA", travelled * half_chord, rtol=1e-7, atol=1e-9,
    )  # fmt: skip
    steady = np.linalg.solve(influence.matrix, system.per_velocity)
    lift = np.array([placed.width @ unsteady(x).circulation[:, 0] for x in found.y.T])
    lift /= placed.width @ steady
    share, rate = JONES[aspect_ratio]
    difference = lift - (1.0 - share * np.exp(-rate * travelled))
    assert np.abs(difference[1:]).max() < 0.03
    # The first half chord: Wagner's half of the lift, where Jones has the edge's velocity in it.
    assert lift[0] == pytest.approx(0.5 * (1.0 + 2.0 / aspect_ratio), rel=0.01)


@pytest.mark.parametrize("points", [4, 6, 24])
def test_steady_circulations_are_those_of_all_elements(points):
    elements = 24
    placed = place_elements(elliptic_wing(6.0, elements), np.zeros(3))
    lags = wake_lags(elements, points)
    influence = pair_system(placed, placed, True)
    system = lag_system(placed, placed, influence.induced_y, influence.induced_z, lags)
    driving = 1.0 + np.sin(np.arange(elements))[:, None]  # nothing that a spline would follow
    speed, count = np.full((elements, 1), 3.0), 4 * lags.kept.size
    at_zero = unsteady_circulations(system, lags, driving, speed, np.zeros(count), True)
    settled = np.linalg.solve(at_zero.lag_rates[:, 1:], -at_zero.lag_rates[:, 0])
    found = unsteady_circulations(system, lags, driving, speed, settled, False)
    expected = np.linalg.solve(influence.matrix, system.per_velocity * driving[:, 0])
    np.testing.assert_allclose(found.lag_rates, 0.0, atol=1e-9)
    np.testing.assert_allclose(found.circulation[:, 0], expected, atol=1e-12)
    np.testing.assert_allclose(found.trailing[:, 0], expected, atol=1e-12)
    np.testing.assert_allclose(found.shed, 0.0, atol=1e-12)
