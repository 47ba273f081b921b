"""Ctrl-C while compiled code is at work."""

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn

from birdmb.cli.outcome import INTERRUPTED, INTERRUPTED_LINE


@contextmanager
def ending_at_once(tidy: Callable[[], None]) -> Iterator[None]:
    """End the process on Ctrl-C after `tidy()`, instead of raising KeyboardInterrupt.

    Exudyn calls back into Python: an exception raised there by a signal would pass through its
    compiled code, which prints a banner and rewraps it, or crashes.
    """

    def end(_signal: int, _frame: FrameType | None) -> NoReturn:
        tidy()
        sys.stderr.write(f"{INTERRUPTED_LINE}\n")
        sys.stderr.flush()
        os._exit(INTERRUPTED)

    if threading.current_thread() is not threading.main_thread():
        yield  # signals arrive in the main thread alone
        return
    before = signal.signal(signal.SIGINT, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
