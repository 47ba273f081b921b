"""Orbits that coexist in one system are all found, each once, with the right multipliers."""

import numpy as np
import pytest
from orbit_systems import ForcedLinear
from scipy.integrate import solve_ivp

from birdmb.errors import StateError
from birdmb.orbits import ArgumentError, OdeModel, find_limit_cycle, find_limit_cycles

DAMPING, FORCE, FREQUENCY = 0.1, 0.3, 1.5


def duffing_rhs(t, x):
    return [x[1], -DAMPING * x[1] - x[0] - x[0] ** 3 + FORCE * np.cos(FREQUENCY * t)]


def duffing():
    """Between its folds: a small stable cycle, a large stable one and an unstable one between."""
    period = 2 * np.pi / FREQUENCY
    return OdeModel(duffing_rhs, ("x", "v"), period=period, guess=[0.3, 0.0])


def multipliers_by_scipy(x0, period):
    """State after a period and multipliers, by scipy's integration of the variational equations."""

    def both(t, y):
        matrix = np.array([[0, 1], [-1 - 3 * y[0] ** 2, -DAMPING]])
        return np.concatenate([duffing_rhs(t, y[:2]), (matrix @ y[2:].reshape(2, 2)).ravel()])

    start = np.concatenate([x0, np.eye(2).ravel()])
    end = solve_ivp(both, (0, period), start, "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    return end[:2], np.linalg.eigvals(end[2:].reshape(2, 2))


def test_deflation_finds_duffings_three_cycles_from_one_guess():
    found = find_limit_cycles(duffing())
    assert [cycle.stability for cycle in found] == ["stable", "unstable", "stable"]
    amplitudes = [np.ptp(cycle.trajectory().states[:, 0]) / 2 for cycle in found]
    # Harmonic balance: A^2 ((1 + 3/4 A^2 - w^2)^2 + (damping w)^2) = F^2, a cubic in A^2.
    detuning = 1 - FREQUENCY**2
    cubic = [9 / 16, 1.5 * detuning, detuning**2 + (DAMPING * FREQUENCY) ** 2, -(FORCE**2)]
    assert np.allclose(amplitudes, np.sqrt(np.sort(np.roots(cubic).real)), rtol=0.03)
    for cycle in found:
        end, expected = multipliers_by_scipy(cycle.x0, cycle.period)
        assert np.allclose(end, cycle.x0, atol=1e-6)
        assert np.allclose(np.sort_complex(cycle.multipliers), np.sort_complex(expected), atol=1e-6)
        # Liouville: the divergence is -damping everywhere.
        assert np.prod(cycle.multipliers).real == pytest.approx(np.exp(-DAMPING * cycle.period))


def test_without_deflation_one_start_leads_to_one_cycle():
    assert len(find_limit_cycles(duffing(), deflations=0)) == 1


def test_many_starts_lead_to_the_same_three():
    starts = [[x, v] for x in range(-2, 3) for v in range(-2, 3)]
    found = find_limit_cycles(duffing(), starts, deflations=0)
    assert len(found) == 3
    for one, other in zip(found, find_limit_cycles(duffing()), strict=True):
        assert np.allclose(one.x0, other.x0, atol=1e-6)


def test_three_cycles_in_closed_form():
    """x = y + sin t with y' = k (y - y^3): y = 0 and y = +-1, multipliers e^kT and e^-2kT."""
    k, period = 0.1, 2 * np.pi

    def rhs(t, x):
        y = x - np.sin(t)
        return np.cos(t) + k * (y - y**3)

    model = OdeModel(rhs, ("x",), period=period)
    found = find_limit_cycles(model, [[0.2]], key=lambda cycle: cycle.x0[0])
    assert np.allclose([cycle.x0[0] for cycle in found], [-1, 0, 1], atol=1e-7)
    expected = [np.exp(-2 * k * period), np.exp(k * period), np.exp(-2 * k * period)]
    assert np.allclose([cycle.multipliers[0] for cycle in found], expected, rtol=1e-6)


OMEGA, INNER, OUTER, STRENGTH = 3.0, 1.0, 2.0, 0.05


def nested():
    """r' = s r (r^2 - 1)(4 - r^2): circles of radius 1, unstable, and 2, stable; rest at 0."""

    def rhs(_t, x):
        growth = STRENGTH * (x @ x - INNER**2) * (OUTER**2 - x @ x)
        return [growth * x[0] - OMEGA * x[1], growth * x[1] + OMEGA * x[0]]

    return OdeModel(rhs, ("x", "y"), guess=[2.3, 0.1])


def check_nested(found):
    assert len(found) == 2
    period = 2 * np.pi / OMEGA
    for cycle, radius in zip(found, (INNER, OUTER), strict=True):
        assert cycle.period == pytest.approx(period)
        assert np.linalg.norm(cycle.points, axis=1) == pytest.approx(radius)
        slope = STRENGTH * 2 * radius**2 * (OUTER**2 + INNER**2 - 2 * radius**2)
        (along,) = cycle.multipliers[np.arange(2) != cycle.trivial_index]
        assert along == pytest.approx(np.exp(slope * period), rel=1e-6)


def test_nested_cycles_of_an_autonomous_system_from_one_guess():
    found = find_limit_cycles(nested(), period_guess=2.5)
    check_nested(sorted(found, key=lambda cycle: np.linalg.norm(cycle.x0)))


def test_an_orbit_counts_once_at_any_phase_and_however_often_it_goes_round():
    once, inner = [0.0, 2.0], [1.01, 0.0]
    starts = [once, [-2.0, 0.0], [np.sqrt(2), -np.sqrt(2)], inner, once]
    periods = [2.1, 2.1, 2.1, 2.1, 4.2]
    found = find_limit_cycles(nested(), starts, period_guess=periods, deflations=0)
    check_nested(sorted(found, key=lambda cycle: np.linalg.norm(cycle.x0)))


def test_what_is_known_is_not_found_again():
    outer = find_limit_cycle(nested(), period_guess=2.1)
    found = find_limit_cycles(nested(), period_guess=2.1, known=[outer])
    check_nested([*found, outer])


class Pendulum(OdeModel):
    """Damped and shaken at its pivot; its angle means the same a full turn further on."""

    state_periods = np.array([2 * np.pi, np.inf])

    def __init__(self):
        super().__init__(
            lambda t, x: [x[1], -0.5 * x[1] - np.sin(x[0]) + 0.3 * np.cos(t)],
            ("angle", "rate"),
            period=2 * np.pi,
            state_scale=[1.0, 1.0],
        )


def test_orbits_a_full_turn_apart_are_one():
    starts = [[0.0, 0.0], [2 * np.pi, 0.0], [-4 * np.pi, 0.1]]
    (found,) = find_limit_cycles(Pendulum(), starts, deflations=0)
    assert abs(found.trajectory().states[:, 0].mean()) < 0.1


def test_a_model_without_a_right_hand_side_is_shot():
    model = ForcedLinear()
    (found,) = find_limit_cycles(model, [[0, 0, 0], [1, 2, 3], [-4, 0, 1]])
    assert found.method == "shooting"
    assert np.allclose(found.x0, model.orbit(0.0), atol=1e-8)


def test_progress_is_told_and_an_interrupt_gets_through():
    attempts = []
    find_limit_cycles(duffing(), [[0, 0], [1, 1]], deflations=3, callback=attempts.append)
    stages = [attempt.stage for attempt in attempts]
    assert stages == ["starts"] * 2 + ["deflation"] * 3 + ["refinement"] * attempts[-1].of
    assert all(attempt.done <= attempt.of for attempt in attempts)

    def stop(_attempt):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        find_limit_cycles(duffing(), callback=stop)


def test_two_searches_find_the_very_same():
    one, other = find_limit_cycles(duffing()), find_limit_cycles(duffing())
    assert [cycle.x0.tolist() for cycle in one] == [cycle.x0.tolist() for cycle in other]


def test_no_orbit_is_an_empty_list():
    """x' = 1 + x^2: every solution runs away."""
    model = OdeModel(lambda t, x: 1 + x**2 + 0 * np.cos(t), ("x",), period=1.0)
    path = np.zeros((9, 1))
    assert find_limit_cycles(model, [path]) == []


def test_a_right_hand_side_that_fails_everywhere_is_told():
    def rhs(_t, _x):
        raise ValueError("no air")

    model = OdeModel(rhs, ("x",), period=1.0)
    with pytest.raises(StateError, match="no air"):
        find_limit_cycles(model, [np.zeros((9, 1))])


@pytest.mark.parametrize(
    ("starts", "options", "says"),
    [
        ([], {}, "starts is empty"),
        ([[1.0, 0.0]], {}, "period_guess"),
        ([[1.0, 0.0]], {"period_guess": [1.0, 2.0]}, "2 values for 1 starts"),
        ([[1.0]], {"period_guess": 2.0}, "shape"),
        ([[1.0, 0.0]], {"period_guess": 2.0, "deflations": -1}, "deflations"),
        ([[1.0, 0.0]], {"period_guess": 2.0, "tolerance": 1.0}, "tolerance"),
    ],
)
def test_wrong_arguments(starts, options, says):
    with pytest.raises(ArgumentError, match=says):
        find_limit_cycles(nested(), starts, **options)
