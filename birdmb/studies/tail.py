"""What stability costs: level flights over tail opening and gait (thesis, chapter 6)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from os import PathLike

import numpy as np
import xarray as xr
from scipy.optimize import brentq

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError, BirdmbError
from birdmb.models import RigidModel
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.sweeps import Finished, Study, Trimming, sweep
from birdmb.studies.trim import Trim, TrimGuess, trim_flight
from birdmb.studies.zero_curve import ZeroCurve, trace_zero
from birdmb.topology import Bird

OPENING = "tail.opening_deg"
AMPLITUDE = "shoulder.flap.amplitude_deg"
SWEEP = "shoulder.sweep.offset_deg"
ROLL = "forearm.roll.offset_deg"

LARGEST_ROLL = 12.0
LARGEST_PITCH = 6.0
# Wider than the rule, so that it is told from flights that do not exist.
_ROLL_BOUNDS = (-30.0, 30.0)
# Of the states, in units of their scale: the multipliers are then known to some 1e-7.
_ACCURACY = 3e-5
# Of orbit and climb rate (m/s): no closer than the nodes leave them.
_CLOSURE, _LEVEL = 1e-6, 1e-5
_OPENING_STEP = 2.5


def tail_study(
    bird: Bird,
    store: str | PathLike[str],
    *,
    every: int = 1,
    workers: int | None = None,
    executor: Executor | None = None,
    model: ModelFactory = RigidModel,
    on_point: Callable[[Finished], None] | None = None,
) -> Study:
    """Level the flight by the roll of the forearm for all openings of the tail and gaits.

    Openings 0 to 45 degrees in steps of 1, flap amplitudes 45 to 29 and offsets of the shoulder's
    sweep -15 to -9 degrees in steps of 0.5: 19 734 flights. A store that was begun is filled up.

    Args:
        bird: a bird with a tail, and the joints of the ibis.
        store: file that keeps the study.
        every: take only one of so many values; 5 makes a coarse study of 210 flights.
        workers, executor, on_point: as for `sweep`.
        model: makes the model of a bird.

    Raises:
        TopologyError: the bird has no tail, or none of the joints.
        SweepError: as for `sweep`.
        ArgumentError: `every` is not positive.
    """
    if every < 1:
        raise ArgumentError(f"every must be 1 or more, not {every}.")
    return sweep(
        bird,
        {
            SWEEP: np.arange(-15.0, -8.9, 0.5 * every).tolist(),
            AMPLITUDE: np.arange(45.0, 28.9, -0.5 * every).tolist(),
            OPENING: np.arange(0.0, 45.1, 1.0 * every).tolist(),
        },
        store=store,
        workers=workers,
        executor=executor,
        model=model,
        trim=Trimming({ROLL: _ROLL_BOUNDS}, tolerance=_LEVEL),
        tolerance=_CLOSURE,
        accuracy=_ACCURACY,
        on_point=on_point,
    )


def within_rules(data: xr.Dataset) -> xr.DataArray:
    """Which flights of a study are not excluded: mean pitch and roll offset as in the thesis.

    No more than 6 degrees of mean pitch and 12 of roll offset, either way.
    """
    flat = abs(data["mean_pitch"]) <= np.radians(LARGEST_PITCH)
    return flat & (abs(data[ROLL]) <= LARGEST_ROLL)


def pareto_front(cost: FloatArray, modulus: FloatArray) -> FloatArray:
    """Positions of the flights that none beats in both cost and |Lambda|max, by rising cost.

    Both (K,); flights with NaN are none.
    """
    known = np.flatnonzero(np.isfinite(cost) & np.isfinite(modulus))
    order = known[np.lexsort((modulus[known], cost[known]))]
    best = np.minimum.accumulate(modulus[order])
    before = np.concatenate([[np.inf], best[:-1]])[: order.size]
    return np.asarray(order[modulus[order] < before])


@dataclass(frozen=True)
class PriceOfStability:
    """The cheapest flights in a range of speed: of all, and of the stable ones.

    Attributes:
        slowest, fastest: the range, m/s.
        cheapest: least cost of transport within the rules.
        cheapest_stable: the same of those whose verdict is stable; NaN if there are none.
        opening: of the tail at the cheapest stable flight, degrees.
    """

    slowest: float
    fastest: float
    cheapest: float
    cheapest_stable: float
    opening: float


def price_of_stability(data: xr.Dataset, width: float = 1.0) -> tuple[PriceOfStability, ...]:
    """Compare the cheapest flights of a study with the cheapest stable ones, speed by speed.

    `width` (m/s) is that of the ranges of speed.
    """
    kept = data.where(within_rules(data))
    cost, speed = kept["cost_of_transport"], kept["mean_speed"].values.ravel()
    openings = data[OPENING].broadcast_like(cost).transpose(*cost.dims).values.ravel()
    costs = cost.values.ravel()
    stable = (kept["stability"] == "stable").values.ravel()
    rows = []
    for place in np.unique(np.floor(speed[np.isfinite(speed)] / width)):
        here = np.floor(speed / width) == place
        steady = np.flatnonzero(here & stable)
        best = steady[np.argmin(costs[steady])] if steady.size else None
        rows.append(
            PriceOfStability(
                slowest=float(place * width),
                fastest=float((place + 1) * width),
                cheapest=float(costs[here].min()),
                cheapest_stable=np.nan if best is None else float(costs[best]),
                opening=np.nan if best is None else float(openings[best]),
            )
        )
    return tuple(rows)


@dataclass(frozen=True)
class StabilityOpening:
    """Where |Lambda|max = 1 on level flights, over flap amplitude and opening, at one sweep offset.

    Attributes:
        sweep: offset of the shoulder's sweep, degrees.
        curves: their points are (flap amplitude, opening), in degrees; none where stability does
            not change within the ranges, or only across openings without level flight.
    """

    sweep: float
    curves: tuple[ZeroCurve, ...]


def stability_openings(
    bird: Bird,
    sweeps: Sequence[float],
    *,
    amplitudes: tuple[float, float] = (29.0, 45.0),
    openings: tuple[float, float] = (0.0, 45.0),
    seeds: int = 5,
    model: ModelFactory = RigidModel,
) -> tuple[StabilityOpening, ...]:
    """Trace the opening of the tail at which level flight becomes stable, for offsets of the sweep.

    On lines of constant amplitude the opening is raised in steps of 2.5 degrees until |Lambda|max
    passes 1 from one level flight to the next; from there the curve is followed by continuation,
    each of its points to 1e-6 of the ranges.

    Args:
        bird: a bird with a tail, and the joints of the ibis.
        sweeps: offsets of the shoulder's sweep, degrees.
        amplitudes, openings: ranges, degrees.
        seeds: how many amplitudes are tried for curves that were not met yet.
        model: makes the model of a bird.
    """
    found = []
    for sweep_offset in sweeps:
        flights = _LevelFlights(bird.with_values({SWEEP: float(sweep_offset)}), model)
        curves: list[ZeroCurve] = []
        for amplitude in np.linspace(*amplitudes, seeds + 2)[1:-1]:
            opening = flights.crossing(float(amplitude), openings)
            if opening is None or any(_passes(curve, amplitude, opening) for curve in curves):
                continue
            start = (float(amplitude), opening)
            curves.append(trace_zero(flights.growth, start, (amplitudes, openings), tolerance=1e-6))
        found.append(StabilityOpening(float(sweep_offset), tuple(curves)))
    return tuple(found)


def _passes(curve: ZeroCurve, amplitude: float, opening: float) -> bool:
    there = np.interp(amplitude, *curve.points[np.argsort(curve.points[:, 0])].T)
    return bool(abs(there - opening) < 1.0)


class _LevelFlights:
    """Growth of disturbances of level flights, each found from the one before it."""

    def __init__(self, bird: Bird, model: ModelFactory) -> None:
        self._bird, self._model = bird, model
        self._last: TrimGuess | None = None

    def growth(self, amplitude: float, opening: float) -> float:
        """ln |Lambda|max of level flight; raises `TrimError` where there is none."""
        trim: Trim = trim_flight(
            self._bird.with_values({AMPLITUDE: amplitude, OPENING: opening}),
            {ROLL: _ROLL_BOUNDS},
            model=self._model,
            tolerance=1e-6,
            guess=self._last or TrimGuess({ROLL: 0.0}),
            search={"accuracy": _ACCURACY},
        )
        self._last = TrimGuess(trim.values, trim.cycle)
        return float(np.log(np.abs(trim.cycle.multipliers).max()))

    def crossing(self, amplitude: float, openings: tuple[float, float]) -> float | None:
        """The opening at which stability first changes; `None` where it does not."""
        self._last = None
        before = None
        for opening in np.arange(openings[0], openings[1] + 1e-9, _OPENING_STEP):
            try:
                growth = self.growth(amplitude, float(opening))
            except BirdmbError:
                before = None
                continue
            if before is not None and before * growth < 0:
                ends = (float(opening) - _OPENING_STEP, float(opening))
                return float(brentq(lambda x: self.growth(amplitude, x), *ends, xtol=1e-5))
            before = growth
        return None
