"""Handing points out: to any executor, or to processes of which some may die under their points."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import BrokenExecutor, Executor, Future
from queue import SimpleQueue
from typing import TypeAlias

from birdmb.studies.cycles import ModelFactory
from birdmb.studies.sweeps.errors import SweepError
from birdmb.studies.sweeps.grid import Place
from birdmb.studies.sweeps.point import COLD, compute
from birdmb.studies.sweeps.tasks import Outcome, Task
from birdmb.studies.sweeps.workers import process_pool
from birdmb.topology import Bird

DIED = "the worker process died under it, and again when it computed nothing else"
"""Begins the reason of a point that ends the process which computes it."""

TaskOf: TypeAlias = Callable[[Place], Task]
Computed: TypeAlias = Generator[tuple[Place, Outcome], None, None]
Named: TypeAlias = Callable[[Iterable[Place]], str]

_AGAIN = "Finished points are kept; run again for the others."


def on_executor(pool: Executor, ready: deque[Place], task_of: TaskOf, named: Named) -> Computed:
    """Compute what is ready, until nothing is; the caller may append to it after each outcome.

    Raises:
        SweepError: the executor broke, or could not run a point; `named` puts points into words.
    """
    hands = _Hands(pool, ready, task_of)
    try:
        yield from hands.computed()
    except _Unrun as unrun:
        if not isinstance(unrun.error, BrokenExecutor):
            hands.cancel()
            raise _impossible(unrun, named) from unrun.error
        raise SweepError(
            f"A worker process died, of too little memory perhaps; under way or next were "
            f"{named(hands.under_way)}. {_AGAIN} Processes of its own, without an executor, the "
            f"sweep replaces, and finds out which point it was."
        ) from unrun.error


def on_processes(
    workers: int,
    bird: Bird,
    model: ModelFactory,
    ready: deque[Place],
    task_of: TaskOf,
    named: Named,
) -> Computed:
    """As `on_executor`, in processes of its own, which may die.

    The points that were under way when one died are computed again, one at a time in a process
    that has nothing else to do: the outcome of one that ends this process too is that it does.

    Raises:
        SweepError: processes die before they compute anything, or a point cannot be sent to them.
    """
    suspects: deque[Place] = deque()
    try:
        while ready or suspects:
            if suspects:
                yield from _one_at_a_time(bird, suspects, task_of)
                continue
            with process_pool(workers, bird, model) as pool:
                # One more than there are processes, so that none waits for the store.
                hands = _Hands(pool, ready, task_of, most=workers + 1)
                try:
                    yield from hands.computed()
                except _Unrun as unrun:
                    if not isinstance(unrun.error, BrokenExecutor):
                        raise
                    yield from hands.finished()
                    suspects.extend(hands.under_way)
    except _Unrun as unrun:
        raise _impossible(unrun, named) from unrun.error


def _one_at_a_time(bird: Bird, suspects: deque[Place], task_of: TaskOf) -> Computed:
    """Outcomes of points that may end the process; after each of these there is a new one."""
    while suspects:
        # Without a model: what is flown to prepare it may be what ends the process.
        with process_pool(1, bird, None) as pool:
            try:
                pool.submit(int).result()
            except BrokenExecutor as error:
                raise SweepError(
                    "The worker processes die before they compute anything: of too little memory "
                    "perhaps, or because a script calls sweep outside "
                    f'`if __name__ == "__main__":`. {_AGAIN}'
                ) from error
            died = False
            while suspects and not died:
                began = time.perf_counter()
                one = _Hands(pool, deque([suspects[0]]), task_of)
                try:
                    ((place, outcome),) = one.computed()
                except _Unrun as unrun:
                    if not isinstance(unrun.error, BrokenExecutor):
                        raise
                    died, place = True, unrun.place
                    reason = f"{DIED} (killed, of too little memory perhaps)."
                    outcome = Outcome(None, reason, COLD, time.perf_counter() - began)
                suspects.popleft()
                yield place, outcome


def _impossible(unrun: _Unrun, named: Named) -> SweepError:
    error = unrun.error
    return SweepError(
        f"The executor could not run {named([unrun.place])} ({type(error).__name__}: {error}). "
        f"{_AGAIN}"
    )


class _Unrun(Exception):  # noqa: N818 - never leaves this module
    """A point whose executor failed, and its error; points themselves never raise."""

    def __init__(self, place: Place, error: Exception) -> None:
        super().__init__(place, error)
        self.place, self.error = place, error


class _Hands:
    """Points on their way through an executor, in the order in which they became ready."""

    def __init__(
        self, pool: Executor, ready: deque[Place], task_of: TaskOf, most: float = float("inf")
    ) -> None:
        self._pool, self._ready, self._task_of, self._most = pool, ready, task_of, most
        self._running: dict[Future[Outcome], Place] = {}
        self._done: SimpleQueue[Future[Outcome]] = SimpleQueue()

    @property
    def under_way(self) -> list[Place]:
        """What was handed out and has not come back."""
        return list(self._running.values())

    def computed(self) -> Computed:
        """Outcomes as they come; `_Unrun` ends it."""
        try:
            while self._ready or self._running:
                while self._ready and len(self._running) < self._most:
                    self._hand_out()
                future = self._done.get()
                outcome = self._outcome(future)
                yield self._running.pop(future), outcome
        except _Unrun:
            raise  # a pool that breaks is about to set what is under way, not to be cancelled
        except BaseException:
            self.cancel()
            raise

    def cancel(self) -> None:
        """Take back what has not begun."""
        for future in self._running:
            future.cancel()

    def finished(self) -> Computed:
        """Outcomes that had arrived when the executor broke, but were not taken yet."""
        for future, place in list(self._running.items()):
            if future.exception() is None:
                del self._running[future]
                yield place, future.result()

    def _hand_out(self) -> None:
        place = self._ready[0]
        task = self._task_of(place)
        try:
            future = self._pool.submit(compute, task)
        except Exception as error:
            raise _Unrun(place, error) from error
        self._running[future] = self._ready.popleft()
        future.add_done_callback(self._done.put)

    def _outcome(self, future: Future[Outcome]) -> Outcome:
        try:
            return future.result()
        except Exception as error:
            if type(error).__name__ == "KilledWorker":  # Dask's, which has tried several workers
                return Outcome(None, f"{DIED} ({error}).", COLD, 0.0)
            raise _Unrun(self._running[future], error) from error
