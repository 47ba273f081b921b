"""Trim: parameter values with which a bird flies level, or climbs and travels as wanted."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares, root_scalar

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError, OrbitError, StateError
from birdmb.models import FlightCycle, RigidModel
from birdmb.orbits import FloquetResult
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.errors import TrimError
from birdmb.studies.trim_defaults import default_parameters
from birdmb.studies.trim_search import TrimSearch
from birdmb.summary import Fact, Summarised
from birdmb.topology import Bird

_STEPS = 25
_GRID = 9
_DIFFERENCE = 1e-5  # of the distance between the bounds; cycles are known to about 1e-9


@dataclass(frozen=True, repr=False)
class Trim(Summarised):
    """A trimmed flight.

    Attributes:
        bird: the bird with the values found.
        cycle: its limit cycle.
        values: the values found, by dotted name.
        residual: largest difference from a target, m/s.
        cycles: how many limit cycles were computed on the way.
        from_guess: whether the search succeeded from the guess that it was given.
    """

    bird: Bird
    cycle: FlightCycle
    values: dict[str, float]
    residual: float
    cycles: int
    from_guess: bool

    def _title(self) -> str:
        return self.bird.name

    def _summary(self) -> Iterator[Fact]:
        for name, value in self.values.items():
            yield Fact(name, f"{value:.6g}")
        yield Fact("residual", f"{self.residual:.1e}", "m/s")
        yield from self.cycle._summary()


@checked
@dataclass(frozen=True, repr=False)
class TrimGuess(Summarised):
    """A trimmed flight of a similar bird, to start from.

    Attributes:
        values: of the parameters, by dotted name.
        orbit: the limit cycle, states (K, n) at K even instants of its beat, or its state (n,) at
            t = 0; level forward flight if it is not known.
    """

    values: Mapping[str, float]
    orbit: npt.ArrayLike | FloquetResult | None = None


@checked
def trim_flight(
    bird: Bird,
    parameters: Mapping[str, tuple[float, float]] | None = None,
    *,
    climb_rate: float = 0.0,
    speed: float | None = None,
    model: ModelFactory = RigidModel,
    tolerance: float = 1e-7,
    guess: TrimGuess | None = None,
    search: Mapping[str, Any] | None = None,
) -> Trim:
    """Find the value of a parameter that gives a mean climb rate, or of two that also give a speed.

    Newton's method on orbit and targets as one system, by collocation (`CollocatedTrim`) or, where
    the orbit is not smooth, by shooting (`TrimEquations`), at the bird's own values of the
    parameters, or in the middle of the bounds where they are beyond these. It starts from the
    guess if there is one, from a body in level forward flight, and from the limit cycle at the
    start. Where all this fails without a guess: for one parameter Brent's method in the sign change
    nearest to the start on a grid over the bounds, for two bounded least squares. A bird that
    stands up steeply (30 degrees) is taken for trimmed only if nothing else is found.

    Args:
        bird: the bird.
        parameters: bounds (lowest, highest) by dotted name; one parameter, or two with `speed`. By
            default the offset of the joint that turns the chords (forearm.roll of the ibis), and
            the amplitude of the one that flaps, or its gain where it has no amplitude.
        climb_rate: wanted mean climb rate, m/s, upwards positive; 0 is level flight.
        speed: wanted mean speed (`FlightCycle.mean_speed`), m/s.
        model: makes the model of a bird, as `RigidModel` and `MultibodyModel` do.
        tolerance: largest difference from a target, m/s.
        guess: a flight to start from, as that of a neighbour in a study.
        search: what else `find_limit_cycle` takes for each of the cycles.

    Raises:
        ArgumentError: not as many parameters as targets, bounds in the wrong order, or no
            parameters given for a bird that has none by default.
        TopologyError: an unknown name, or a bound that is no possible value.
        TrimError: no trim was found within the bounds; it says what was reached.
    """
    targets = {"climb_rate": climb_rate} | ({} if speed is None else {"speed": speed})
    if parameters is None:
        parameters = default_parameters(bird, len(targets))
    if len(parameters) != len(targets):
        raise ArgumentError(
            f"{len(targets)} target(s) ({', '.join(targets)}) need as many parameters, "
            f"not {len(parameters)}."
        )
    for name, (low, high) in parameters.items():
        if not (np.isfinite([low, high]).all() and low < high):
            raise ArgumentError(f"the bounds of {name} must be ascending, not {low} and {high}.")
    trials = TrimSearch(bird, parameters, targets, model, tolerance, search or {})
    from_guess = _from_guess(trials, guess)
    # Who gives a guess has others to fall back on, and waits for none of the slow ways.
    ways = (_from_level_flight, _from_own_cycle, _solve_one if speed is None else _solve_two)
    for way in ways if guess is None else ways[:1]:
        if not trials.succeeded:
            way(trials)
    return _result(trials, from_guess)


def _from_guess(search: TrimSearch, guess: TrimGuess | None) -> bool:
    """Whether the search succeeds from a guess."""
    if guess is None:
        return False
    point = np.array([guess.values[name] for name in search.names])
    _solve_together(search, point, guess.orbit)
    return search.succeeded


def _from_level_flight(search: TrimSearch) -> None:
    _solve_together(search, search.start, None)


def _from_own_cycle(search: TrimSearch) -> None:
    """From the limit cycle with the bird's own parameters."""
    with suppress(OrbitError, StateError):
        orbit = search.orbit_at(search.start)
        if not search.succeeded:
            _solve_together(search, search.start, orbit)


def _solve_together(
    search: TrimSearch, point: FloatArray, guess: npt.ArrayLike | FloquetResult | None
) -> None:
    """Newton's method from these parameters and this orbit.

    Where it fails there are other places to start from.
    """
    try:
        search.solve_together(point, guess)
    except (OrbitError, StateError) as error:
        search.failed_together(error)


def _solve_one(search: TrimSearch) -> None:
    low, high, start = float(search.low[0]), float(search.high[0]), float(search.start[0])

    def difference(value: float) -> float:
        return float(search.differences(np.array([value]))[0])

    points: list[tuple[float, float]] = []
    for value in np.linspace(low, high, _GRID):
        with suppress(OrbitError, StateError):
            points.append((float(value), difference(float(value))))
        if search.succeeded:
            return
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


def _result(search: TrimSearch, from_guess: bool) -> Trim:
    best = search.best
    if best is None:
        raise TrimError(search.nothing_found(), {}, {})
    values = search.named(best.point)
    if not search.is_trimmed(best):
        raise TrimError(search.not_trimmed(best), values, best.reached)
    residual = float(np.abs(best.differences).max())
    bird = best.cycle.model.bird
    return Trim(bird, best.cycle, values, residual, len(search.found), from_guess)
