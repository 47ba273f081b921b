import numpy as np
import pytest
from orbit_systems import ROESSLER, roessler, stuart_landau, van_der_pol

from birdmb.orbits import EquilibriumError, find_limit_cycle


@pytest.mark.parametrize("segments", [1, 4])
@pytest.mark.parametrize("method", ["newton", "levenberg-marquardt"])
def test_van_der_pol(segments, method):
    cycle = find_limit_cycle(van_der_pol(1), period_guess=6.5, segments=segments, method=method)
    assert cycle.period == pytest.approx(6.663286859323, abs=1e-8)
    assert cycle.multipliers == pytest.approx([1, 8.59695e-4], abs=2e-8)
    assert cycle.trivial_index == 0
    assert cycle.stability == "stable"


def test_stiffer_van_der_pol():
    cycle = find_limit_cycle(van_der_pol(3), period_guess=8.8, segments=10)
    assert cycle.period == pytest.approx(8.859095499720, abs=1e-8)
    assert cycle.liouville_defect() < 1e-8
    assert cycle.multipliers[1] == pytest.approx(6.99e-16, rel=1e-3)


def test_stuart_landau():
    mu = 0.3
    cycle = find_limit_cycle(stuart_landau(mu), [0.8, 0.0], period_guess=3.0)
    assert cycle.period == pytest.approx(np.pi, abs=1e-9)
    assert cycle.multipliers == pytest.approx([1, np.exp(-2 * mu * np.pi)], abs=1e-9)
    assert cycle.doubling_times[1] == pytest.approx(np.log(2) / (2 * mu))
    assert cycle.exponents[1] == pytest.approx(-2 * mu)


@pytest.mark.parametrize(("c", "period_guess"), [(3.5, 5.9), (5.0, 11.9)])
def test_roessler(c, period_guess):
    guess = [0.0, -4.6, 0.05] if c == 3.5 else None
    cycle = find_limit_cycle(roessler(c), guess, period_guess=period_guess, segments=2)
    period, multiplier = ROESSLER[c]
    assert cycle.period == pytest.approx(period, abs=1e-8)
    assert cycle.multipliers[1] == pytest.approx(multiplier, abs=1e-8)


def test_going_round_twice_squares_the_multipliers():
    once = find_limit_cycle(roessler(3.5), [0.0, -4.6, 0.05], period_guess=5.9)
    twice = find_limit_cycle(roessler(3.5), once.x0, period_guess=2 * once.period, segments=2)
    assert twice.period == pytest.approx(2 * once.period, abs=1e-7)
    assert twice.multipliers[1] == pytest.approx(once.multipliers[1] ** 2, abs=1e-7)


@pytest.mark.parametrize("method", ["newton", "levenberg-marquardt"])
def test_an_equilibrium_is_not_a_cycle(method):
    with pytest.raises(EquilibriumError, match="ended on an equilibrium") as caught:
        find_limit_cycle(van_der_pol(1), [0.01, 0.0], period_guess=6.3, method=method)
    assert np.abs(caught.value.best_x).max() < 1e-5


def test_a_cycle_that_does_not_exist_ends_on_the_equilibrium():
    with pytest.raises(EquilibriumError):
        find_limit_cycle(stuart_landau(-0.2), [0.3, 0.0], period_guess=3.0)
