"""What was made of sets of instants, kept: flows and searches ask for the same ones again."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

from birdmb._typing import FloatArray

MadeT = TypeVar("MadeT")


class KeptByTimes(Generic[MadeT]):
    """What was made of times, by their very bits.

    Args:
        most: how many instants are kept; one set more, and all others are dropped.
    """

    def __init__(self, most: int) -> None:
        self._most, self._count = most, 0
        self._made: dict[bytes, MadeT] = {}

    def get(self, times: FloatArray, make: Callable[[FloatArray], MadeT]) -> MadeT:
        """What was made of `times` (P,) s, or is made now; raises what making it raises."""
        key = times.tobytes()
        if key not in self._made:
            made = make(times)
            self._count += times.size
            if self._count > self._most:
                self._made.clear()
                self._count = times.size
            self._made[key] = made
            return made
        return self._made[key]
