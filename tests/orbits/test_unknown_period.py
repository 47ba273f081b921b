from dataclasses import replace

import numpy as np
import pytest
from orbit_systems import ROESSLER, roessler, stuart_landau, van_der_pol

from birdmb.orbits import EquilibriumError, OdeModel, find_limit_cycle


@pytest.mark.parametrize("segments", [None, 1, 4])
@pytest.mark.parametrize("damping", ["line-search", "levenberg-marquardt"])
def test_van_der_pol(segments, damping):
    cycle = find_limit_cycle(van_der_pol(1), period_guess=6.5, segments=segments, damping=damping)
    assert cycle.period == pytest.approx(6.663286859323, abs=1e-8)
    assert cycle.multipliers == pytest.approx([1, 8.59695e-4], abs=2e-8)
    assert cycle.trivial_index == 0
    assert cycle.stability == "stable"


def test_a_trivial_multiplier_far_outside_its_bar_leaves_the_verdict_open():
    cycle = find_limit_cycle(van_der_pol(1), period_guess=6.5)
    off = replace(cycle, multipliers=cycle.multipliers + np.array([1e-4, 0.0]))
    assert (cycle.stability, off.stability) == ("stable", "undecided")
    assert "trivial multiplier is off 1 by 1.0e-04" in off.remarks[0]


@pytest.mark.parametrize("options", [{"method": "collocation"}, {"segments": 10}])
def test_stiffer_van_der_pol(options):
    cycle = find_limit_cycle(van_der_pol(3), period_guess=8.8, **options)
    assert cycle.period == pytest.approx(8.859095499720, abs=1e-8)
    assert cycle.liouville_defect() < 1e-8
    assert cycle.multipliers[1] == pytest.approx(6.99e-16, rel=1e-3)


def test_a_flow_alone_is_enough():
    class FlowOnly:
        state_names = ("x", "v")
        period = None

        def __init__(self):
            self._model = van_der_pol(1)

        def flow(self, x0, t0, t1):
            return self._model.flow(x0, t0, t1)

    cycle = find_limit_cycle(FlowOnly(), [2.0, 0.0], period_guess=6.5, segments=2)
    assert cycle.jacobian_method == "finite-differences"
    assert cycle.period == pytest.approx(6.663286859323, abs=1e-8)
    errors = np.abs(cycle.multipliers - [1, 8.596950636e-4])
    assert (errors < cycle.multiplier_errors).all()
    assert (cycle.multiplier_errors < 1e-3).all()


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_errors_cover_an_orbit_that_is_not_quite_closed(tolerance):
    model = roessler(3.5)
    exact = find_limit_cycle(model, [0.0, -4.6, 0.05], period_guess=5.9)
    near = exact.x0 + tolerance / 3
    rough = find_limit_cycle(model, near, period_guess=5.92, tolerance=tolerance, segments=1)
    errors = np.abs(rough.multipliers - exact.multipliers)[:2]
    assert (errors < rough.multiplier_errors[:2]).all()
    assert (rough.multiplier_errors[:2] < 1e3 * errors).all()


def test_segments_tame_an_orbit_that_runs_away():
    # radius grows from the unstable cycle r = 1 as r' = 3 r (r**2 - 1): infinite within a period
    def rhs(_t, x):
        growth = 3 * (x @ x - 1)
        return [growth * x[0] - x[1], growth * x[1] + x[0]]

    cycle = find_limit_cycle(OdeModel(rhs, ("x", "y")), ring(16), period_guess=6.2, segments=16)
    assert cycle.period == pytest.approx(2 * np.pi, abs=1e-8)
    assert np.log(cycle.multipliers[0].real) == pytest.approx(12 * np.pi, abs=1e-7)
    assert cycle.multipliers[1] == pytest.approx(1, abs=1e-7)
    assert cycle.stability == "unstable"
    assert np.hypot(*cycle.trajectory().states.T) == pytest.approx(1, abs=1e-6)


def ring(count):
    angle = 2 * np.pi * np.arange(count) / count
    return 1.02 * np.column_stack([np.cos(angle), np.sin(angle)])


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


@pytest.mark.parametrize("damping", ["line-search", "levenberg-marquardt"])
def test_an_equilibrium_is_not_a_cycle(damping):
    with pytest.raises(EquilibriumError, match="ended on an equilibrium") as caught:
        find_limit_cycle(van_der_pol(1), [0.01, 0.0], period_guess=6.3, damping=damping)
    assert np.abs(caught.value.best_x).max() < 1e-5


def test_a_cycle_that_does_not_exist_ends_on_the_equilibrium():
    with pytest.raises(EquilibriumError):
        find_limit_cycle(stuart_landau(-0.2), [0.3, 0.0], period_guess=3.0)
