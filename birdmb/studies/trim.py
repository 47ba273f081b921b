"""Trim: parameter values with which a bird flies level, or climbs and travels as wanted."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import least_squares, root_scalar

from birdmb._typing import FloatArray
from birdmb.errors import OrbitError, StateError
from birdmb.models import FlightCycle, RigidModel
from birdmb.orbits import ArgumentError
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.errors import TrimError
from birdmb.studies.trim_search import Trimmed, TrimSearch
from birdmb.topology import Bird

_SECANTS = 10
_STEPS = 25
_GRID = 9
_FIRST_STEP = 0.05  # of the distance between the bounds
_DIFFERENCE = 1e-5  # of the distance between the bounds; cycles are known to about 1e-9


@dataclass(frozen=True)
class Trim:
    """A trimmed flight.

    Attributes:
        bird: the bird with the values found.
        cycle: its limit cycle.
        values: the values found, by dotted name.
        residual: largest difference from a target, m/s.
        cycles: how many limit cycles were computed on the way.
    """

    bird: Bird
    cycle: FlightCycle
    values: dict[str, float]
    residual: float
    cycles: int


def trim_flight(
    bird: Bird,
    parameters: Mapping[str, tuple[float, float]],
    *,
    climb_rate: float = 0.0,
    speed: float | None = None,
    model: ModelFactory = RigidModel,
    tolerance: float = 1e-7,
) -> Trim:
    """Find the value of a parameter that gives a mean climb rate, or of two that also give a speed.

    The search starts from the bird's own values, or from the middle where they are out of bounds.
    One parameter: the secant method and, where that leaves the bounds or fails, Brent's method in
    the sign change nearest to the start on a grid over the bounds. Two: bounded least squares
    (trust region), a local method.

    Args:
        bird: the bird.
        parameters: bounds (lowest, highest) by dotted name; one parameter, or two with `speed`.
        climb_rate: wanted mean climb rate, m/s, upwards positive; 0 is level flight.
        speed: wanted mean speed (`FlightCycle.mean_speed`), m/s.
        model: makes the model of a bird, as `RigidModel` and `MultibodyModel` do.
        tolerance: largest difference from a target, m/s.

    Raises:
        ArgumentError: not as many parameters as targets, or bounds in the wrong order.
        TopologyError: an unknown name, or a bound that is no possible value.
        TrimError: no trim was found within the bounds; it says what was reached.
    """
    targets = {"climb_rate": climb_rate} | ({} if speed is None else {"speed": speed})
    if len(parameters) != len(targets):
        raise ArgumentError(
            f"{len(targets)} target(s) ({', '.join(targets)}) need as many parameters, "
            f"not {len(parameters)}."
        )
    for name, (low, high) in parameters.items():
        if not (np.isfinite([low, high]).all() and low < high):
            raise ArgumentError(f"the bounds of {name} must be ascending, not {low} and {high}.")
    search = TrimSearch(bird, parameters, targets, model, tolerance)
    with suppress(Trimmed):
        if speed is None:
            _solve_one(search)
        else:
            _solve_two(search)
    return _result(search)


class _OutsideError(Exception):
    """The secant method left the bounds."""


def _solve_one(search: TrimSearch) -> None:
    low, high, start = float(search.low[0]), float(search.high[0]), float(search.start[0])

    def difference(value: float) -> float:
        if not low <= value <= high:
            raise _OutsideError
        return float(search.differences(np.array([value]))[0])

    step = _FIRST_STEP * (high - low) * (1 if start < 0.5 * (low + high) else -1)
    with suppress(_OutsideError, OrbitError, StateError):
        if difference(start) != difference(start + step):
            root_scalar(difference, method="secant", x0=start, x1=start + step, maxiter=_SECANTS)
    points: list[tuple[float, float]] = []
    for value in np.linspace(low, high, _GRID):
        with suppress(OrbitError, StateError):
            points.append((float(value), difference(float(value))))
    changes = [(a, b) for (a, at_a), (b, at_b) in pairwise(points) if at_a * at_b < 0]
    if changes:
        nearest = min(changes, key=lambda ends: min(abs(end - start) for end in ends))
        with suppress(OrbitError, StateError):
            root_scalar(difference, method="brentq", bracket=nearest)


def _solve_two(search: TrimSearch) -> None:
    width = search.high - search.low

    def differences(share: FloatArray) -> FloatArray:
        """Differences at shares of the way between the bounds; where there is no cycle, NaN.

        The trust region then shrinks.
        """
        try:
            return search.differences(search.low + share * width)
        except (OrbitError, StateError):
            return np.full(share.size, np.nan)

    def jacobian(share: FloatArray) -> FloatArray:
        steps = np.diag(np.where(share < 0.5, _DIFFERENCE, -_DIFFERENCE))
        here = differences(share)
        return np.column_stack([(differences(share + h) - here) / h.sum() for h in steps])

    start = (search.start - search.low) / width
    if np.isfinite(differences(start)).all():
        with suppress(ValueError, np.linalg.LinAlgError):  # no cycle beside the point reached
            least_squares(differences, start, jac=jacobian, bounds=(0.0, 1.0), max_nfev=_STEPS)


def _result(search: TrimSearch) -> Trim:
    best = search.best
    if best is None:
        raise TrimError(search.nothing_found(), {}, {})
    values = search.named(best.point)
    if not search.is_trimmed(best):
        raise TrimError(search.not_trimmed(best), values, best.reached)
    residual = float(np.abs(best.differences).max())
    return Trim(search.bird.with_values(values), best.cycle, values, residual, len(search.found))
