"""What time alone determines of a bird's wing, kept for all who ask for the same instants."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from birdmb._typing import FloatArray
from birdmb.aerodynamics.prescribed import driver_motion, driver_motion_along
from birdmb.models.exudyn_tree import BODY_COORDINATES
from birdmb.models.failures import lifting_line_lost
from birdmb.topology import Bird
from birdmb.wing.arrays import WingArrays
from birdmb.wing.shape import WingShape, wing_shape
from birdmb.wing.stacked import StackedShapes, wing_shapes

_INSTANTS_KEPT = 8192


class DriverState(NamedTuple):
    """What an instant alone determines; its arrays are shared and must not be written to."""

    angles: FloatArray  # (A,) rad, of the drivers
    rates: FloatArray  # (A,) rad/s
    accelerations: FloatArray  # (n,) of the drivers, 0 for the body
    shape: WingShape | None  # with the joints that turn the wing as a whole at zero, if known


class StackedInstants(NamedTuple):
    """What P instants determine, as `DriverState`, each array stacked along a first axis."""

    angles: FloatArray  # (P, A)
    rates: FloatArray  # (P, A)
    accelerations: FloatArray  # (P, A) of the drivers
    shapes: StackedShapes | None


class _Kept(NamedTuple):
    """What was made so far."""

    single: dict[float, DriverState]  # by time (s)
    stacks: dict[bytes, StackedInstants]  # by the times' bytes

    def stack(self, times: FloatArray, made: StackedInstants) -> StackedInstants:
        """Keep a stack of many, in place of all others where they become too many."""
        if sum(len(each.angles) for each in self.stacks.values()) + times.size > _INSTANTS_KEPT:
            self.stacks.clear()
        self.stacks[times.tobytes()] = made
        return made


@lru_cache(maxsize=2)
def _kept(_key: tuple[object, ...]) -> _Kept:
    """Kept by all birds with the same wing and drivers."""
    return _Kept({}, {})


class Instants:
    """Drivers and shape of a wing at any time.

    Kept, for every trajectory and every perturbation of it asks for the same instants again, as do
    birds that differ in masses, springs and dampers alone.

    Args:
        bird: the bird.
        wing: its wing.
        discretisation: elements, rounding and whether the line is the published one.
        rigid_joint_count: how many joints at the shoulder turn the wing as a whole.
        shaping: which of the other joints and hinges follow no driver, and shape the wing; if any
            do, no shape is made in advance.
    """

    def __init__(
        self,
        bird: Bird,
        wing: WingArrays,
        discretisation: tuple[int, float, bool],
        rigid_joint_count: int,
        shaping: Sequence[int],
    ) -> None:
        self._bird, self._wing = bird, wing
        self._discretisation, self._rigid_joint_count = discretisation, rigid_joint_count
        self._shaping = tuple(shaping)
        parts = (np.asarray(part) for part in wing)
        how = rigid_joint_count, self._shaping, discretisation
        self._kept = _kept((how, *((p.shape, p.tobytes()) for p in parts)))

    def stacked(self, times: FloatArray) -> StackedInstants:
        """What `times` (P,) s determine; raises `StateError` if no lifting line fits the wing."""
        found = self._kept.stacks.get(times.tobytes())
        if found is None:
            angles, rates, accelerations = driver_motion_along(self._wing, times)
            shapes = None if self._shaping else self.shapes(times, angles, rates)
            made = StackedInstants(angles, rates, accelerations, shapes)
            found = self._kept.stack(times, made)
        return found

    def shapes(self, times: FloatArray, angles: FloatArray, rates: FloatArray) -> StackedShapes:
        """The wing at `times` (P,) s, `angles` and `rates` (P, A), as `shape` gives each."""
        moving = np.arange(angles.shape[1]) >= self._rigid_joint_count
        hinges = self._wing.segment.size
        singly = [joint for joint in self._shaping if joint < hinges]
        how = self._discretisation
        shapes = wing_shapes(self._wing, moving * angles, moving * rates, *how, singly)
        if not shapes.converged.all():
            k = int(np.argmin(shapes.converged))
            raise lifting_line_lost(self._bird, float(times[k]), angles[k])
        return shapes

    def at(self, t: float) -> DriverState:
        """What time t (s) determines; raises `StateError` if no lifting line fits the wing."""
        kept = self._kept.single
        instant = kept.get(t)
        if instant is None:
            if len(kept) >= _INSTANTS_KEPT:
                kept.clear()
            instant = kept[t] = self._made(t)
        return instant

    def shape(self, t: float, angles: FloatArray, rates: FloatArray) -> WingShape:
        """The wing at t (s) and these angles and rates (A,), the joints that turn it left at zero.

        Raises `StateError` if no lifting line fits it.
        """
        moving = np.arange(angles.size) >= self._rigid_joint_count
        shape = wing_shape(self._wing, moving * angles, moving * rates, *self._discretisation)
        if not shape.converged:
            raise lifting_line_lost(self._bird, t, angles)
        return shape

    def _made(self, t: float) -> DriverState:
        angles, rates, accelerations = driver_motion(self._wing, t)
        shape = None if self._shaping else self.shape(t, angles, rates)
        of_tree = np.concatenate([np.zeros(BODY_COORDINATES), accelerations, accelerations])
        for shared in (angles, rates, of_tree):
            shared.flags.writeable = False
        return DriverState(angles, rates, of_tree, shape)
