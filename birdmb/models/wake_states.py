"""The states of the air's memory among those of a model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.wake_lags import KINDS, UNITS, WakeLags, wake_lags
from birdmb.errors import TopologyError
from birdmb.topology import SIDES, Bird

_SCALE = {"m/s": 5.0, "m2/s": 1.0}


@dataclass(frozen=True)
class WakeStates:
    """The lags of a bird's wings, the right wing's first; none where its air has no memory.

    Attributes:
        lags: where along a wing they are kept.
        sides: 1 where both wings move as mirror images and have them in common, else 2.
    """

    lags: WakeLags
    sides: int

    @property
    def count(self) -> int:
        """Number of the states."""
        return self.sides * len(KINDS) * self.lags.kept.size

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the states, as `wake.bound_slow.1`, the points counted from the root."""
        points = range(1, self.lags.kept.size + 1)
        names = [f"wake.{kind}.{point}" for kind in KINDS for point in points]
        if self.sides == len(SIDES):
            names = [f"{name}.{side}" for side in SIDES for name in names]
        return tuple(names)

    @property
    def units(self) -> tuple[str, ...]:
        """Units of the states."""
        return tuple(unit for unit in UNITS for _ in self.lags.kept) * self.sides

    @property
    def scale(self) -> tuple[float, ...]:
        """Typical sizes of the states."""
        return tuple(_SCALE[unit] for unit in self.units)

    def mirrored(self, first: int) -> IntArray:
        """Positions of the states that take each one's place in the mirror image.

        `first` states stand before them.
        """
        order = np.arange(first, first + self.count)
        return np.roll(order, self.count // 2) if self.sides == len(SIDES) else order

    def settled(self, rates: FloatArray, slopes: FloatArray) -> FloatArray:
        """Lags (K, m) that would not change in motions that were steady.

        Of the rates (K, m) of lags that are zero, and their derivatives (K, m, m) by the lags.
        """
        if not self.count:
            return rates
        return np.asarray(-np.linalg.solve(slopes, rates[:, :, None])[:, :, 0])


def wake_states(bird: Bird, sides: int) -> WakeStates:
    """The states of the air's memory about the wings of a bird.

    Raises:
        TopologyError: the air has a memory, and the wing's line is not smooth in time, or has too
            few elements to keep lags at.
    """
    numbers, points = bird.wing.resolved_discretisation, bird.air.wake_points
    if bird.air.wake == "quasi-steady":
        none = WakeLags(np.empty(0, np.int64), np.empty((numbers.elements, 0)))
        return WakeStates(none, sides)
    if numbers.scheme == "one-step":
        raise TopologyError(
            f'{bird.name}: air.wake = "unsteady" needs a wing whose motion is smooth in time, and '
            'the line of scheme "one-step" (the preset "published") is not; take '
            'wing.discretisation = "converged".'
        )
    if points > numbers.elements:
        raise TopologyError(
            f"{bird.name}: air.wake_points is {points}, and the wing has {numbers.elements} "
            f"elements; take air.wake_points from 4 to the number of elements, or more of these "
            f"(wing.discretisation)."
        )
    return WakeStates(wake_lags(numbers.elements, points), sides)
