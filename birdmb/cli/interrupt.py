"""Ctrl-C at the command line: it ends the process at once, wherever the main thread is.

While modules are imported, kernels compiled and birds integrated, an exception that the handler of
the signal raised would be swallowed, rewrapped or shown as a traceback, and compiled code may keep
a handler waiting for seconds. So nothing is raised: the interpreter writes a byte to a socket when
the signal arrives (`signal.set_wakeup_fd`), and a thread that waits for it ends the process.

Imports little but the standard library, for it must be at work before all else is imported.
"""

from __future__ import annotations

import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType

from birdmb._starting import starting_processes

INTERRUPTED = 130
INTERRUPTED_LINE = "Interrupted."

_SECONDS_OF_PATIENCE = 1.0
# A process of the interpreter's outlives this one, and removes the semaphores that it shared with
# its workers. That this was needed is no news: an interruption never gives them back.
_TRACKER_QUIET = "ignore:resource_tracker:UserWarning"
_tidying: list[Callable[[], object]] = []
_ending = threading.Event()


@contextmanager
def ending_the_process() -> Iterator[None]:
    """End the process on Ctrl-C within; Ctrl-C that is ignored stays so."""
    sys.warnoptions.append(_TRACKER_QUIET)  # what Python processes started from here are told
    try:
        if callable(signal.getsignal(signal.SIGINT)):
            with _watched():
                yield
        else:
            yield
    finally:
        sys.warnoptions.remove(_TRACKER_QUIET)


@contextmanager
def _watched() -> Iterator[None]:
    receiver, sender = socket.socketpair()
    sender.setblocking(False)
    # What arrives before the thread has started waits in the socket.
    signal.set_wakeup_fd(sender.fileno(), warn_on_full_buffer=False)
    signal.signal(signal.SIGINT, _first_time)
    watch = threading.Thread(target=_end_on_signal, args=(receiver,), daemon=True)
    watch.start()
    try:
        yield
    finally:
        if _ending.is_set():  # the status of the process is that of the interruption
            watch.join()


@contextmanager
def tidied(tidy: Callable[[], object]) -> Iterator[None]:
    """Call `tidy` before an interruption within ends the process, or goes on as an exception.

    It is called in another thread than the one that is interrupted.
    """
    _tidying.append(tidy)
    try:
        yield
    except KeyboardInterrupt:
        tidy()
        raise
    finally:
        _tidying.remove(tidy)


def _first_time(_signal: int, _frame: FrameType | None) -> None:
    """Leave it to the thread that waits for the signal."""
    patient_until = time.monotonic() + _SECONDS_OF_PATIENCE

    def again(_signal: int, _frame: FrameType | None) -> None:
        """Give up whatever keeps the first time from ending the process."""
        # A key pressed twice is no reason to leave workers behind, which then complain.
        if time.monotonic() > patient_until:
            os._exit(INTERRUPTED)

    signal.signal(signal.SIGINT, again)


def _end_on_signal(receiver: socket.socket) -> None:
    while signal.SIGINT not in receiver.recv(1024):
        pass
    _ending.set()
    for tidy in reversed(_tidying):
        with suppress(Exception):
            tidy()
    terminal, nowhere = _standard_error(), os.open(os.devnull, os.O_WRONLY)
    # What the main thread makes of the end of its workers is no news.
    for stream in (1, 2):
        os.dup2(nowhere, stream)
    _end_workers()
    if terminal is not None:
        with suppress(OSError):
            os.write(terminal, f"{INTERRUPTED_LINE}\n".encode())
    os._exit(INTERRUPTED)


def _standard_error() -> int | None:
    try:
        return os.dup(2)
    except OSError:
        return None


def _end_workers() -> None:
    """Kill the processes that were started, and have none started any more."""
    # Never given back. One in the middle of its start could not be killed, and would complain.
    starting_processes.acquire()
    if "multiprocessing" not in sys.modules:
        return
    import multiprocessing  # noqa: PLC0415 - slow to import

    with suppress(Exception):
        workers = multiprocessing.active_children()
        for process in workers:
            process.kill()
        for process in workers:
            process.join()
