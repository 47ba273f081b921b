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

# x' = slopes x + drive at a time, slopes (n, n) 1/s.
Linear = Callable[[float], tuple[FloatArray, FloatArray]]


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


def lags_of_start(linear: Linear, times: FloatArray) -> FloatArray:
    """Solution (K, n) at ascending `times` (K,) s, from none at the first of them.

    Raises:
        StateError: the integration fails.
    """
    slopes, _ = linear(float(times[0]))

    def rates(t: float, x: FloatArray) -> FloatArray:
        matrix, drive = linear(t)
        return np.asarray(matrix @ x + drive)

    n = len(slopes)
    scale = 1e-3 * _INTEGRATION.rtol * np.ones(n)
    return _INTEGRATION.run(rates, np.zeros(n), float(times[0]), float(times[-1]), scale, times)
