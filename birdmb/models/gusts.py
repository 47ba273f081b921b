"""Gusts: the velocity of the air in the world as a function of time, uniform in space."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

Gust: TypeAlias = Callable[[float], tuple[float, float]]
"""Velocity of the air (m/s) at a time (s): horizontal (forwards positive, a tail wind), upwards.

One with steps or kinks names their times (s) as its attribute `breaks`.
"""


@dataclass(frozen=True)
class GaussianGust:
    """A gust that rises and falls like exp(-((t - time)/width)^2/2).

    Attributes:
        vertical: largest upwards velocity, m/s.
        horizontal: largest forwards velocity, m/s.
        time: when it is strongest, s; as in the thesis, chapter 6.
        width: standard deviation, s.
    """

    vertical: float = 0.0
    horizontal: float = 0.0
    time: float = 0.25
    width: float = 0.05

    def __call__(self, t: float) -> tuple[float, float]:
        """Velocity (m/s) at t (s), forwards and upwards."""
        part = float(np.exp(-0.5 * ((t - self.time) / self.width) ** 2))
        return self.horizontal * part, self.vertical * part


@dataclass(frozen=True)
class CosineGust:
    """The 1-cosine gust of airworthiness codes: (1 - cos(2 pi (t - start)/duration))/2, once.

    Attributes:
        vertical: largest upwards velocity, m/s.
        horizontal: largest forwards velocity, m/s.
        start: when it begins, s.
        duration: how long it lasts, s.
    """

    vertical: float = 0.0
    horizontal: float = 0.0
    start: float = 0.0
    duration: float = 0.25

    @property
    def breaks(self) -> tuple[float, ...]:
        """Times (s) of its beginning and end, where its curvature jumps."""
        return self.start, self.start + self.duration

    def __call__(self, t: float) -> tuple[float, float]:
        """Velocity (m/s) at t (s), forwards and upwards."""
        phase = (t - self.start) / self.duration
        part = 0.5 * (1.0 - float(np.cos(2.0 * np.pi * phase))) if 0.0 < phase < 1.0 else 0.0
        return self.horizontal * part, self.vertical * part


@dataclass(frozen=True)
class StepGust:
    """Air that moves steadily from a time on.

    Attributes:
        vertical: upwards velocity from then on, m/s.
        horizontal: forwards velocity from then on, m/s.
        start: when it begins, s.
    """

    vertical: float = 0.0
    horizontal: float = 0.0
    start: float = 0.0

    @property
    def breaks(self) -> tuple[float, ...]:
        """Time (s) of the step."""
        return (self.start,)

    def __call__(self, t: float) -> tuple[float, float]:
        """Velocity (m/s) at t (s), forwards and upwards."""
        part = 1.0 if t >= self.start else 0.0
        return self.horizontal * part, self.vertical * part
