"""Ctrl-C at the command line: it ends the process at once, wherever the main thread is.

While modules are imported, kernels compiled and birds integrated, an exception that the handler of
the signal raised would be swallowed, rewrapped or shown as a traceback, and compiled code may keep
a handler waiting for seconds. So nothing is raised: the interpreter writes a byte to a socket when
the signal arrives (`signal.set_wakeup_fd`), and a thread that waits for it ends the process.

Imports nothing but the standard library, for it must be at work before all else is imported.
"""

import os
import signal
import socket
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType

INTERRUPTED = 130
INTERRUPTED_LINE = "Interrupted."

_SECONDS_TO_RELEASE = 0.5
_tidying: list[Callable[[], object]] = []
_ending = threading.Event()


@contextmanager
def ending_the_process() -> Iterator[None]:
    """End the process on Ctrl-C within; nothing is changed where Ctrl-C is ignored."""
    if not callable(signal.getsignal(signal.SIGINT)):
        yield
        return
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
    signal.signal(signal.SIGINT, _second_time)


def _second_time(_signal: int, _frame: FrameType | None) -> None:
    """Give up whatever keeps the first time from ending the process."""
    os._exit(INTERRUPTED)


def _end_on_signal(receiver: socket.socket) -> None:
    while signal.SIGINT not in receiver.recv(1024):
        pass
    _ending.set()
    for tidy in reversed(_tidying):
        with suppress(Exception):
            tidy()
    with suppress(OSError):
        os.write(2, f"{INTERRUPTED_LINE}\n".encode())
    # What the main thread makes of the end of its workers is no news.
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(nowhere, stream)
    _end_workers()
    os._exit(INTERRUPTED)


def _end_workers() -> None:
    """Kill the processes that were started, and release what they shared."""
    if "multiprocessing" not in sys.modules:
        return
    import multiprocessing  # noqa: PLC0415
    from multiprocessing import util  # noqa: PLC0415

    def kill() -> None:
        with suppress(Exception):
            for process in multiprocessing.active_children():
                process.kill()

    kill()
    # What the interpreter does at its exit. Without it, shared semaphores are reported as leaked.
    release = threading.Thread(target=util._exit_function, daemon=True)  # type: ignore[attr-defined]
    release.start()
    release.join(_SECONDS_TO_RELEASE)
    kill()  # those that the main thread has started meanwhile
