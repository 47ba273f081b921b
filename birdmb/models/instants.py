"""What time alone determines of a bird's wing, kept for all who ask for the same instants."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from birdmb._typing import FloatArray
from birdmb.aerodynamics.prescribed import driven
from birdmb.models.exudyn_tree import BODY_COORDINATES
from birdmb.models.failures import lifting_line_lost
from birdmb.topology import Bird
from birdmb.wing.arrays import WingArrays
from birdmb.wing.shape import WingShape, wing_shape
from birdmb.wing.stacked import StackedShapes, stacked_shapes

_INSTANTS_KEPT = 8192


class Instant(NamedTuple):
    """What an instant alone determines; its arrays are shared and must not be written to."""

    angles: FloatArray  # (A,) rad, of the drivers
    rates: FloatArray  # (A,) rad/s
    accelerations: FloatArray  # (n,) of the drivers, 0 for the body
    shape: WingShape | None  # with the joints that turn the wing as a whole at zero


class StackedInstants(NamedTuple):
    """What P instants determine, as `Instant`, each array stacked along a first axis."""

    angles: FloatArray  # (P, A)
    rates: FloatArray  # (P, A)
    accelerations: FloatArray  # (P, n)
    shapes: StackedShapes | None


@lru_cache(maxsize=2)
def _kept(_key: tuple[object, ...]) -> dict[float, Instant]:
    """The instants made so far, by time (s), of all birds with the same wing and drivers."""
    return {}


class Instants:
    """Drivers and shape of a wing at any time.

    Kept, for every trajectory and every perturbation of it asks for the same instants again, as do
    birds that differ in masses, springs and dampers alone.

    Args:
        bird: the bird.
        wing: its wing.
        discretisation: elements, rounding and whether the line is the published one.
        turning: how many joints at the shoulder turn the wing as a whole; with none, no shape is
            made.
    """

    def __init__(
        self, bird: Bird, wing: WingArrays, discretisation: tuple[int, float, bool], turning: int
    ) -> None:
        self._bird, self._wing = bird, wing
        self._discretisation, self._turning = discretisation, turning
        parts = (np.asarray(part) for part in wing)
        self._kept = _kept((turning, discretisation, *((p.shape, p.tobytes()) for p in parts)))

    def stacked(self, times: FloatArray) -> StackedInstants:
        """What `times` (P,) s determine."""
        each = [self.at(t) for t in times.tolist()]
        shapes = [instant.shape for instant in each if instant.shape is not None]
        return StackedInstants(
            np.array([instant.angles for instant in each]),
            np.array([instant.rates for instant in each]),
            np.array([instant.accelerations for instant in each]),
            stacked_shapes(shapes) if shapes else None,
        )

    def at(self, t: float) -> Instant:
        """What time t (s) determines; raises `StateError` if no lifting line fits the wing."""
        instant = self._kept.get(t)
        if instant is None:
            if len(self._kept) >= _INSTANTS_KEPT:
                self._kept.clear()
            instant = self._kept[t] = self._made(t)
        return instant

    def shape(self, t: float, angles: FloatArray, rates: FloatArray) -> WingShape:
        """The wing at t (s) and these angles and rates (A,), the joints that turn it left at zero.

        Raises `StateError` if no lifting line fits it.
        """
        moving = np.arange(angles.size) >= self._turning
        shape = wing_shape(self._wing, moving * angles, moving * rates, *self._discretisation)
        if not shape.converged:
            raise lifting_line_lost(self._bird, t, angles)
        return shape

    def _made(self, t: float) -> Instant:
        angles, rates, accelerations = driven(self._wing, t)
        shape = self.shape(t, angles, rates) if self._turning else None
        of_tree = np.concatenate([np.zeros(BODY_COORDINATES), accelerations, accelerations])
        for shared in (angles, rates, of_tree):
            shared.flags.writeable = False
        return Instant(angles, rates, of_tree, shape)
