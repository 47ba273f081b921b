"""The systems and models of the thesis against what is known of them."""

import numpy as np
import pytest

import birdmb
from birdmb.orbits import find_limit_cycle
from birdmb.reproduction.chapter4 import AMPLITUDE, PERIOD, RELAXATION, poincare_oscillator
from birdmb.reproduction.stopped_circulation import StoppedCirculation


def test_the_poincare_oscillators_multiplier_is_exact():
    cycle = find_limit_cycle(poincare_oscillator(), period_guess=6.0)
    assert cycle.period == pytest.approx(PERIOD, abs=1e-8)
    others = np.delete(cycle.multipliers, cycle.trivial_index)
    assert others == pytest.approx(np.exp(-RELAXATION * AMPLITUDE * PERIOD), abs=1e-8)


def test_a_circulation_that_is_not_stopped_is_the_exact_one(ibis_published):
    """Up to the fifty steps after which it is stopped anyway: 0.9 to the power 50 is 0.5 %."""
    x = np.array([18.0, -2.0, -0.1, -0.1])
    times, states = np.array([0.0, 0.1]), np.stack([x, x])
    exact = birdmb.RigidModel(ibis_published).rates(times, states)
    gaps = []
    for stop_at in (1e-1, 1e-2, 1e-3, 1e-9):
        stopped = StoppedCirculation(ibis_published, stop_at=stop_at).rates(times, states)
        gaps.append(np.abs(stopped - exact).max())
    assert gaps == sorted(gaps, reverse=True)
    assert gaps[-1] < 5e-3 * np.abs(exact).max()


def test_stopped_as_in_the_published_program_it_levels_at_its_amplitude(ibis_published):
    """The program, run again, flies level at 43.55 degrees, the exact circulation at 43.32."""
    level = ibis_published.with_values({"shoulder.flap.amplitude_deg": 43.55})
    climbs = {
        model: find_limit_cycle(model).mean_climb_rate
        for model in (StoppedCirculation(level, stop_at=1e-3), birdmb.RigidModel(level))
    }
    stopped, exact = climbs.values()
    assert abs(stopped) < 1e-3
    assert exact > 0.01
