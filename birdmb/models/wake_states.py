"""The states of the air's memory among those of a model."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.prescribed import driver_motion
from birdmb.aerodynamics.separation_curves import SeparationCurves, separation_curves
from birdmb.aerodynamics.wake_lags import KINDS, UNITS, WakeLags, no_wake_lags, wake_lags
from birdmb.errors import TopologyError
from birdmb.models.failures import lifting_line_lost
from birdmb.models.implicit import Rates
from birdmb.topology import SIDES, Bird
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.shape import wing_shape

_SCALE = {"m/s": 5.0, "m2/s": 1.0, "1": 1.0}
_SHARE, _OF_SHARE = "attached_share", "1"  # kind and unit of the states of separated flow


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
    def separates(self) -> bool:
        """Whether attached shares of the chord are among the states."""
        return bool(self.lags.separation.of.size)

    @cached_property
    def _kinds(self) -> tuple[str, ...]:
        return (*KINDS, _SHARE) if self.separates else KINDS

    @cached_property
    def count(self) -> int:
        """Number of the states."""
        return self.sides * len(self._kinds) * self.lags.kept.size

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the states, as `wake.bound_slow.1`, the points counted from the root."""
        points = range(1, self.lags.kept.size + 1)
        names = [f"wake.{kind}.{point}" for kind in self._kinds for point in points]
        if self.sides == len(SIDES):
            names = [f"{name}.{side}" for side in SIDES for name in names]
        return tuple(names)

    @cached_property
    def units(self) -> tuple[str, ...]:
        """Units of the states."""
        units = (*UNITS, _OF_SHARE) if self.separates else UNITS
        return tuple(unit for unit in units for _ in self.lags.kept) * self.sides

    @property
    def shares(self) -> IntArray:
        """Positions (S K,) of the attached shares among the states of the air's memory."""
        return np.flatnonzero(np.array(self.units) == _OF_SHARE)

    @property
    def attached(self) -> FloatArray:
        """States (K,) of still air about wings whose flow is attached."""
        return (np.array(self.units) == _OF_SHARE).astype(float)

    @cached_property
    def scale(self) -> tuple[float, ...]:
        """Typical sizes of the states."""
        return tuple(_SCALE[unit] for unit in self.units)

    def mirrored(self, first: int) -> IntArray:
        """Positions of the states that take each one's place in the mirror image.

        `first` states stand before them.
        """
        order = np.arange(first, first + self.count)
        return np.roll(order, self.count // 2) if self.sides == len(SIDES) else order

    def linear(
        self, rates: Rates, times: FloatArray, states: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Rates (K, m) of the lags in `states` (K, n), and their derivatives (K, m, m) by the lags.

        By unit differences: in attached flow the rates are linear in the lags, which stand last.
        """
        count = self.count
        own = slice(states.shape[1] - count, None)
        shifted = np.repeat(states[:, None], count + 1, axis=1)
        shifted[:, 1:, own] += np.eye(count)
        found = rates(np.repeat(times, count + 1), shifted.reshape(-1, states.shape[1]))[:, own]
        found = found.reshape(times.size, count + 1, count)
        return found[:, 0], np.asarray((found[:, 1:] - found[:, :1]).transpose(0, 2, 1))

    def settled(self, rates: FloatArray, slopes: FloatArray) -> FloatArray:
        """Lags (K, m) that would not change in motions that were steady.

        Of the rates (K, m) in the states `attached`, and their derivatives (K, m, m) by the lags.
        The shares stay attached: on these rates depend by a law that is not linear.
        """
        found = np.tile(self.attached, (len(rates), 1))
        lags = np.flatnonzero(self.attached == 0.0)
        if lags.size:
            own, change = slopes[:, lags[:, None], lags], rates[:, lags, None]
            found[:, lags] = -np.linalg.solve(own, change)[:, :, 0]
        return found


def wake_states(bird: Bird, sides: int) -> WakeStates:
    """The states of the air's memory about the wings of a bird.

    Raises:
        TopologyError: the air has a memory, and the wing's line is not smooth in time, or has too
            few elements to keep lags at; or it has none, and flow would separate.
        StateError: flow separates, and no lifting line fits the wing at t = 0.
    """
    numbers, points = bird.wing.resolved_discretisation, bird.air.wake_points
    if bird.air.wake == "quasi-steady":
        if bird.stalls:
            raise TopologyError(
                f"{bird.name}: profiles with a polar or stall need air that remembers how far flow "
                'has separated; take air.wake = "unsteady".'
            )
        return WakeStates(no_wake_lags(numbers.elements), sides)
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
    lags = wake_lags(numbers.elements, points)
    if bird.stalls:
        lags = lags._replace(separation=_separation(bird, lags))
    return WakeStates(lags, sides)


def without_memory(bird: Bird) -> Bird:
    """The bird in air without a memory, its flow attached."""
    own = {
        f"sections.{s.name}.profile.{key}": None
        for s in bird.sections
        if s.profile
        for key in ("polar", "stall")
    }
    of_wing = {"wing.profile.polar": None, "wing.profile.stall": None}
    return bird.with_values({"air.wake": "quasi-steady", **of_wing, **own})


def _separation(bird: Bird, lags: WakeLags) -> SeparationCurves:
    """Curves of separated flow at the elements of a bird's wing where lags are kept.

    Sections stand between those of the topology as they do with the drivers at t = 0.
    """
    numbers, profiles = bird.wing.resolved_discretisation, bird.profiles
    places = np.zeros(lags.kept.size)
    if len(set(profiles)) > 1:
        wing = wing_arrays(bird.side("right"))
        angles, rates, _ = driver_motion(wing, 0.0)
        order = np.zeros((len(profiles), 3))
        order[:, 0] = np.arange(len(profiles))
        # In place of the profiles, which go from section to section as these numbers do.
        numbered = wing._replace(profile=order)
        shape = wing_shape(
            numbered, angles, rates, numbers.elements, numbers.rounding, published=False
        )
        if not shape.converged:
            raise lifting_line_lost(bird, 0.0, angles)
        places = shape.profile[lags.kept, 0]
    else:
        profiles = profiles[:1]
    return separation_curves(profiles, places, lags.kept, numbers.elements)
