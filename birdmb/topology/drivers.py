"""The law of a joint's driver: a Fourier series over the beat, whatever keys it is given by."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Annotated, ClassVar, NamedTuple, Self

import numpy as np
from pydantic import Field, Strict, model_validator

from birdmb._typing import FloatArray
from birdmb.topology.messages import problem
from birdmb.topology.numbers import Angle, Order, Phase
from birdmb.topology.parts import Part
from birdmb.topology.samples import DriverFit, even_phases, harmonics_within, series_through

_FEWEST_SAMPLES, _MOST_SAMPLES = 3, 1000
_ROUND_OFF = 1e-17
_STILL = 1e-13  # rad
_MOST_OF_A_STROKE = 30  # harmonics of uneven strokes; that of order 20 is below round-off
_INSTANTS = 256
_INSTANTS_PER_PERIOD = 32  # of the highest harmonic


class Harmonic(Part):
    """A higher harmonic of a driver: amplitude sin(m w t + phase), or its cosine and sine parts."""

    angles: ClassVar[tuple[str, ...]] = ("amplitude", "phase", "cosine", "sine")

    order: Order = Field(description="how many periods a beat has, 1 or more")
    amplitude: Angle | None = Field(
        default=None, description="amplitude; rad, degrees as amplitude_deg"
    )
    phase: Angle | None = Field(
        default=None, description="phase at t = 0; rad, degrees as phase_deg"
    )
    cosine: Angle | None = Field(
        default=None, description="factor of cos(m w t); rad, degrees as cosine_deg"
    )
    sine: Angle | None = Field(
        default=None, description="factor of sin(m w t); rad, degrees as sine_deg"
    )

    @model_validator(mode="after")
    def _is_given_one_way(self) -> Self:
        parts = [key for key in ("cosine", "sine") if getattr(self, key) is not None]
        if parts and (self.amplitude is not None or self.phase is not None):
            other = "phase" if self.amplitude is None else "amplitude"
            raise problem(f"{other} and {parts[0]} do not go together; keep one way", parts[0])
        if not parts and self.amplitude is None:
            raise problem("missing; a harmonic needs an amplitude, or cosine or sine", "amplitude")
        return self

    @property
    def parts(self) -> tuple[float, float]:
        """Factors of cos(m w t) and sin(m w t), rad."""
        if self.amplitude is None:
            return self.cosine or 0.0, self.sine or 0.0
        return _parts(self.amplitude, self.phase or 0.0)


@dataclass(frozen=True)
class Driver:
    """The motion of a driver: mean + sum over k of cosine_k cos(k w t) + sine_k sin(k w t).

    Attributes:
        mean: mean angle, rad.
        cosine, sine: coefficients (K) of the harmonics 1 to K, rad; none where it stands still.
        fit: how closely they follow the samples, if it was given by samples.
    """

    mean: float
    cosine: tuple[float, ...] = ()
    sine: tuple[float, ...] = ()
    fit: DriverFit | None = None

    @property
    def amplitudes(self) -> FloatArray:
        """Amplitudes (K,) of the harmonics, rad."""
        return np.hypot(self.cosine, self.sine)

    @property
    def is_still(self) -> bool:
        """Whether the angle is its mean at all times, but for round-off."""
        return not (self.amplitudes > _STILL).any()

    @property
    def is_one_sine(self) -> bool:
        """Whether there is no other harmonic than the first one."""
        return not any(self.cosine[1:]) and not any(self.sine[1:])

    def at(self, phases: FloatArray) -> FloatArray:
        """Angles (P,), rad, at `phases` (P,), parts of a beat."""
        argument = 2.0 * np.pi * np.outer(phases, np.arange(1, len(self.cosine) + 1))
        swing = np.cos(argument) @ np.array(self.cosine) + np.sin(argument) @ np.array(self.sine)
        return np.asarray(self.mean + swing)

    @property
    def range(self) -> tuple[float, float]:
        """Smallest and largest angle over a beat, rad, to half a percent of the last harmonic."""
        count = max(_INSTANTS, _INSTANTS_PER_PERIOD * len(self.cosine))
        angles = self.at(np.arange(count) / count)
        return float(angles.min()), float(angles.max())

    def highest_harmonic(self, part: float) -> int:
        """Order of the highest harmonic whose rate is at least this part of the largest one's."""
        rates = self.amplitudes * np.arange(1, len(self.cosine) + 1)
        return 0 if self.is_still else int(np.nonzero(rates >= part * rates.max())[0][-1]) + 1


class DriverKeys(NamedTuple):
    """The values of a joint's keys that say how its driver moves."""

    offset: float
    amplitude: float
    phase: float
    gain: float
    harmonics: tuple[Harmonic, ...]
    downstroke_fraction: float | None
    samples: tuple[float, ...] | None
    sample_phases: tuple[float, ...] | None
    sample_harmonics: int | None


