import numpy as np
import pytest
from orbit_systems import mathieu, roessler, van_der_pol

from birdmb.orbits import ArgumentError, OdeModel, find_limit_cycle, floquet


def lag(omega=1.3, **options):
    return OdeModel(lambda t, x: [np.cos(omega * t) - x[0]], ("x",), guess=[0.1], **options)


@pytest.mark.parametrize("period", [1 / 1.3, 2 * np.pi, 1.0001 * 2 * np.pi / 1.3, np.pi / 1.3])
def test_a_period_that_is_not_that_of_the_forcing_is_refused(period):
    with pytest.raises(ArgumentError, match="does not repeat after"):
        find_limit_cycle(lag(period=period))
    with pytest.raises(ArgumentError, match="does not repeat after"):
        floquet(lag(period=2 * np.pi / 1.3), [0.3], period)


def test_forcing_without_a_period_is_refused():
    with pytest.raises(ArgumentError, match="depends on time"):
        find_limit_cycle(lag(), period_guess=4.8)


def test_a_forcing_that_jumps_repeats():
    model = OdeModel(lambda t, x: [np.sign(np.sin(np.pi * t)) - x[0]], ("x",), period=2.0)
    found = find_limit_cycle(model, [0.0])
    assert found.x0 == pytest.approx([-np.tanh(0.5)], abs=1e-8)
    assert found.minimal_period == 2.0


def test_minimal_period_of_a_forced_orbit():
    found = find_limit_cycle(lag(period=6 * np.pi / 1.3))
    assert found.minimal_period == pytest.approx(2 * np.pi / 1.3)
    assert "3 times the minimal one" in str(found)
    once = find_limit_cycle(lag(period=2 * np.pi / 1.3))
    assert once.minimal_period == once.period
    assert once.remarks == ()


def test_minimal_period_of_a_cycle():
    twice = find_limit_cycle(van_der_pol(1), period_guess=13.3)
    assert twice.minimal_period == pytest.approx(6.663286859323, abs=1e-7)
    assert twice.to_xarray().attrs["minimal_period"] == twice.minimal_period


def test_an_orbit_after_period_doubling_does_not_repeat_early():
    # at c = 5 the cycle goes round twice, at different radii
    found = find_limit_cycle(roessler(5), period_guess=11.9, segments=2)
    assert found.minimal_period == found.period


def test_an_orbit_at_rest_has_the_period_of_its_equations():
    found = floquet(mathieu(1, 0.5), [0, 0])
    assert found.minimal_period == found.period
