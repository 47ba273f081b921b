"""Wingbeats: their frequency, and a Fourier series through whatever samples there are."""

from __future__ import annotations

import numpy as np
from scipy.optimize import minimize_scalar

from birdmb._typing import FloatArray
from birdmb.kinematics.errors import KinematicsError
from birdmb.topology.samples import harmonics_within, series_basis

_SIGNALS = 6  # that move most
_HARMONICS = 3
_PERIODIC = 0.5  # part of the motion that a beat must explain
_WORSE = 0.02  # part that a shorter beat may leave out and still be taken
_FINER = 4  # candidates per resolved frequency
_MULTIPLES = (1.0 / 3.0, 0.5, 1.0, 2.0)
_STILL = 1e-6
_LEAST_SAMPLES = 0.3  # of the frames, in a signal that tells the frequency


def most_harmonics(phases: FloatArray) -> int:
    """How many harmonics samples at `phases` (N,), in beats, of any order, determine safely."""
    return harmonics_within(np.sort(np.mod(phases, 1.0)).tolist()) if phases.size else 0


def beat_frequency(times: FloatArray, values: FloatArray, origin: str) -> float:
    """The frequency (Hz) at which signals (N, R) of order 1, NaN in gaps, repeat themselves.

    A peak of the spectrum, refined by least squares of a Fourier series to the samples; of
    frequencies that explain the motion as well, the highest.

    Raises:
        KinematicsError: they are not periodic, or last less than a beat.
    """
    signals = _moving_most(values)
    span = float(times[-1] - times[0])
    if signals.shape[1] == 0:
        raise KinematicsError(f"{origin}: nothing moves in it, so that there is no wingbeat.")
    peak = _spectral_peak(times, signals)
    tried = [
        _refined(times, signals, factor * peak, 1.0 / span)
        for factor in _MULTIPLES
        if factor * peak * span > 0.4
    ]
    best = max(explained for _, explained in tried)
    frequency = max(f for f, explained in tried if explained >= best - _WORSE)
    if frequency * span < 1.0:
        raise KinematicsError(
            f"{origin}: its {span:.3g} s hold less than one beat; if the frequency is known, say "
            "it (--frequency)."
        )
    if best < _PERIODIC:
        raise KinematicsError(
            f"{origin}: no periodic motion is found; a beat of {1.0 / frequency:.3g} s explains "
            f"{100.0 * best:.0f} % of it."
        )
    return frequency


def _moving_most(values: FloatArray) -> FloatArray:
    enough = np.isfinite(values).mean(axis=0) > _LEAST_SAMPLES
    kept = values[:, enough]
    spread = np.nanstd(kept, axis=0) if kept.size else np.empty(0)
    moving = np.argsort(-spread)[:_SIGNALS]
    return kept[:, moving[spread[moving] > _STILL]]


def _spectral_peak(times: FloatArray, signals: FloatArray) -> float:
    """Where the power of all signals is largest, interpolated linearly over gaps, Hz."""
    even = np.linspace(times[0], times[-1], max(len(times), 64))
    power = np.zeros(_FINER * even.size // 2 + 1)
    for signal in signals.T:
        there = np.isfinite(signal)
        level = np.interp(even, times[there], signal[there])
        power += np.abs(np.fft.rfft(level - level.mean(), n=_FINER * even.size)) ** 2
    frequencies = np.fft.rfftfreq(_FINER * even.size, even[1] - even[0])
    possible = frequencies * (times[-1] - times[0]) > 0.4
    return float(frequencies[possible][np.argmax(power[: possible.size][possible])])


def _refined(
    times: FloatArray, signals: FloatArray, guess: float, resolution: float
) -> tuple[float, float]:
    """A frequency near a guess, and which part of the signals' variance it explains."""

    def unexplained(frequency: float) -> float:
        phases = frequency * (times - times.mean())
        left = whole = 0.0
        for signal in signals.T:
            there = np.isfinite(signal)
            fit = min(_HARMONICS, most_harmonics(phases[there]))
            basis = series_basis(phases[there], fit)
            solved = np.linalg.lstsq(basis, signal[there], rcond=1e-10)[0]
            left += float(np.sum((signal[there] - basis @ solved) ** 2))
            whole += float(np.sum((signal[there] - signal[there].mean()) ** 2))
        return left / whole if whole > 0.0 else 1.0

    reach = np.linspace(-0.5, 0.5, 9) * resolution
    tried = [unexplained(f) if f > 0.0 else 1.0 for f in guess + reach]
    centre = float(guess + reach[int(np.argmin(tried))])
    step = float(reach[1] - reach[0])
    low = max(centre - step, 1e-3 * resolution)
    found = minimize_scalar(unexplained, bounds=(low, centre + step), method="bounded")
    return float(found.x), 1.0 - float(found.fun)
