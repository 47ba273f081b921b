"""Processes that compute points, and that end with the one that started them, however it ends."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnContext, SpawnProcess
from typing import Any

from birdmb._starting import starting_processes
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.sweeps.point import prepare
from birdmb.topology import Bird


@contextmanager
def process_pool(workers: int | None, bird: Bird, model: ModelFactory | None) -> Iterator[Executor]:
    """A pool of processes with compiled kernels, unless there is no model; one for each core.

    Spawned, not forked: a fork would inherit threads and locks of whatever runs beside it. An
    exception inside ends the processes at once, in the middle of their points.
    """
    context = _Spawning()
    # Nothing is ever sent: that the parent's end is closed, by it or by its death, is the message.
    lifeline, held = context.Pipe(duplex=False)
    with starting_processes:
        pool = ProcessPoolExecutor(
            workers or os.cpu_count(),
            mp_context=context,
            initializer=_start,
            initargs=(lifeline, bird, model),
        )
    try:
        for _ in range(workers or os.cpu_count() or 1):
            pool.submit(int)  # the pool starts a process for each task that finds none idle
        yield pool
    except BaseException:
        # One that is still importing does not watch its lifeline yet.
        for process in context.made:
            if process.pid is not None:
                process.kill()
        raise
    finally:
        pool.shutdown(cancel_futures=True)
        held.close()
        lifeline.close()


class _Spawning(SpawnContext):
    """Spawns processes, and keeps them in `made`."""

    def __init__(self) -> None:
        super().__init__()
        self.made: list[SpawnProcess] = []

    def Process(self, *args: Any, **options: Any) -> SpawnProcess:  # type: ignore[override]  # noqa: N802
        """Make a process, as the pool does."""
        made = _Worker(*args, **options)
        self.made.append(made)
        return made


class _Worker(SpawnProcess):
    """Starts as a whole or not at all, and without Ctrl-C."""

    def start(self) -> None:
        """Start, as the pool does."""
        with starting_processes, _interrupts_kept_back():
            super().start()


@contextmanager
def _interrupts_kept_back() -> Iterator[None]:
    """Keep Ctrl-C, which a terminal sends to all processes, from those started within."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _start(lifeline: Connection, bird: Bird, model: ModelFactory | None) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with, args=(lifeline,), daemon=True).start()
    if model is not None:
        prepare(bird, model)


def _end_with(lifeline: Connection) -> None:
    with suppress(EOFError, OSError):
        lifeline.recv()
    os._exit(1)
