"""A periodic orbit that a search found."""

from __future__ import annotations

from dataclasses import dataclass

from birdmb.orbits.newton import Iteration
from birdmb.orbits.result import FloquetResult


@dataclass(frozen=True)
class LimitCycle(FloquetResult):
    """A periodic orbit found by `find_limit_cycle`, with its Floquet multipliers.

    A model may name its own subclass as `limit_cycle_type`, to add what it knows of its orbits.

    Attributes:
        iterations: the accepted iterations of the search, the guess first.
    """

    iterations: tuple[Iteration, ...]
