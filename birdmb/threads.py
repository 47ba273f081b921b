"""One thread of linear algebra: for small matrices more cost time and the last bits of results."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

from threadpoolctl import ThreadpoolController

_counting = threading.Lock()
_computing = 0
_limits: Any = None


@cache
def _libraries() -> ThreadpoolController:
    """Those of this process; finding them takes longer than a flight may."""
    return ThreadpoolController()


def _take_control() -> None:
    """Let this thread set the limit: threadpoolctl 3.8 leaves that to the first that ever did."""
    for library in _libraries().lib_controllers:
        clear = getattr(library, "clear_controlling_thread", None)
        if clear is not None:
            clear(force=True)


@contextmanager
def one_thread() -> Iterator[None]:
    """One thread of linear algebra within: how many share a sum decides its last bits.

    The limit is the whole process's. Where threads compute side by side, the first one that begins
    sets it and the last one that ends lifts it.
    """
    global _computing, _limits  # noqa: PLW0603 - the limit that they count is global, too
    with _counting:
        _computing += 1
        if _computing == 1:
            _take_control()
            _limits = _libraries().limit(limits=1)
    try:
        yield
    finally:
        with _counting:
            _computing -= 1
            if _computing == 0 and _limits is not None:
                _take_control()
                _limits.restore_original_limits()
                _limits = None
                _take_control()
