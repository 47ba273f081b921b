"""Finding the periodic orbits that coexist in one system, from many starts and by deflation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypedDict, Unpack, overload

import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError, OrbitError, StateError
from birdmb.orbits.coarse import CoarseOrbit, CoarseSearch
from birdmb.orbits.collocation_search import search_by_collocation
from birdmb.orbits.cycle import LimitCycle
from birdmb.orbits.errors import NotSmoothError, require_tolerance
from birdmb.orbits.problem import HasRates, HasRhs, HasStartingPaths, Model, ModelWithCycles
from birdmb.orbits.result import FloquetResult
from birdmb.orbits.sameness import among
from birdmb.orbits.search import (
    ACCURACY,
    NEAR,
    TOLERANCE,
    CycleT,
    SearchMethod,
    find_limit_cycle,
    most_nodes,
)
from birdmb.orbits.shooting_search import period_or_guess
from birdmb.threads import one_thread

Guess = npt.ArrayLike | FloquetResult


@dataclass(frozen=True)
class Attempt:
    """How far a search for coexisting orbits has come.

    Attributes:
        stage: "starts" (from each start), "deflation" (away from what is known) or "refinement"
            (each orbit on enough nodes, with its multipliers).
        done: attempts finished in this stage.
        of: attempts in this stage, at most.
        found: distinct orbits found so far.
    """

    stage: Literal["starts", "deflation", "refinement"]
    done: int
    of: int
    found: int


class CoexistingOptions(TypedDict, total=False):
    """What `find_limit_cycles` takes besides model and starts."""

    method: SearchMethod
    period_guess: float | Sequence[float] | None
    start_time: float
    known: Sequence[LimitCycle]
    tolerance: float
    accuracy: float
    max_iterations: int
    deflations: int
    key: Callable[[LimitCycle], Any] | None
    callback: Callable[[Attempt], None] | None


@overload
def find_limit_cycles(
    model: ModelWithCycles[CycleT],
    starts: Sequence[Guess] | None = ...,
    **options: Unpack[CoexistingOptions],
) -> list[CycleT]: ...


@overload
def find_limit_cycles(
    model: Model,
    starts: Sequence[Guess] | None = ...,
    **options: Unpack[CoexistingOptions],
) -> list[LimitCycle]: ...


@checked
@one_thread()
def find_limit_cycles(
    model: Model,
    starts: Sequence[Guess] | None = None,
    *,
    method: SearchMethod = "auto",
    period_guess: float | Sequence[float] | None = None,
    start_time: float = 0.0,
    known: Sequence[LimitCycle] = (),
    tolerance: float = TOLERANCE,
    accuracy: float = ACCURACY,
    max_iterations: int = 25,
    deflations: int = 12,
    key: Callable[[LimitCycle], Any] | None = None,
    callback: Callable[[Attempt], None] | None = None,
) -> list[Any]:
    """Find the distinct periodic orbits that many starts lead to, with their multipliers.

    From each start Fourier collocation on few nodes; then from some of the starts again, deflated
    by all that is found, which leads to orbits that no start leads to. Each distinct orbit is then
    refined by `find_limit_cycle`. The same orbit begun elsewhere (of an autonomous system), gone
    round several times, or a whole period of its states away (an angle) counts once. Nothing
    proves that there are no others. A model without a right-hand side is shot from each start,
    without deflation.

    Args:
        model: anything that satisfies `birdmb.orbits.Model`.
        starts: guesses as `find_limit_cycle` takes them: states (n,) at `start_time`, states
            (K, n) at K even instants of the period, or orbits. By default those that the model
            offers (`starting_paths`), else its guess.
        method: as for `find_limit_cycle`; "shooting" takes no deflation.
        period_guess: of an autonomous system, in s: one for all starts, or one for each. An orbit
            given as start brings its own.
        start_time: time of the first state, in s.
        known: orbits that are not to be found again.
        tolerance: of the refined orbits, as for `find_limit_cycle`.
        accuracy: of the refined orbits, as for `find_limit_cycle`.
        max_iterations: accepted steps allowed from each start.
        deflations: deflated searches at most; 0 for none.
        key: sorts the orbits; by default their `sort_key`.
        callback: called with every `Attempt` as it is finished.

    Returns:
        The orbits, sorted; none if no start leads to one.

    Raises:
        ArgumentError: a start of the wrong shape or not finite, a number out of range, or a missing
            or superfluous period guess.
        StateError: the right-hand side fails at every start.

    Source: Farrell, Birkisson & Funke (2015) for the deflation.
    """
    require_tolerance("tolerance", tolerance)
    require_tolerance("accuracy", accuracy)
    if max_iterations < 1 or deflations < 0:
        raise ArgumentError("max_iterations must be at least 1, and deflations at least 0.")
    guesses = None if starts is None else list(starts)
    if guesses is not None and not guesses:
        raise ArgumentError("starts is empty; give at least one, or None for the model's own.")
    options: dict[str, Any] = {
        "start_time": start_time,
        "tolerance": tolerance,
        "max_iterations": max_iterations,
    }

    def told(stage: Literal["starts", "deflation", "refinement"], *numbers: int) -> None:
        if callback is not None:
            callback(Attempt(stage, *numbers))

    periods = _periods(model, guesses, period_guess)
    if method == "shooting" or not isinstance(model, HasRates | HasRhs):
        found = _shot(model, guesses, periods, known, options, told)
    else:
        search = CoarseSearch(model, start_time, periods[0], max_iterations, list(known))
        coarse = search.run(_paths(model, guesses, search), periods, deflations, told)
        options |= {"method": method, "accuracy": accuracy}
        found = _refined(model, coarse, known, options, told)
    return sorted(found, key=key if key is not None else lambda cycle: cycle.sort_key)


def _paths(model: Model, guesses: list[Guess] | None, search: CoarseSearch) -> list[Guess | None]:
    if guesses is not None:
        return list(guesses)
    if isinstance(model, HasStartingPaths):
        return list(model.starting_paths(search.times))
    return [None]


def _periods(
    model: Model, guesses: list[Guess] | None, period_guess: float | Sequence[float] | None
) -> list[float]:
    """Period, or the guess of it, of each start; a single one where all have the same."""
    count = 1 if guesses is None else len(guesses)
    if period_guess is None or isinstance(period_guess, float | int):
        each: list[float | None] = [period_guess] * count
    else:
        each = list(period_guess)
        if len(each) != count:
            raise ArgumentError(
                f"period_guess holds {len(each)} values for {count} starts; give one for each, or "
                "one for all."
            )
    if model.period is None:
        for i, guess in enumerate(guesses or ()):
            if isinstance(guess, FloquetResult) and each[i] is None:
                each[i] = guess.period
    return [period_or_guess(model, period)[1] for period in each]


def _refined(
    model: Model,
    coarse: list[CoarseOrbit],
    known: Sequence[LimitCycle],
    options: dict[str, Any],
    told: Callable[..., None],
) -> list[LimitCycle]:
    found: list[LimitCycle] = []
    for number, orbit in enumerate(coarse, 1):
        period = orbit.period if model.period is None else None
        cycle = _collocated(model, orbit.states, period, **options)
        if cycle is not None and not among(cycle, [*known, *found]):
            found.append(cycle)
        told("refinement", number, len(coarse), len(found))
    return found


def _collocated(
    model: Model, states: FloatArray, period: float | None, method: SearchMethod, **options: Any
) -> LimitCycle | None:
    """The orbit near a coarse one, by shooting only if it is too rough; `None` if there is none."""
    try:
        return search_by_collocation(
            model,
            states,
            period_guess=period,
            damping="line-search",
            nodes=None,
            most_nodes=most_nodes(model, method),
            callback=None,
            **options,
        )
    except NotSmoothError as error:
        if method == "collocation" or not error.residual < NEAR:
            return None
        del options["accuracy"]
        start, end = error.best_x, error.history[-1].period
        return _shot_from(model, start, None if period is None else end, options)
    except (OrbitError, StateError):
        return None


def _shot(
    model: Model,
    guesses: list[Guess] | None,
    periods: list[float],
    known: Sequence[LimitCycle],
    options: dict[str, Any],
    told: Callable[..., None],
) -> list[LimitCycle]:
    starts: list[Guess | None] = [None] if guesses is None else list(guesses)
    found: list[LimitCycle] = []
    for number, (start, period) in enumerate(zip(starts, periods, strict=True), 1):
        cycle = _shot_from(model, start, period if model.period is None else None, options)
        if cycle is not None and not among(cycle, [*known, *found]):
            found.append(cycle)
        told("starts", number, len(starts), len(found))
    return found


def _shot_from(
    model: Model, start: Guess | None, period: float | None, options: dict[str, Any]
) -> LimitCycle | None:
    try:
        return find_limit_cycle(model, start, method="shooting", period_guess=period, **options)
    except ArgumentError:
        raise
    except (OrbitError, StateError):
        return None
