"""A Fourier series through samples of an angle over a beat, and what it leaves of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from birdmb._typing import FloatArray

# Largest residual, in parts of the samples' range, at which no more harmonics are taken.
_CLOSE_ENOUGH = 1e-3
_INSTANTS_PER_PERIOD = 16  # of the highest harmonic
# Of continuous functions with kinks, whose harmonics fall with the square of their order.
_SLOWEST_FALL = 0.5


class DriverFit(NamedTuple):
    """How closely a Fourier series follows the samples it was made of; angles in rad."""

    harmonics: int
    """How many are kept."""
    rms_residual: float
    largest_residual: float
    truncation: float
    """Estimate of the largest distance from the function that was sampled."""


class SampledSeries(NamedTuple):
    """Mean, and cosine and sine coefficients (K, 2), of a series through samples, rad."""

    mean: float
    series: FloatArray
    fit: DriverFit


def even_phases(count: int) -> tuple[float, ...]:
    """Phases of samples at equal distances over a beat, its end excluded."""
    return tuple(i / count for i in range(count))


def harmonics_within(phases: Sequence[float]) -> int:
    """How many harmonics samples at these ascending phases determine safely, whatever they are.

    As many as have two samples or more in each period even in the widest gap: least squares with
    weights are then well conditioned (Gröchenig, Linear Algebra and its Applications 193, 1993).
    """
    widest = max(np.diff([*phases, phases[0] + 1.0]))
    return max(0, math.ceil(0.5 / widest - 1e-9) - 1)


def series_through(
    samples: tuple[float, ...], phases: tuple[float, ...], harmonics: int | None
) -> SampledSeries:
    """Least-squares series through `samples` (N,) at `phases` (N,), parts of a beat, ascending.

    Each sample weighs as much as the part of the beat that it stands for. `harmonics` are kept, or
    by default as few as leave a largest residual below 0.1 % of the samples' range.
    """
    values, most = np.array(samples), harmonics_within(phases)
    weight = _weights(np.array(phases))
    basis = series_basis(np.array(phases), most)
    # Columns in the order of the harmonics: the first 2 K + 1 of them solve for K harmonics.
    q, r = np.linalg.qr(basis * weight[:, None])
    part = q.T @ (values * weight)
    left = values * weight - np.cumsum(q * part, axis=1)[:, ::2].T
    residuals = np.abs(left / weight)  # (1 + most, N), by the number of harmonics
    if harmonics is None:
        close = np.nonzero(residuals[1:].max(axis=1) <= _CLOSE_ENOUGH * (np.ptp(values) or 1.0))[0]
        harmonics = 1 + int(close[0]) if close.size else most
    size = 2 * harmonics + 1
    kept = np.linalg.solve(r[:size, :size], part[:size])
    every = np.linalg.solve(r, part)
    fit = DriverFit(
        harmonics,
        float(np.sqrt(np.mean(residuals[harmonics] ** 2))),
        float(residuals[harmonics].max()),
        _truncation(kept, every, float(residuals[harmonics].max())),
    )
    return SampledSeries(float(kept[0]), kept[1:].reshape(-1, 2), fit)


def _weights(phases: FloatArray) -> FloatArray:
    """Square roots of the parts of a beat, times their number, that the samples stand for."""
    after = np.diff([*phases, phases[0] + 1.0])
    return np.sqrt(0.5 * phases.size * (after + np.roll(after, 1)))


def series_basis(phases: FloatArray, harmonics: int) -> FloatArray:
    """1, cos, sin, cos of twice the argument and so on, (N, 2 H + 1), at `phases` (N,) in beats."""
    basis = np.ones((phases.size, 2 * harmonics + 1))
    argument = 2.0 * np.pi * phases[:, None] * np.arange(1, harmonics + 1)
    basis[:, 1::2], basis[:, 2::2] = np.cos(argument), np.sin(argument)
    return basis


def _truncation(kept: FloatArray, every: FloatArray, residual: float) -> float:
    """Estimate of the largest distance from the sampled function.

    What the samples tell of the harmonics that are left out, and a tail of those beyond.
    """
    left_out = every.copy()
    left_out[: kept.size] -= kept
    most = every.size // 2
    instants = np.arange(_INSTANTS_PER_PERIOD * most) / (_INSTANTS_PER_PERIOD * most)
    seen = float(np.abs(series_basis(instants, most) @ left_out).max())
    return max(residual, seen) + _tail(np.hypot(every[1::2], every[2::2]))


def _tail(sizes: FloatArray) -> float:
    """Estimate of the sum of all amplitudes beyond the known ones (K,).

    They fall from octave to octave by a constant factor where they fall as a power of the order;
    where they fall faster, as those of analytic functions, the estimate is too large.
    """
    half = sizes.size // 2
    last, before = (float(part.sum()) for part in (sizes[half:], sizes[half // 2 : half]))
    fall = last / before if last < _SLOWEST_FALL * before else _SLOWEST_FALL
    return last * fall / (1.0 - fall)
