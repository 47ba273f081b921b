"""What time alone determines of a wing, kept for all who ask for the same instants."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from birdmb._typing import FloatArray
from birdmb.aerodynamics.prescribed import driver_motion_along
from birdmb.models.failures import lifting_line_lost
from birdmb.models.kept import KeptByTimes
from birdmb.topology import Bird
from birdmb.wing.arrays import WingArrays
from birdmb.wing.stacked import NearShapes, StackedShapes, wing_shapes

_INSTANTS_KEPT = 8192
# Of a beat: differences over it err by 1e-8, and round-off by 1e-10.
NEARBY = 3e-5


class StackedInstants(NamedTuple):
    """What P instants determine; the arrays are shared and must not be written to."""

    angles: FloatArray  # (P, A) rad, of the drivers
    rates: FloatArray  # (P, A) rad/s
    accelerations: FloatArray  # (P, A) rad/s2
    shapes: NearShapes | None  # with the joints at zero that turn the wing, if known


@lru_cache(maxsize=4)
def _kept(_key: tuple[object, ...]) -> KeptByTimes[StackedInstants]:
    """Kept by all birds with the same wing and drivers."""
    return KeptByTimes(_INSTANTS_KEPT)


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
        self._kept = _kept(
            (how, bird.air.wake, bird.period, *((p.shape, p.tobytes()) for p in parts))
        )

    def stacked(self, times: FloatArray) -> StackedInstants:
        """What `times` (P,) s determine; raises `StateError` if no lifting line fits the wing."""
        return self._kept.get(times, self._made)

    def _made(self, times: FloatArray) -> StackedInstants:
        angles, rates, accelerations = driver_motion_along(self._wing, times)
        shapes = None if self._shaping else self.shapes(times, angles, rates, accelerations)
        return StackedInstants(angles, rates, accelerations, shapes)

    def shapes(
        self, times: FloatArray, angles: FloatArray, rates: FloatArray, accelerations: FloatArray
    ) -> NearShapes:
        """The wing at `times` (P,) s, `angles` and `rates` (P, A), the joints that turn it at zero.

        Where the air remembers, with its shapes a short time before and after, moved at these rates
        and at the `accelerations` (P, A) of those joints that follow drivers.
        Raises `StateError` if no lifting line fits it.
        """
        moving = np.arange(angles.shape[1]) >= self._rigid_joint_count
        angles, rates = moving * angles, moving * rates
        now = self._shapes(times, angles, rates)
        if self._bird.air.wake == "quasi-steady":
            return NearShapes(now, now, now, 1.0)
        driven = moving.copy()
        driven[list(self._shaping)] = False
        step = NEARBY * self._bird.period
        before, after = (
            self._shapes(times, angles + ahead * rates, rates + ahead * driven * accelerations)
            for ahead in (-step, step)
        )
        return NearShapes(now, before, after, step)

    def _shapes(self, times: FloatArray, angles: FloatArray, rates: FloatArray) -> StackedShapes:
        hinges = self._wing.segment.size
        singly = [joint for joint in self._shaping if joint < hinges]
        shapes = wing_shapes(self._wing, angles, rates, *self._discretisation, singly)
        if not shapes.converged.all():
            k = int(np.argmin(shapes.converged))
            raise lifting_line_lost(self._bird, float(times[k]), angles[k])
        return shapes
