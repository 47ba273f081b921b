"""What is found does not depend on the units of the states, and its error bars hold in all."""

import numpy as np
import pytest
import scipy.linalg

from birdmb.orbits import OdeModel, find_limit_cycle, floquet

UNITS = [1e-12, 1e-9, 1e-6, 1e-2, 1.0, 1e6, 1e12]


def in_units(rhs, units, names, **options):
    """The system x' = rhs(t, x) with its states given in other units."""
    units = np.array(units)
    return OdeModel(lambda t, x: units * rhs(t, x / units), names, **options)


def hill(_t, x):
    """Equilibrium 1, where the derivative is 1: the multiplier of a period 1 is e."""
    return 2 * x**4 / (1 + x**4) - x


def swing(_t, x):
    """Cycle x^2 + y^2 = 0.3 of period pi, multipliers 1 and exp(-0.6 pi)."""
    growth = 0.3 - x @ x
    return np.array([growth * x[0] - 2 * x[1], growth * x[1] + 2 * x[0]])


LAG = np.array([[0, 1, 0], [-9, -0.3, 0.5], [0, 2, -1.5]])


def forced(t, x):
    return LAG @ x + np.array([0, 4.0, 1.0]) * np.cos(np.pi * t)


@pytest.mark.parametrize("unit", UNITS)
def test_an_equilibrium_in_any_unit(unit):
    found = floquet(in_units(hill, [unit], ("x",), period=1.0), [unit])
    assert abs(found.multipliers[0] - np.e) < found.multiplier_errors[0] < 1e-8
    assert found.stability == "unstable"


@pytest.mark.parametrize("unit", UNITS)
def test_a_cycle_in_any_units(unit):
    exact = [1, np.exp(-0.6 * np.pi)]
    model = in_units(swing, [unit, 1.0], ("x", "y"))
    found = find_limit_cycle(model, [0.57 * unit, 0.0], period_guess=3.2)
    errors = np.abs(found.multipliers - exact)
    assert (errors < found.multiplier_errors).all()
    assert found.multiplier_errors.max() < 1e-8
    assert np.hypot(*found.x0 / [unit, 1.0]) == pytest.approx(np.sqrt(0.3), abs=1e-8)


@pytest.mark.parametrize("integrator", ["DOP853", "LSODA"])
@pytest.mark.parametrize("unit", [1e-9, 1e3])
def test_states_far_apart(unit, integrator):
    # from a guess of zero, the sizes 1e-9, 1 and 1e-18 side by side
    model = in_units(
        forced, [unit, 1.0, unit**2], ("a", "b", "c"), period=2.0, integrator=integrator
    )
    found = find_limit_cycle(model, [0.0, 0.0, 0.0])
    exact = np.linalg.eigvals(scipy.linalg.expm(2 * LAG))
    exact = exact[np.lexsort((-exact.imag, -np.abs(exact)))]
    assert (np.abs(found.multipliers - exact) < found.multiplier_errors).all()
    assert found.multiplier_errors.max() < 1e-8


def test_error_bars_are_not_absurd():
    # The errors of well-behaved systems are about the tolerance, 1e-11; the bars stay near it.
    bars = [
        floquet(in_units(hill, [unit], ("x",), period=1.0), [unit]).multiplier_errors[0]
        for unit in UNITS
    ]
    assert np.median(bars) < 1e3 * 1e-11


def test_absolute_tolerances_of_the_user_count():
    unit = 1e-9
    exact = [1, np.exp(-0.6 * np.pi)]
    model = in_units(swing, [unit, unit], ("x", "y"), atol=1e-13)
    found = find_limit_cycle(model, [0.57 * unit, 0.0], period_guess=3.2, method="shooting")
    assert (np.abs(found.multipliers - exact) < found.multiplier_errors).all()
    assert found.multiplier_errors.min() > 1e-4


@pytest.mark.parametrize(
    ("guess", "relative"),
    # The path from the last is of the orbit's order of magnitude, and its scale is kept.
    [(1.0, 0.01), (1e-5, 0.01), (1e-7, 0.9)],
)
def test_the_scale_follows_from_the_guess_to_the_orbit(guess, relative):
    # x' = cos t - x - x^3 / 10 in units of 1e-6; its period-1 orbit from a search in unit 1
    def rhs(t, x):
        return np.cos(t) - x - 0.1 * x**3

    exact = find_limit_cycle(OdeModel(rhs, ("x",), period=2 * np.pi), [0.5])
    model = in_units(rhs, [1e-6], ("x",), period=2 * np.pi)
    found = find_limit_cycle(model, [guess])
    assert found.x0 * 1e6 == pytest.approx(exact.x0, abs=1e-8)
    assert found.multipliers == pytest.approx(exact.multipliers, rel=1e-8)
    size = np.abs(exact.trajectory().states).max()
    assert found.state_scale * 1e6 == pytest.approx([size], rel=relative)


def test_a_state_at_rest_takes_the_size_of_its_answer():
    # z stays at zero on the orbit and answers to x in units of 1e-7; its own decay is nonlinear
    unit = 1e-7

    def rhs(_t, x):
        growth = 1 - x[0] ** 2 - x[1] ** 2
        z = x[2] / unit
        return [
            growth * x[0] - x[1],
            growth * x[1] + x[0],
            unit * (-0.1 * np.tanh(10 * z) / (1 + z**2) + growth),
        ]

    found = find_limit_cycle(OdeModel(rhs, ("x", "y", "z")), [1.0, 0.0, 0.0], period_guess=6.3)
    exact = [1, np.exp(-2 * np.pi), np.exp(-4 * np.pi)]
    assert (np.abs(found.multipliers - exact) < found.multiplier_errors).all()
    assert found.multiplier_errors.max() < 1e-7


def test_round_off_of_others_is_no_size():
    # z is driven by what round-off leaves of a difference; its scale is not 1e-17
    def rhs(t, x):
        return [x[1], np.cos(t) - x[0] - 0.3 * x[1], (x[0] * 3.7) / 3.7 - x[0] - x[2]]

    model = OdeModel(rhs, ("x", "v", "z"), period=2 * np.pi)
    found = find_limit_cycle(model, [0.3, 0.1, 0.0])
    assert found.state_scale[2] == 1.0
    assert found.multipliers[2] == pytest.approx(np.exp(-2 * np.pi), abs=1e-9)


@pytest.mark.parametrize(
    ("width", "at", "decay", "multiplier"),
    [
        # tanh rises at the slope 1 through `at`, within far less than the states are large.
        (1e-6, 0.0, 0.5, np.exp(0.5)),
        (1e-6, 0.0, 1.5, np.exp(-0.5)),
        (1e-3, 300.0, 0.5, np.exp(0.5)),
        (1e-4, -1.0, 1.25, np.exp(-0.25)),
    ],
)
def test_a_right_hand_side_that_bends_sharply(width, at, decay, multiplier):
    def rhs(_t, x):
        return [width * np.tanh((x[0] - at) / width) - decay * (x[0] - at)]

    found = floquet(OdeModel(rhs, ("x",), period=1.0), [at])
    error = abs(found.multipliers[0] - multiplier)
    assert error < found.multiplier_errors[0] < 1e-5
    assert found.stability == ("unstable" if multiplier > 1 else "stable")
