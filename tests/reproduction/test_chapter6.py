"""The flights and the study of chapter 6."""

import numpy as np
import pytest
import xarray as xr

from birdmb.reproduction import tail_study as study
from birdmb.reproduction.chapter6_flights import (
    AS_PUBLISHED,
    flight_of_table_6_2,
    peaks_apart,
    slow_period,
    tail_moment,
)
from birdmb.studies.tail import OPENING


def test_the_study_covers_the_ranges_of_the_thesis():
    assert [len(values) for values in study.RANGES.values()] == [13, 33, 46]
    assert np.prod([len(values) for values in study.RANGES.values()]) == 19734
    ends = {name: sorted((values[0], values[-1])) for name, values in study.RANGES.items()}
    assert ends == {
        "shoulder.sweep.offset_deg": [-15, -9],
        "shoulder.flap.amplitude_deg": [29, 45],
        OPENING: [0, 45],
    }


def test_the_tail_balances_the_wing():
    """The body's drag acts at the centre of mass, and a beat's mean moment is nil."""
    cycle = flight_of_table_6_2("b", AS_PUBLISHED).cycle
    of_tail = tail_moment(cycle)
    wing = cycle.beat.loads_along.stack.right
    arms = np.cross(wing.position, wing.force)[..., 1] + wing.moment[..., 1]
    total = of_tail + 2.0 * arms.sum(axis=1)
    np.testing.assert_allclose(total, cycle.beat.moment[:, 1], atol=1e-12)
    # The published wing has kinks, to which the orbit is known no better.
    assert abs(total[:-1].mean()) < 1e-4
    # As in figure 6.3, the tail lifts the nose in (b).
    assert of_tail[:-1].mean() == pytest.approx(0.067, abs=5e-4)
    slow = cycle.multipliers[0]
    turns = abs(np.angle(slow)) / (2.0 * np.pi)
    assert slow_period(cycle) == pytest.approx(cycle.period / turns)


def test_peaks_are_those_of_the_mean_over_a_beat():
    """A slow oscillation of 3 s with the beat's own ripple on it."""
    period, samples = 0.25, 60
    time = period * np.arange(30 * samples + 1) / samples
    u = 14.0 + np.sin(2 * np.pi * time / 3.0) + 0.4 * np.sin(2 * np.pi * time / period)
    data = xr.Dataset(
        {"states": (("time", "state"), u[:, None])},
        coords={"time": time, "state": ["u"]},
        attrs={"period": period},
    )
    assert peaks_apart(data) == pytest.approx(3.0, abs=period / samples)
