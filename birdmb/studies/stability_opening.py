"""The opening of the tail at which level flight becomes stable, traced as a curve."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from birdmb.arguments import checked
from birdmb.errors import ArgumentError, BirdmbError
from birdmb.models import RigidModel
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.tail import ACCURACY, OPENING
from birdmb.studies.trim import Trim, TrimGuess, trim_flight
from birdmb.studies.trim_defaults import default_parameters
from birdmb.studies.zero_curve import ZeroCurve, trace_zero
from birdmb.summary import Summarised
from birdmb.topology import Bird

_OPENING_STEP = 2.5


@dataclass(frozen=True, repr=False)
class StabilityOpening(Summarised):
    """Where |Lambda|max = 1 on level flights, over a parameter of the gait and the opening.

    Attributes:
        across: dotted name of the parameter.
        at: dotted name of another one, empty where there is none.
        value: its value.
        curves: their points are (parameter, opening in degrees); none where stability does not
            change within the ranges, or only across openings without level flight.
    """

    across: str
    at: str
    value: float
    curves: tuple[ZeroCurve, ...]


@checked
def stability_openings(
    bird: Bird,
    across: Mapping[str, tuple[float, float]],
    at: Mapping[str, Sequence[float]] | None = None,
    *,
    openings: tuple[float, float] = (0.0, 45.0),
    trim: Mapping[str, tuple[float, float]] | None = None,
    seeds: int = 5,
    model: ModelFactory = RigidModel,
) -> tuple[StabilityOpening, ...]:
    """Trace the opening of the tail at which level flight becomes stable.

    On lines of a constant value of the parameter the opening is raised in steps of 2.5 degrees
    until |Lambda|max passes 1 from one level flight to the next; from there the curve is followed
    by continuation, each of its points to 1e-6 of the ranges.

    Args:
        bird: a bird with a tail.
        across: range (lowest, highest) of one parameter by its dotted name.
        at: values of another one by its dotted name, each with curves of its own.
        openings: range, degrees.
        trim: bounds by dotted name of what levels the flight; as for `tail_study`.
        seeds: how many values of the parameter are tried for curves that were not met yet.
        model: makes the model of a bird.

    Raises:
        TopologyError: the bird has no value of a name.
        ArgumentError: not one name in `across`, or more than one in `at`.
    """
    if len(across) != 1 or len(at or {}) > 1:
        raise ArgumentError("curves are over one parameter, at values of at most one other.")
    ((name, ends),) = across.items()
    ((other, values),) = (at or {"": [np.nan]}).items()
    bounds = trim or default_parameters(bird, 1)
    found = []
    for value in values:
        one = bird.with_values({other: float(value)}) if other else bird
        flights = _LevelFlights(one, name, bounds, model)
        curves: list[ZeroCurve] = []
        for seed in np.linspace(*ends, seeds + 2)[1:-1]:
            opening = flights.crossing(float(seed), openings)
            if opening is None or any(_passes(curve, seed, opening) for curve in curves):
                continue
            start = (float(seed), opening)
            curves.append(trace_zero(flights.growth, start, (ends, openings), tolerance=1e-6))
        found.append(StabilityOpening(name, other, float(value), tuple(curves)))
    return tuple(found)


def _passes(curve: ZeroCurve, value: float, opening: float) -> bool:
    there = np.interp(value, *curve.points[np.argsort(curve.points[:, 0])].T)
    return bool(abs(there - opening) < 1.0)


class _LevelFlights:
    """Growth of disturbances of level flights, each found from the one before it."""

    def __init__(
        self,
        bird: Bird,
        name: str,
        bounds: Mapping[str, tuple[float, float]],
        model: ModelFactory,
    ) -> None:
        self._bird, self._name, self._bounds, self._model = bird, name, bounds, model
        self._last: TrimGuess | None = None

    def growth(self, value: float, opening: float) -> float:
        """ln |Lambda|max of level flight; raises `TrimError` where there is none."""
        middle = {name: 0.5 * (low + high) for name, (low, high) in self._bounds.items()}
        trim: Trim = trim_flight(
            self._bird.with_values({self._name: value, OPENING: opening}),
            self._bounds,
            model=self._model,
            tolerance=1e-6,
            guess=self._last or TrimGuess(middle),
            search={"accuracy": ACCURACY},
        )
        self._last = TrimGuess(trim.values, trim.cycle)
        return float(np.log(np.abs(trim.cycle.multipliers).max()))

    def crossing(self, value: float, openings: tuple[float, float]) -> float | None:
        """The opening at which stability first changes; `None` where it does not."""
        self._last = None
        before = None
        for opening in np.arange(openings[0], openings[1] + 1e-9, _OPENING_STEP):
            try:
                growth = self.growth(value, float(opening))
            except BirdmbError:
                before = None
                continue
            if before is not None and before * growth < 0:
                ends = (float(opening) - _OPENING_STEP, float(opening))
                return float(brentq(lambda x: self.growth(value, x), *ends, xtol=1e-5))
            before = growth
        return None
