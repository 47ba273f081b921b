"""One thread of linear algebra while points are computed."""

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


@contextmanager
def one_thread() -> Iterator[None]:
    """One thread of linear algebra within: how many share a sum decides its last bits.

    The limit is the whole process's. Where threads compute points side by side, the first one that
    begins sets it and the last one that ends lifts it.
    """
    global _computing, _limits  # noqa: PLW0603 - the limit that they count is global, too
    with _counting:
        _computing += 1
        if _computing == 1:
            _limits = _libraries().limit(limits=1)
    try:
        yield
    finally:
        with _counting:
            _computing -= 1
            if _computing == 0 and _limits is not None:
                _limits.restore_original_limits()
                _limits = None
