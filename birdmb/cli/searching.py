"""The search of `birdmb cycle` for a flight: from a guess, from many starts, and for others."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from birdmb._typing import FloatArray
from birdmb.cli.models import bound_model
from birdmb.cli.outcome import SearchFailed
from birdmb.cli.results import finite, taken_as_prescribed
from birdmb.errors import OrbitError, StateError
from birdmb.models import MultibodyModel, RigidModel
from birdmb.orbits import (
    ArgumentError,
    Attempt,
    ConvergenceError,
    NotSmoothError,
    find_limit_cycle,
    find_limit_cycles,
)
from birdmb.orbits.coarse import COARSE_NODES
from birdmb.orbits.collocation_search import search_by_collocation
from birdmb.orbits.search import ACCURACY, most_nodes

if TYPE_CHECKING:
    from birdmb.cli.progress import Progress
    from birdmb.cli.saved_guess import SavedGuess
    from birdmb.models import FlightCycle
    from birdmb.models.motion import FlightMotionName
    from birdmb.orbits.newton import Damping
    from birdmb.orbits.search import SearchMethod
    from birdmb.topology import Bird

# What another search costs grows with the states; with no more than these, a fraction of a second.
_FEW_STATES = 6
_FEW_STARTS = 5
_ITERATIONS_PER_START = 25
TRIM = (
    "`birdmb trim TOPOLOGY` looks for a value of the bird with which it flies level, by default "
    "the offset of the joint that turns the chords (--by names another), and such a bird is a good "
    "one to begin with"
)


@dataclass(frozen=True)
class Search:
    """What the options say about model and search; see `find_limit_cycle`."""

    model: str
    motion: FlightMotionName
    segments: int | None
    tolerance: float
    max_iterations: int
    method: SearchMethod
    damping: Damping
    steps_per_beat: int | None

    @property
    def options(self) -> dict[str, Any]:
        """Arguments of `find_limit_cycle`."""
        # Steps are of the time integration: who gives them wants it.
        by_steps = self.steps_per_beat is not None and self.method == "auto"
        return {
            "segments": self.segments,
            "tolerance": self.tolerance,
            "max_iterations": self.max_iterations,
            "method": "shooting" if by_steps else self.method,
            "damping": self.damping,
        }


def model_of(
    bird: Bird, name: str, motion: FlightMotionName, steps_per_beat: int | None
) -> RigidModel | MultibodyModel:
    """The model of a bird that the options --model and --motion name.

    Raises:
        InputError: the model has no such motion.
        TopologyError: the bird lacks what the motion needs.
    """
    return bound_model(name, motion, steps_per_beat)(bird)


def announce(model: RigidModel | MultibodyModel, name: str, progress: Progress) -> None:
    """Say which model is searched, and what it leaves out of the bird."""
    bird = model.bird
    progress.line(
        f"{bird.name}, {name} model: {len(model.state_names)} states, "
        f"wingbeat of {bird.period:.4g} s"
    )
    if held := taken_as_prescribed(model):
        progress.line(
            f"The {name} model takes {', '.join(held)} as prescribed: springs and dampers are not "
            "used."
        )


def deflations_for(model: RigidModel | MultibodyModel) -> int:
    """How many deflated searches to make: fewer of a bird of which each takes a quarter second."""
    return 12 if len(model.motion_state_names) <= _FEW_STATES else 4


def told(progress: Progress) -> Any:
    """A callback that shows on a terminal how far a search from many starts has come."""
    stages = {"starts": "start", "deflation": "deflated search", "refinement": "refining"}

    def tell(attempt: Attempt) -> None:
        progress.doing(
            f"{stages[attempt.stage]} {attempt.done} of {attempt.of}, {attempt.found} found"
        )

    return tell


def found_flight(
    model: RigidModel | MultibodyModel,
    search: Search,
    guess: SavedGuess | None,
    progress: Progress,
) -> FlightCycle:
    """The flight that the guess leads to, else the best that many starts lead to.

    Raises:
        SearchFailed: there is none; it keeps the point that the guess led to.
        StateError: the model fails wherever it starts.
    """
    progress.doing("looking for a first guess")
    start = None if guess is None else guess.states_for(model, search.segments)
    try:
        first = _by_choice(model, start, search, progress)
    except ArgumentError:
        raise
    except (OrbitError, StateError) as error:
        return _from_many_starts(model, search, start, error, progress)
    if first.why_no_flight is None or guess is not None:
        return first
    progress.line(f"Not a flight: {first.why_no_flight}. Looking for one from other starts.")
    others = [each for each in _all(model, search, progress) if each.why_no_flight is None]
    return _again(model, others[0], search, progress) if others else first


def _by_choice(
    model: RigidModel | MultibodyModel, start: Any, search: Search, progress: Progress
) -> FlightCycle:
    """As `find_limit_cycle`, but shot only where that is asked for or the cycle is too rough.

    Where collocation finds nothing, other starts promise more than shooting, and take less time.
    """
    options = search.options
    segments = options.pop("segments")
    if options.pop("method") == "auto" and segments is None:
        try:
            cycle = search_by_collocation(
                model,
                start,
                period_guess=None,
                start_time=0.0,
                accuracy=ACCURACY,
                nodes=None,
                most_nodes=most_nodes(model, "auto"),
                callback=progress.iteration,
                **options,
            )
            return cast("FlightCycle", cycle)
        except NotSmoothError:
            pass
    return _cycle(model, start, search, progress)


def _from_many_starts(
    model: RigidModel | MultibodyModel,
    search: Search,
    start: Any,
    error: Exception,
    progress: Progress,
) -> FlightCycle:
    progress.line("No limit cycle from the first guess. Looking for one from other starts.")
    try:
        found = _all(model, search, progress)
    except StateError:
        raise error from None
    if found:
        progress.line(f"They lead to {number_of(found)}.")
        return _again(model, found[0], search, progress)
    try:
        return _cycle(model, start, search, progress)
    except (OrbitError, StateError) as last:
        error = last
    reached: dict[str, object] = {"bird": model.bird.name, "model": search.model}
    if isinstance(error, ConvergenceError):
        best = dict(zip(model.state_names, map(finite, error.best_x), strict=True))
        reached |= {
            "x": best,
            "residual": finite(error.residual),
            "iterations": max(len(error.history) - 1, 0),
        }
    raise SearchFailed(
        f"{str(error).rstrip('.')}. Other starts, over speed, incidence and path angle, lead to no "
        f"flight either. What to do next: {TRIM}.",
        reached,
    ) from error


def number_of(cycles: list[FlightCycle]) -> str:
    """How many of sorted cycles, flights first, are flights: "1 flight and 1 limit cycle ..."."""
    flights = sum(cycle.why_no_flight is None for cycle in cycles)
    none = len(cycles) - flights
    if not none:
        return f"{flights} flight{'' if flights == 1 else 's'}"
    no_flights = f"{none} limit cycle{' that is' if none == 1 else 's that are'} no flight"
    return f"{number_of(cycles[:flights])} and {no_flights}" if flights else no_flights


def _all(
    model: RigidModel | MultibodyModel, search: Search, progress: Progress
) -> list[FlightCycle]:
    return find_limit_cycles(
        model,
        max_iterations=min(search.max_iterations, _ITERATIONS_PER_START),
        deflations=deflations_for(model),
        callback=told(progress),
    )


def _again(
    model: RigidModel | MultibodyModel, cycle: FlightCycle, search: Search, progress: Progress
) -> FlightCycle:
    """The cycle found as the options want it; as it was found if they fail there."""
    try:
        return _cycle(model, cycle, search, progress)
    except (OrbitError, StateError):
        return cycle


def _cycle(
    model: RigidModel | MultibodyModel, start: Any, search: Search, progress: Progress
) -> FlightCycle:
    return find_limit_cycle(model, start, callback=progress.iteration, **search.options)


def other_flights(
    model: RigidModel | MultibodyModel, cycle: FlightCycle, progress: Progress
) -> list[FlightCycle] | None:
    """Other flights of the same bird that a short look finds; `None` if it would not be short."""
    if len(model.motion_state_names) > _FEW_STATES or cycle.method != "collocation":
        return None
    progress.doing("looking for other flights")
    try:
        found = find_limit_cycles(
            model, _starts_of_others(model), known=[cycle], deflations=0, method="collocation"
        )
    except (OrbitError, StateError):
        return None
    return [flight for flight in found if flight.why_no_flight is None]


def _starts_of_others(model: RigidModel | MultibodyModel) -> list[FloatArray] | None:
    """Starts for a short look: all of the rigid bird's, which take milliseconds each.

    Of the multibody bird those along forward flights, without the guess, which has been tried.
    """
    if isinstance(model, RigidModel):
        return None
    times = model.bird.period * np.arange(COARSE_NODES) / COARSE_NODES
    first = islice(model.starting_paths(times), 1, _FEW_STARTS)
    paths = [path for path in first if _forwards(path)]
    return paths or [model.guess_along(times)]


def _forwards(path: FloatArray) -> bool:
    u, _, _, theta = path[:, :4].mean(axis=0)
    return bool(u > 0.0 and np.cos(theta) > 0.0)