@lru_cache(maxsize=256)
def driver_of(keys: DriverKeys) -> Driver:
    """The motion that keys say which do not contradict each other, see `contradictions`."""
    mean, fit = keys.offset, None
    if keys.samples is not None:
        phases = keys.sample_phases or even_phases(len(keys.samples))
        sampled = series_through(keys.samples, phases, keys.sample_harmonics)
        mean, series, fit = mean + sampled.mean, sampled.series, sampled.fit
    elif keys.downstroke_fraction is not None:
        series = _uneven(keys.amplitude, keys.phase, keys.downstroke_fraction)
    else:
        series = np.zeros((max((1, *(harmonic.order for harmonic in keys.harmonics))), 2))
        series[0] = _parts(keys.amplitude, keys.phase)
        for harmonic in keys.harmonics:
            series[harmonic.order - 1] += harmonic.parts
    cosine, sine = (keys.gain * series.T).tolist()
    return Driver(mean, tuple(cosine), tuple(sine), fit)


def _parts(amplitude: float, phase: float) -> tuple[float, float]:
    return amplitude * math.sin(phase), amplitude * math.cos(phase)


def _uneven(amplitude: float, phase: float, downstroke: float) -> FloatArray:
    """Coefficients (K, 2) of -amplitude sin(tau + b sin(tau)), tau = w t + phase - pi.

    tau is zero in the middle of the downstroke, whose ends are at tau = -+ pi d, where the argument
    is -+ pi/2. Jacobi and Anger: sin(tau + b sin(tau)) is the sum of J_{m-1}(b) + (-1)^m J_{m+1}(b)
    times sin(m tau), which falls faster than any power of m.
    """
    from scipy.special import jv  # noqa: PLC0415 - few birds need it, and all would wait for it

    b = math.pi * (0.5 - downstroke) / math.sin(math.pi * downstroke)
    orders = np.arange(1, _MOST_OF_A_STROKE + 1)
    sizes = jv(orders - 1, b) + (-1.0) ** orders * jv(orders + 1, b)
    sizes = -amplitude * sizes[: int(np.nonzero(np.abs(sizes) > _ROUND_OFF)[0][-1]) + 1]
    shift = orders[: sizes.size] * (phase - math.pi)
    return np.column_stack([sizes * np.sin(shift), sizes * np.cos(shift)])


def contradictions(keys: DriverKeys) -> Iterator[tuple[str, str]]:
    """What does not go together among the keys of a driver: the key to blame and a sentence."""
    yield from _exclusive(keys)
    orders = [harmonic.order for harmonic in keys.harmonics]
    for order in orders:
        if orders.count(order) > 1:
            yield "harmonics", f"order {order} is given twice; keep one"
    if 1 in orders and keys.amplitude:
        yield (
            "harmonics",
            "order 1 and amplitude do not go together; amplitude is that of order 1, keep one",
        )
    if keys.samples is not None:
        yield from _on_samples(keys.samples, keys.sample_phases, keys.sample_harmonics)


def _exclusive(keys: DriverKeys) -> Iterator[tuple[str, str]]:
    if keys.samples is None:
        for key in ("sample_phases", "sample_harmonics"):
            if getattr(keys, key) is not None:
                yield key, f"{key} without samples says nothing; give samples, or leave it out"
    else:
        for key in ("amplitude", "phase", "harmonics", "downstroke_fraction"):
            if getattr(keys, key):
                yield (
                    key,
                    f"{key} and samples do not go together; samples give the whole motion, to "
                    "which only offset is added, and which gain enlarges",
                )
    if keys.downstroke_fraction is not None and keys.harmonics:
        yield (
            "downstroke_fraction",
            "downstroke_fraction and harmonics do not go together; it shapes amplitude and phase "
            "alone",
        )


def _on_samples(
    samples: tuple[float, ...], phases: tuple[float, ...] | None, harmonics: int | None
) -> Iterator[tuple[str, str]]:
    count = len(samples)
    if not _FEWEST_SAMPLES <= count <= _MOST_SAMPLES:
        yield "samples", f"must be {_FEWEST_SAMPLES} to {_MOST_SAMPLES} angles, not {count}"
        return
    if phases is not None:
        if len(phases) != count:
            yield "sample_phases", f"must be as many as samples, {count}, not {len(phases)}"
            return
        if not all(a < b for a, b in pairwise(phases)):
            yield "sample_phases", "must ascend, each phase beyond the one before"
            return
    most = harmonics_within(phases or even_phases(count))
    if most == 0:
        yield "sample_phases", "leave half of the beat or more without samples; spread them"
    elif harmonics is not None and harmonics > most:
        yield (
            "sample_harmonics",
            f"must be {most} or less, not {harmonics}; the samples determine no more",
        )


Samples = tuple[Angle, ...]
SamplePhases = tuple[Phase, ...]
Harmonics = tuple[Harmonic, ...]
Count = Annotated[int, Strict(), Field(ge=1)]
