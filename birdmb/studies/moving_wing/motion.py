"""How a wing moves in a stream: heaving, pitching and flapping, each a Fourier series."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError
from birdmb.summary import Summarised

Series = Sequence[complex]


class Course(NamedTuple):
    """Values, rates and accelerations (K,) of one motion at K instants."""

    value: FloatArray
    rate: FloatArray
    acceleration: FloatArray


@checked
@dataclass(frozen=True, repr=False)
class WingMotion(Summarised):
    """Periodic heaving, pitching and flapping of a wing.

    Each is given by complex amplitudes a_0, a_1, ... of the series Re(sum over m of
    a_m exp(2 pi i m f t)): `[0, 0.06]` is 0.06 cos(2 pi f t), `[0.1, -0.4j]` is
    0.1 + 0.4 sin(2 pi f t). The wing pitches about an axis across the stream, which heaves with it,
    and flaps about one along its own root chord.

    Attributes:
        frequency: f, Hz.
        heave: upwards, m.
        pitch: nose up, rad.
        flap: wing up, rad.
        pitch_axis: part of the root's chord that the axis is behind the leading edge.
    """

    frequency: float = 1.0
    heave: Series = (0.0,)
    pitch: Series = (0.0,)
    flap: Series = (0.0,)
    pitch_axis: float = 0.25

    def __post_init__(self) -> None:
        """Check the frequency and the series.

        Raises:
            ArgumentError: the frequency is not positive, or a series has no terms or some that are
                not finite.
        """
        if not 0.0 < self.frequency < np.inf:
            raise ArgumentError(f"the frequency must be positive, in Hz, not {self.frequency}.")
        for name in ("heave", "pitch", "flap"):
            series = np.asarray(getattr(self, name))
            if series.ndim != 1 or series.size == 0 or not np.isfinite(series).all():
                raise ArgumentError(
                    f"{name} must be a series of one or more finite complex amplitudes."
                )

    @property
    def period(self) -> float:
        """1/f, s."""
        return 1.0 / self.frequency

    @property
    def highest_harmonic(self) -> int:
        """Order of the last term of the longest series."""
        return max(len(self.heave), len(self.pitch), len(self.flap)) - 1

    def course(self, series: Series, times: FloatArray) -> Course:
        """One of the motions at `times` (K,) s."""
        rate = 2.0j * np.pi * self.frequency * np.arange(len(series))
        terms = np.asarray(series) * np.exp(np.multiply.outer(times, rate))
        return Course(*(np.asarray((terms * rate**n).real.sum(axis=-1)) for n in range(3)))
