"""The lags of a moving wing: those that repeat themselves, and those of a start."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.sparse.linalg import LinearOperator, gmres

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError
from birdmb.orbits.integration import Integration

_PERIODIC = 1e-12
_MOST_ITERATIONS = 200
_INTEGRATION = Integration("LSODA", 1e-9, 100_000)

# Of separated flow, whose states are known no better.
_ROUGH, _SETTLED, _MOST_PERIODS = Integration("LSODA", 1e-7, 100_000), 1e-6, 60

# Rates (n,) at a time of lags (n,).
Rates = Callable[[float, FloatArray], FloatArray]


def periodic_lags(slopes: FloatArray, drive: FloatArray, period: float) -> FloatArray:
    """Periodic solution (K, n) of x' = slopes x + drive, from both at K even instants, K odd.

    By collocation with trigonometric polynomials and GMRES, preconditioned by the system with the
    mean of the slopes, which is solved harmonic by harmonic.

    Raises:
        ArgumentError: the instants are too few for the motion.
    """
    count, n = drive.shape
    rates = 2j * np.pi / period * np.fft.rfftfreq(count, 1.0 / count)
    varying = slopes - slopes.mean(axis=0)
    mean = np.linalg.inv(rates[:, None, None] * np.eye(n) - slopes.mean(axis=0))

    def nearly(values: FloatArray) -> FloatArray:
        """Solution (K, n) with the mean slopes, of the drive `values` (K, n)."""
        harmonics = np.fft.rfft(values, axis=0)
        return np.fft.irfft((mean @ harmonics[:, :, None])[:, :, 0], count, axis=0)

    def applied(values: FloatArray) -> FloatArray:
        lags = values.reshape(count, n)
        return (lags - nearly((varying @ lags[:, :, None])[:, :, 0])).ravel()

    operator = LinearOperator((count * n, count * n), applied, dtype=float)
    found, failed = gmres(
        operator, nearly(drive).ravel(), rtol=_PERIODIC, restart=_MOST_ITERATIONS, maxiter=1
    )
    if failed:
        raise ArgumentError(
            f"the wake's periodic state was not found with {count} instants a period; take more."
        )
    return np.asarray(found.reshape(count, n))


def settled_lags(
    rates: Rates, start: FloatArray, instants: FloatArray, period: float
) -> FloatArray:
    """Lags (K, n) at the instants (K,) s of a period, once they repeat themselves.

    From a `start` (n,), by as many periods as that takes.

    Raises:
        ArgumentError: they do not settle.
        StateError: the integration fails.
    """
    scale = 1e-3 * _ROUGH.rtol * np.ones(start.size)
    times = np.append(instants, instants[0] + period)
    for _ in range(_MOST_PERIODS):
        found = _ROUGH.run(rates, start, float(times[0]), float(times[-1]), scale, times)
        if np.abs(found[-1] - start).max() < _SETTLED * np.abs(found).max():
            return found[:-1]
        start = found[-1]
    raise ArgumentError(
        f"the separated flow does not repeat itself after {_MOST_PERIODS} periods; give times, "
        "for a motion that starts."
    )


def lags_of_start(rates: Rates, start: FloatArray, times: FloatArray) -> FloatArray:
    """Solution (K, n) at ascending `times` (K,) s, from a `start` (n,) at the first of them.

    Raises:
        StateError: the integration fails.
    """
    scale = 1e-3 * _INTEGRATION.rtol * np.ones(start.size)
    return _INTEGRATION.run(rates, start, float(times[0]), float(times[-1]), scale, times)
