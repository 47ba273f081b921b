"""The flights of chapter 6: gaits with the tail furled and spread, and what is told of them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from itertools import pairwise

import numpy as np
import xarray as xr
from scipy.optimize import brentq

from birdmb._typing import FloatArray
from birdmb.models import FlightCycle, RigidModel
from birdmb.reproduction.quantities import FLAP_AMPLITUDE, PUBLISHED_WING, bird
from birdmb.reproduction.tail_study import SWEEP_OFFSET, TRIM
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.tail import OPENING
from birdmb.studies.trim import Trim, trim_flight
from birdmb.topology import Bird

Values = Mapping[str, object]

TABLE_6_2 = {
    "a": ((0.0, -10.5, 39.5), (2.3, 1.33, 15.4)),
    "b": ((40.0, -14.5, 42.0), (-5.5, 0.96, 16.7)),
    "c": ((40.0, -13.5, 44.0), (-9.67, 0.96, 17.9)),
}
"""Opening, sweep offset and flap amplitude (degrees); roll offset (degrees), |Lambda|max, W."""

AS_PUBLISHED: Values = {
    **PUBLISHED_WING,
    "tail.incidence_deg": 0.0,
    "tail.downwash": "none",
}
"""The published wing, and the tail along the body without any downwash."""

SHIPPED: Values = {}
"""The tail at two degrees to the body, in the whole wake of the converged wing."""


def flight_of_table_6_2(row: str, values: Values = SHIPPED) -> Trim:
    """A flight of the table, levelled by the roll offset; kept for the figures that share it."""
    return _levelled(row, tuple(sorted(values.items())))


@cache
def _levelled(row: str, values: tuple[tuple[str, object], ...]) -> Trim:
    gait, _ = TABLE_6_2[row]
    return trim_flight(with_gait(*gait, dict(values)), TRIM)


def tail_moment(cycle: FlightCycle) -> FloatArray:
    """Pitching moment (K,) N m of the tail about the centre of mass along the beat, nose up."""
    tail, force = cycle.model.aero.tail, cycle.beat.loads_along.stack.tail_force
    return np.asarray(tail.z * force[:, 0] - tail.x * force[:, 2])


def with_gait(opening: float, sweep: float, amplitude: float, values: Values = SHIPPED) -> Bird:
    """The bird with the tail at an opening, sweep offset and flap amplitude (degrees)."""
    gait = {OPENING: opening, SWEEP_OFFSET: sweep, FLAP_AMPLITUDE: amplitude}
    return bird("ibis_tail").with_values(gait | dict(values))


def stable_opening(one: Bird, model: ModelFactory = RigidModel) -> float:
    """Opening (degrees) at which |Lambda|max of level flight first falls through 1."""

    def growth(opening: float) -> float:
        cycle = trim_flight(one.with_values({OPENING: opening}), TRIM, model=model).cycle
        return float(np.log(np.abs(cycle.multipliers).max()))

    for before, after in pairwise(np.arange(0.0, 46.0, 5.0)):
        if growth(float(after)) < 0:
            return float(brentq(growth, before, after, xtol=1e-5))
    return math.nan


def slow_period(cycle: FlightCycle) -> float:
    """Time (s) that the slowest oscillation among the modes takes by its multiplier."""
    turns = np.angle(cycle.multipliers[cycle.multipliers.imag > 0.0])
    return float(2.0 * math.pi * cycle.period / turns.min())


def peaks_apart(flight: xr.Dataset) -> float:
    """Time (s) between the first two maxima of the forward speed, averaged over a beat."""
    time, u = flight["time"].values, flight["states"].sel(state="u").values
    beat = int(np.searchsorted(time, time[0] + flight.attrs["period"] * (1 - 1e-9)))
    mean = np.convolve(u, np.ones(beat) / beat, mode="valid")
    highest = np.flatnonzero((mean[1:-1] > mean[:-2]) & (mean[1:-1] >= mean[2:])) + 1
    # Ripples of the beat beside a maximum are none of their own.
    apart = highest[np.diff(highest, prepend=-time.size) > 4 * beat]
    return float(time[apart[1]] - time[apart[0]])
