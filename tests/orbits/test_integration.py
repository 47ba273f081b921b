import numpy as np
import pytest
from orbit_systems import van_der_pol
from scipy.integrate import solve_ivp

from birdmb.errors import StateError
from birdmb.orbits import ArgumentError, OdeModel, find_limit_cycle, floquet


def test_a_stiff_system_names_the_integrators_that_can():
    model = van_der_pol(1000, most_steps=500)
    with pytest.raises(StateError, match=r'failed after t = .*stiff.*"LSODA" or "Radau"') as caught:
        model.flow(np.array([2.0, 0.0]), 0.0, 1600.0)
    reached = float(str(caught.value).split("failed after t = ")[1].split(":")[0])
    assert 0.1 < reached < 10
    stiff = van_der_pol(1000, integrator="LSODA", rtol=1e-8)
    assert stiff.flow(np.array([2.0, 0.0]), 0.0, 100.0) == pytest.approx([1.93, -7.08e-4], rel=0.01)


def test_a_runaway_says_where_it_was():
    model = OdeModel(lambda _t, x: x**2, ("x",))
    with pytest.raises(StateError, match=r"failed after t = 0\.5.* runs away"):
        model.flow(np.array([2.0]), 0.0, 1.0)


@pytest.mark.parametrize("integrator", ["DOP853", "LSODA", "Radau"])
def test_solutions_at_times(integrator):
    model = OdeModel(
        lambda t, x: [x[1], -x[0] + np.cos(2 * t)], ("x", "v"), integrator=integrator, rtol=1e-8
    )
    times = np.array([0.0, 0.3, 0.3, 1.7, 5.0])
    path = model.trajectory(np.array([1.0, 0.0]), 0.0, 5.0, times).states
    exact = 4 / 3 * np.cos(times) - np.cos(2 * times) / 3
    assert path[:, 0] == pytest.approx(exact, abs=1e-6)
    assert path[-1] == pytest.approx(model.flow(np.array([1.0, 0.0]), 0.0, 5.0), abs=1e-12)
    assert model.flow(path[-1], 5.0, 0.0) == pytest.approx([1.0, 0.0], abs=1e-5)
    assert model.flow(path[0], 1.0, 1.0) == pytest.approx(path[0], abs=0)


def test_steps_are_those_of_scipy():
    def rhs(_t, x):
        return [x[1], (1 - x[0] ** 2) * x[1] - x[0]]

    model = OdeModel(rhs, ("x", "v"), state_scale=[1.0, 1.0])
    reference = solve_ivp(rhs, (0, 6.0), [2.0, 0.0], method="DOP853", rtol=1e-11, atol=1e-13)
    assert model.flow(np.array([2.0, 0.0]), 0.0, 6.0) == pytest.approx(
        reference.y[:, -1], abs=1e-12
    )


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"rtol": 0.0}, "rtol must be from"),
        ({"rtol": float("nan")}, "rtol must be a number"),
        ({"rtol": 1.0}, "rtol must be from"),
        ({"atol": -1.0}, "atol must hold positive"),
        ({"atol": [1e-12, 1e-12]}, "atol has shape"),
        ({"state_scale": [0.0]}, "state_scale must hold positive"),
        ({"state_scale": [np.inf]}, "state_scale must hold positive"),
        ({"guess": [np.nan]}, "guess must hold finite"),
        ({"period": np.inf}, "period must be positive"),
        ({"period": np.nan}, "period must be a number"),
        ({"integrator": "RK4"}, 'integrator must be "DOP853"'),
        ({"most_steps": 0}, "most_steps"),
    ],
)
def test_wrong_numbers_of_a_model(options, words):
    with pytest.raises(ArgumentError, match=words):
        OdeModel(lambda _t, x: -x, ("x",), **options)


@pytest.mark.parametrize(
    ("rhs", "error", "words"),
    [
        (lambda _t, _x: [1.0, 2.0], ArgumentError, r"shape \(1,\).* not float64 of shape \(2,\)"),
        (lambda _t, x: 1j * x, ArgumentError, "real values"),
        (lambda _t, x: x * np.nan, StateError, "not finite|step size"),
        (lambda _t, _x: [1 / 0], StateError, "rhs fails at t = 0: division by zero"),
    ],
)
def test_wrong_values_of_a_right_hand_side(rhs, error, words):
    with pytest.raises(error, match=words):
        floquet(OdeModel(rhs, ("x",), period=1.0), [1.0])


@pytest.mark.parametrize("tolerance", [0.0, -1e-9, 1.0, float("nan"), float("inf")])
def test_a_tolerance_that_takes_anything_for_an_orbit_is_refused(tolerance):
    model = OdeModel(lambda _t, x: -x, ("x",), period=1.0)
    with pytest.raises(
        ArgumentError, match=r"tolerance must be (positive and at most 0\.01|a number)"
    ):
        find_limit_cycle(model, [0.1], tolerance=tolerance)
    with pytest.raises(ArgumentError, match=r"closure_tolerance must be (positive|a number)"):
        floquet(model, [0.1], closure_tolerance=tolerance)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"segments": 100_000}, "at most 1000"),
        ({"segments": 2.5}, "whole number"),
        ({"start_time": np.nan}, "start_time must be a number"),
        ({"max_iterations": 0}, "max_iterations"),
    ],
)
def test_absurd_numbers_of_a_search(options, words):
    with pytest.raises(ArgumentError, match=words):
        find_limit_cycle(OdeModel(lambda _t, x: -x, ("x",), period=1.0), [0.1], **options)
