import pickle
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context

import numpy as np
import pytest
from orbit_systems import ForcedLinear, mathieu, roessler, van_der_pol

from birdmb.errors import BirdmbError, StateError
from birdmb.orbits import (
    ArgumentError,
    ConvergenceError,
    LimitCycle,
    OdeModel,
    SingularJacobianError,
    find_limit_cycle,
)
from birdmb.orbits.newton import solve


class Map:
    """A flow that is a map of the state, applied once per period."""

    state_names = ("x",)
    period = 1.0
    state_scale = np.ones(1)

    def __init__(self, function):
        self._function = function

    def flow(self, x0, _t0, _t1):
        return self._function(x0)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"guess": [1.0, 2.0, 3.0]}, r"shape \(3,\); the states x, v need \(2,\)"),
        ({"guess": [[1.0, 2.0]] * 3, "segments": 2}, r"\(2, 2\)"),
        ({"guess": [np.nan, 0.0]}, "not finite"),
        ({}, "needs a period_guess"),
        ({"period_guess": -1.0}, "must be positive"),
        ({"period_guess": 6.0, "segments": 0}, "segments must be at least 1"),
        ({"period_guess": 6.0, "jacobian": "exact"}, "finite-differences"),
        ({"period_guess": 6.0, "damping": "bisection"}, "levenberg-marquardt"),
    ],
)
def test_wrong_arguments(options, words):
    options = {"period_guess": 6.0, **options} if "guess" in options else options
    with pytest.raises(ArgumentError, match=words) as caught:
        find_limit_cycle(van_der_pol(1), **options)
    assert isinstance(caught.value, ValueError)
    assert isinstance(caught.value, BirdmbError)


def test_a_forced_system_has_its_period():
    with pytest.raises(ArgumentError, match="for autonomous systems"):
        find_limit_cycle(mathieu(1, 0.5), period_guess=3.0)


def test_no_orbit_nearby():
    # x -> x + 1 + x**2 has no fixed point; the gap is smallest, 1, at x = 0
    with pytest.raises(ConvergenceError, match=r"after .* iterations") as caught:
        find_limit_cycle(Map(lambda x: x + 1 + x**2), [1.1])
    error = pickle.loads(pickle.dumps(caught.value))
    assert error.residual == pytest.approx(1, abs=0.05)
    assert error.history[-1].residual <= error.history[0].residual
    assert str(error) == str(caught.value)


def test_iterations_run_out():
    with pytest.raises(ConvergenceError, match="used up after 2 iterations"):
        find_limit_cycle(roessler(5), period_guess=11.0, max_iterations=2)


def test_singular_jacobian():
    with pytest.raises(SingularJacobianError, match="fold"):
        find_limit_cycle(Map(lambda x: x + 1.0), [0.0])


def test_a_nan_at_the_start_is_said():
    with pytest.raises(StateError, match=r"cannot start from this guess: .*not finite"):
        find_limit_cycle(Map(lambda x: x * np.nan), [1.0])


def test_an_explosion_at_the_start_is_said():
    model = OdeModel(lambda _t, x: x**2, ("x",), period=1.0)
    with pytest.raises(StateError, match="cannot start from this guess: The integration"):
        find_limit_cycle(model, [2.0])


def test_a_nan_on_the_way_shortens_the_step():
    # Newton's first step from 10 lands at -3, where the logarithm is not real
    def step(x):
        with np.errstate(invalid="ignore"):
            return x + np.log(x) - 1

    cycle = find_limit_cycle(Map(step), [10.0])
    assert cycle.iterations[1].damping < 1
    assert cycle.x0 == pytest.approx([np.e], abs=1e-9)


def test_a_flow_that_fails_beside_the_guess_is_said():
    def step(x):
        if x[0] > 1:
            raise StateError("stalled.")
        return 0.5 * x

    with pytest.raises(ConvergenceError, match=r"beside the point reached .*stalled") as caught:
        find_limit_cycle(Map(step), [1.0])
    assert caught.value.best_x == pytest.approx([1.0])


