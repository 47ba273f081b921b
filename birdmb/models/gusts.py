"""Gusts: the velocity of the air in the world as a function of time, uniform in space."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError

Gust: TypeAlias = Callable[[float], Sequence[float]]
"""Velocity of the air (m/s) at a time (s): forwards (a tail wind), upwards, perhaps to the right.

Seen along the bird's heading, which to first order in the gust is that before it. One with steps or
kinks names their times (s) as its attribute `discontinuities`.
"""


def velocity_of(gust: Gust, t: float) -> FloatArray:
    """Velocity (3,) m/s of the air at t (s): forwards, to the right and down.

    Raises:
        ArgumentError: the gust gives neither two nor three velocities.
    """
    given = np.asarray(gust(t), dtype=float)
    if given.shape not in {(2,), (3,)}:
        raise ArgumentError(
            "a gust must return two or three velocities, in m/s: forwards, upwards, and to the "
            "right."
        )
    return np.array([given[0], given[2] if given.size == 3 else 0.0, -given[1]])


@checked
@dataclass(frozen=True)
class GaussianGust:
    """A gust that rises and falls like exp(-((t - time)/width)^2/2).

    Attributes:
        vertical: largest upwards velocity, m/s.
        horizontal: largest forwards velocity, m/s.
        time: when it is strongest, s.
        width: standard deviation, s.
        lateral: largest velocity to the right, m/s; in the plane of symmetry there is none.
    """

    vertical: float = 0.0
    horizontal: float = 0.0
    time: float = 0.25
    width: float = 0.05
    lateral: float = 0.0

    def __call__(self, t: float) -> tuple[float, float, float]:
        """Velocity (m/s) at t (s), forwards, upwards and to the right."""
        part = float(np.exp(-0.5 * ((t - self.time) / self.width) ** 2))
        return self.horizontal * part, self.vertical * part, self.lateral * part


@checked
@dataclass(frozen=True)
class CosineGust:
    """The 1-cosine gust of airworthiness codes: (1 - cos(2 pi (t - start)/duration))/2, once.

    Attributes:
        vertical: largest upwards velocity, m/s.
        horizontal: largest forwards velocity, m/s.
        start: when it begins, s.
        duration: how long it lasts, s.
        lateral: largest velocity to the right, m/s; in the plane of symmetry there is none.
    """

    vertical: float = 0.0
    horizontal: float = 0.0
    start: float = 0.0
    duration: float = 0.25
    lateral: float = 0.0

    @property
    def discontinuities(self) -> tuple[float, ...]:
        """Times (s) of its beginning and end, where its curvature jumps."""
        return self.start, self.start + self.duration

    def __call__(self, t: float) -> tuple[float, float, float]:
        """Velocity (m/s) at t (s), forwards, upwards and to the right."""
        phase = (t - self.start) / self.duration
        part = 0.5 * (1.0 - float(np.cos(2.0 * np.pi * phase))) if 0.0 < phase < 1.0 else 0.0
        return self.horizontal * part, self.vertical * part, self.lateral * part


@checked
@dataclass(frozen=True)
class StepGust:
    """Air that moves steadily from a time on.

    Attributes:
        vertical: upwards velocity from then on, m/s.
        horizontal: forwards velocity from then on, m/s.
        start: when it begins, s.
        lateral: velocity to the right from then on, m/s; in the plane of symmetry there is none.
    """

    vertical: float = 0.0
    horizontal: float = 0.0
    start: float = 0.0
    lateral: float = 0.0

    @property
    def discontinuities(self) -> tuple[float, ...]:
        """Time (s) of the step."""
        return (self.start,)

    def __call__(self, t: float) -> tuple[float, float, float]:
        """Velocity (m/s) at t (s), forwards, upwards and to the right."""
        part = 1.0 if t >= self.start else 0.0
        return self.horizontal * part, self.vertical * part, self.lateral * part
