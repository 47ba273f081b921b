"""Where the states of compliant joints and hinges stand among those of a model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from birdmb._typing import BoolArray, FloatArray, IntArray
from birdmb.topology import SIDES, Bird

_SCALE = (0.5, 10.0)  # rad, rad/s


@dataclass(frozen=True)
class JointStates:
    """Angle and rate of each compliant joint and each hinge, the right wing's first.

    Attributes:
        bird: the bird.
        first: how many states of the body stand before them.
        sides: 1 where both wings move as mirror images and have them in common, else 2.
        compliant: which (A,) of a wing's joints and hinges do not follow a driver.
    """

    bird: Bird
    first: int
    sides: int
    compliant: BoolArray

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the states."""
        angles = np.array(self.bird.angle_names)[self.compliant].tolist()
        if self.sides == len(SIDES):
            angles = [f"{name}.{side}" for side in SIDES for name in angles]
        return tuple(name for angle in angles for name in (angle, f"{angle}.rate"))

    @property
    def count(self) -> int:
        """Number of the joints and hinges, over the sides."""
        return self.sides * int(self.compliant.sum())

    @property
    def units(self) -> tuple[str, ...]:
        """Units of the states."""
        return ("rad", "rad/s") * self.count

    @property
    def scale(self) -> tuple[float, ...]:
        """Typical sizes of the states."""
        return _SCALE * self.count

    @property
    def states(self) -> slice:
        """Where the states stand."""
        return slice(self.first, self.first + 2 * self.count)

    def put(self, states: FloatArray, angles: FloatArray, rates: FloatArray) -> None:
        """Overwrite what is compliant of angles and rates (K, 2, A) by the states (K, n)."""
        own = states[:, self.states].reshape(len(states), self.sides, -1, 2)
        angles[:, :, self.compliant] = own[..., 0]
        rates[:, :, self.compliant] = own[..., 1]

    def taken(self, angles: FloatArray, rates: FloatArray) -> FloatArray:
        """The states (K, 2 C) of angles and rates (K, 2, A)."""
        moving = np.stack([angles, rates], axis=-1)[:, : self.sides, self.compliant]
        return np.asarray(moving.reshape(len(angles), 2 * self.count))

    def spread(self, states: FloatArray, sides: int) -> FloatArray:
        """The states (..., m) of a model with so many sides as those of this one."""
        return np.concatenate([states] * (self.sides // sides), axis=-1)

    @property
    def mirrored(self) -> IntArray:
        """Positions (2 C,) of the states that take each one's place in the mirror image."""
        order = np.arange(self.first, self.first + 2 * self.count)
        return np.roll(order, self.count) if self.sides == len(SIDES) else order