@pytest.mark.parametrize("damping", ["line-search", "levenberg-marquardt"])
def test_every_step_reduces_the_residual(damping):
    seen = []
    cycle = find_limit_cycle(
        roessler(3.5),
        [1.0, -5.0, 0.1],
        period_guess=6.5,
        damping=damping,
        segments=1,
        callback=seen.append,
    )
    residuals = [iteration.residual for iteration in seen]
    assert len(residuals) > 3
    assert (np.diff(residuals) < 0).all()
    assert tuple(seen) == cycle.iterations


@pytest.mark.parametrize("jacobian", ["variational", "finite-differences"])
def test_an_executor_changes_no_bit(jacobian):
    options = {"period_guess": 6.5, "segments": 3, "jacobian": jacobian, "tolerance": 1e-7}
    alone = find_limit_cycle(van_der_pol(1), **options)
    with ThreadPoolExecutor(2) as executor:
        shared = find_limit_cycle(van_der_pol(1), executor=executor, **options)
    assert np.array_equal(alone.monodromy, shared.monodromy)
    assert np.array_equal(alone.multipliers, shared.multipliers)
    assert np.array_equal(alone.points, shared.points)


def test_processes_change_no_bit():
    model = ForcedLinear()
    alone = find_limit_cycle(model, [0.0, 0.0, 0.0], segments=2)
    with ProcessPoolExecutor(2, get_context("spawn")) as executor:
        shared = find_limit_cycle(model, [0.0, 0.0, 0.0], segments=2, executor=executor)
    assert np.array_equal(alone.monodromy, shared.monodromy)
    assert np.array_equal(alone.multiplier_errors, shared.multiplier_errors)


def test_a_model_brings_its_own_result():
    @dataclass(frozen=True)
    class Flight(LimitCycle):
        @property
        def mean_x(self):
            return self.trajectory().states[:-1, 0].mean()

    model = van_der_pol(1)
    model.limit_cycle_type = Flight
    cycle = find_limit_cycle(model, period_guess=6.5)
    assert isinstance(cycle, Flight)
    assert abs(cycle.mean_x) < 1e-6


def test_trajectory_dataset_and_figure():
    cycle = find_limit_cycle(van_der_pol(1), period_guess=6.5, segments=3)
    later = cycle.trajectory(np.array([0.5, 0.5 + 3 * cycle.period, 0.1]))
    assert later.states[1] == pytest.approx(later.states[0], abs=1e-7)
    assert later.states[2] == pytest.approx(cycle.model.flow(cycle.x0, 0, 0.1), abs=1e-7)
    data = cycle.to_xarray()
    assert data["trajectory"].sel(state="x").max() == pytest.approx(2.0086198608748, abs=1e-3)
    assert data.attrs["stability"] == "stable"
    figure = cycle.plot()
    assert [axes.get_ylabel() for axes in figure.axes] == ["x", "v", r"Im $\Lambda$"]


class Arctangent:
    """arctan(x) = 0, from which full Newton steps lead away beyond |x| = 1.39."""

    expensive_jacobian = False

    def residual(self, u):
        return np.arctan(u)

    def jacobian(self, u):
        return np.diag(1 / (1 + u**2))

    def start_and_period(self, u):
        return u, 1.0

    def closure(self, residual):
        return float(np.abs(residual).max())


@pytest.mark.parametrize(("shortest", "found"), [(1 / 16, True), (1 / 8, True), (1 / 4, False)])
def test_a_line_search_ends_at_its_shortest_step(shortest, found):
    """From 8 a quarter of the full step leads to -15.5, too far; an eighth to -3.75."""
    options = {"damping": "line-search", "tolerance": 1e-12, "max_iterations": 20}
    start = np.array([8.0])
    if found:
        solution = solve(Arctangent(), start, shortest_damping=shortest, **options)[0]
        assert solution == pytest.approx([0.0], abs=1e-12)
    else:
        with pytest.raises(ConvergenceError, match="no step along the search direction"):
            solve(Arctangent(), start, shortest_damping=shortest, **options)
