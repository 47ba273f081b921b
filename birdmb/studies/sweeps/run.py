"""Filling a study: points go to workers as soon as their neighbours are finished."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import closing
from dataclasses import dataclass
from os import PathLike
from typing import Any

from birdmb.arguments import checked
from birdmb.models import MultibodyModel
from birdmb.orbits.newton import Damping
from birdmb.orbits.search import ACCURACY, TOLERANCE, SearchMethod
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.relevance import check_relevant
from birdmb.studies.sweeps.checks import check_processes, check_trimming
from birdmb.studies.sweeps.dispatch import on_executor, on_processes
from birdmb.studies.sweeps.grid import Grid, Place, Value, parent
from birdmb.studies.sweeps.settings import Search, Trimming, identity
from birdmb.studies.sweeps.store import Store, place_text
from birdmb.studies.sweeps.study import Study
from birdmb.studies.sweeps.tasks import KEPT_FOR_NEIGHBOURS, Guess, Outcome, Task
from birdmb.summary import Summarised
from birdmb.topology import Bird

_NAMED = 4


@dataclass(frozen=True, repr=False)
class Finished(Summarised):
    """A point that is finished and stored.

    Attributes:
        values: of the parameters, by name.
        outcome: what became of it; `None` for the call before the first point.
        done: points of the grid that are stored, this one among them.
        total: points of the grid.
    """

    values: Mapping[str, Value]
    outcome: Outcome | None
    done: int
    total: int


@checked
def sweep(
    bird: Bird,
    vary: Mapping[str, Sequence[Any]],
    *,
    store: str | PathLike[str],
    executor: Executor | None = None,
    workers: int | None = None,
    model: ModelFactory = MultibodyModel,
    trim: Trimming | None = None,
    tolerance: float = TOLERANCE,
    accuracy: float = ACCURACY,
    max_iterations: int = 50,
    segments: int | None = None,
    method: SearchMethod = "auto",
    damping: Damping = "line-search",
    keep_to_sheet: bool = False,
    on_point: Callable[[Finished], None] | None = None,
) -> Study:
    """Find the limit cycles at all combinations of some parameters' values, in parallel.

    Each point starts from the flight found at a fixed neighbour, or, if that has none, at the
    nearest of the neighbour's own predecessors that has, moved to first order where that is not
    far; where this fails, from the model's own guess. Every finished point is stored at once;
    called again with the same arguments, `sweep` computes what is missing. Values may be appended
    to a parameter's; results depend, to the last bit, on neither executor, workers, interruptions
    nor the order in which values were appended. Where several cycles exist, the order of the values
    decides which is followed.

    A script must call it under `if __name__ == "__main__":`, for the workers import the script.

    Args:
        bird: the bird.
        vary: values (numbers or texts) by dotted name.
        store: file (SQLite) that keeps the study; made if there is none.
        executor: computes the points, for instance `dask.distributed.Client.get_executor()`; by
            default processes of its own.
        workers: number of those processes; by default one for each core.
        model: makes the model of a bird: `MultibodyModel`, `RigidModel`, `functools.partial` of
            them.
        trim: trims the flight of every point, as to level flight, by parameters that are not
            varied; without it, flights climb and sink as they do.
        tolerance, accuracy, max_iterations, segments, method, damping: of each search, as for
            `find_limit_cycle`.
        keep_to_sheet: where a flight is not on the sheet of its neighbour's (see `sheet_jump` of
            `Study.to_xarray`), or none is found, follow the neighbour's by smaller steps of the
            parameters; where its sheet ends, the point has failed.
        on_point: called after every point that has been stored, and once before the first of them.

    Raises:
        TopologyError: the bird has no value of that name. A value that is impossible is the failure
            of its points.
        SweepError: the store holds another study, or a worker process died.
        ArgumentError: an impossible tolerance, number of segments, method or trim, or a value
            that is varied or trimmed has no effect on the model.
    """
    grid = Grid.of(bird, vary)
    search = Search(tolerance, accuracy, max_iterations, segments, method, damping)
    if trim is not None:
        check_trimming(bird, grid, trim)
    check_relevant(bird, {**grid.parameters, **(trim.parameters if trim else {})}, model)
    if executor is None:
        check_processes(bird, model, workers)
    made_of = identity(bird, model, search, trim, keep_to_sheet=keep_to_sheet)
    with Store.opened(store, made_of, grid) as opened:
        filling = _Filling(bird, model, search, trim, grid, opened, on_point, keep_to_sheet)
        if filling.missing:
            filling.run(executor, workers)
    return Study.open(store)


class _Filling:
    """The points of a study on their way into its store."""

    def __init__(
        self,
        bird: Bird,
        model: ModelFactory,
        search: Search,
        trimming: Trimming | None,
        grid: Grid,
        store: Store,
        on_point: Callable[[Finished], None] | None,
        keep_to_sheet: bool = False,
    ) -> None:
        self._keep_to_sheet = keep_to_sheet
        self._bird, self._model = bird, model
        self._search, self._trimming = search, trimming
        self._grid, self._store, self._on_point = grid, store, on_point
        self._points = dict(store.contents.points)
        self._nearest: dict[Place, Place | None] = {}
        self._followers: dict[Place | None, list[Place]] = {}
        for place in grid.places():
            if place not in self._points:
                self._followers.setdefault(parent(place), []).append(place)
        self._total = grid.size

    @property
    def missing(self) -> int:
        """How many points of the grid are not in the store."""
        return self._total - len(self._points)

    def run(self, executor: Executor | None, workers: int | None) -> None:
        """Compute what is missing."""
        self._tell({}, None)
        ready: deque[Place] = deque()
        for before in (None, *self._points):
            ready.extend(self._followers.pop(before, ()))
        if executor is None:
            processes = min(workers or os.cpu_count() or 1, self.missing)
            computed = on_processes(
                processes, self._bird, self._model, ready, self._task, self._named
            )
        else:
            computed = on_executor(executor, ready, self._task, self._named)
        with closing(computed):
            for place, outcome in computed:
                self._store.add(self._grid, place, outcome)
                self._points[place] = outcome
                ready.extend(self._followers.pop(place, ()))
                self._tell(self._grid.values(place), outcome)

    def _named(self, places: Iterable[Place]) -> str:
        """The first of some points, which workers take in this order, for a sentence."""
        points = [self._grid.values(place) for place in places]
        texts = [", ".join(f"{k} = {v}" for k, v in p.items()) for p in points[:_NAMED]]
        more = [f"{len(points) - _NAMED} others"] if len(points) > _NAMED else []
        return "; ".join(texts + more)

    def _task(self, place: Place) -> Task:
        return Task(
            bird=self._bird,
            model=self._model,
            search=self._search,
            values=self._grid.values(place),
            steps=self._grid.steps(place),
            guess=self._guess(place),
            trimming=self._trimming,
            keep_to_sheet=self._keep_to_sheet,
        )

    def _guess(self, place: Place) -> Guess | None:
        before = self._nearest_flight(parent(place))
        if before is None:
            return None
        result = self._points[before].result
        assert result is not None
        kept = {name: result[name] for name in KEPT_FOR_NEIGHBOURS}
        return Guess(place_text(before), self._grid.values(before), kept)

    def _nearest_flight(self, place: Place | None) -> Place | None:
        """The place, or the first of its predecessors that has a flight.

        Kept for all places on the way, which would else grow with each point that fails.
        """
        failed = []
        while place is not None and self._points[place].result is None:
            if place in self._nearest:
                place = self._nearest[place]
                break
            failed.append(place)
            place = parent(place)
        self._nearest |= dict.fromkeys(failed, place)
        return place

    def _tell(self, values: Mapping[str, Value], outcome: Outcome | None) -> None:
        if self._on_point is not None:
            self._on_point(Finished(values, outcome, len(self._points), self._total))
