"""A gust along the axes of the bird's body, as a gust in the world that follows its attitude."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.interpolate import make_interp_spline

from birdmb._typing import FloatArray
from birdmb.models import Gust
from birdmb.models.gusts import velocity_of
from birdmb.models.motion import Motion, heading_velocity

GustAxes = Literal["world", "body"]


@dataclass(frozen=True)
class BodyGust:
    """A gust whose velocities are along the axes of a body of known attitude.

    Attributes:
        gust: velocities (m/s) along x, against z and along y of the body.
        attitude: the body's states in space (8,) at a time (s).
    """

    gust: Gust
    attitude: Callable[[float], FloatArray]

    @property
    def discontinuities(self) -> tuple[float, ...]:
        """Those of the gust."""
        return tuple(getattr(self.gust, "discontinuities", ()))

    def __call__(self, t: float) -> tuple[float, float, float]:
        """Velocity (m/s) at t (s) in the world, forwards, upwards and to the right."""
        moving = np.array(self.attitude(t))
        moving[:3] = velocity_of(self.gust, t)
        forward, right, up = heading_velocity(moving[None])[0]
        return float(forward), float(up), float(right)


def attitude_along(
    times: FloatArray, states: FloatArray, motion: Motion
) -> Callable[[float], FloatArray]:
    """States in space (8,) at a time, of states (K, n) at `times` (K,) s, by cubic splines.

    Those that are NaN, after a flight has ended, are as the last ones before.
    """
    reached = np.isfinite(states).all(axis=1)
    known = times[reached]
    space = motion.in_space(states[reached])
    if known.size == 1:
        return lambda _t: np.array(space[0])
    spline = make_interp_spline(known, space, k=min(3, known.size - 1))
    return lambda t: np.asarray(spline(min(t, float(known[-1]))))
