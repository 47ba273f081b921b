"""Standard errors of a fitted gait, and how much the beats differ from each other."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from birdmb._typing import FloatArray
from birdmb.kinematics.series import Solved

_FEWEST_BEATS = 2
_LEAST_PART = 0.5  # of the samples that a beat has on average
_LEAST_KNOWN = 1e-3  # of the mean information, which a beat's own is added to
_UNKNOWN_PHASE = math.pi / math.sqrt(3.0)  # standard deviation of a phase that may be any


class ErrorBars(NamedTuple):
    """Errors and scatter of a gait.

    The covariance is that of independent samples, enlarged for joints whose beats differ by more
    than it allows (Birge, Phys. Rev. 40, 1932).
    """

    covariance: FloatArray  # (p, p) of the unknowns, the last is frequency times span
    scatter: FloatArray  # (joints,) rms of the beats' angles from their mean, rad; NaN of one beat
    beats: int


def error_bars(solved: Solved, times: FloatArray) -> ErrorBars:
    """The errors of the unknowns, and the scatter over the whole beats in `times` (N,)."""
    white = np.linalg.pinv(solved.information, hermitian=True) * solved.variance
    gait = solved.gait
    rows, _ = gait.unknowns
    joints = len(gait.joints)
    deviations, variances = _of_beats(solved, times)
    factors, scatter = np.ones(joints), np.full(joints, np.nan)
    beats = len(deviations)
    if beats >= _FEWEST_BEATS:
        for joint in range(joints):
            own = np.flatnonzero(rows == joint)
            off = deviations[:, own]
            block = variances[:, own[:, None], own]
            misfit = float(np.sum(off * np.linalg.solve(block, off[:, :, None])[:, :, 0]))
            freedom = (beats - 1) * own.size
            factors[joint] = max(1.0, misfit / freedom)
            halves = np.where(np.arange(own.size) == 0, 1.0, 0.5)
            scatter[joint] = math.sqrt(np.sum(halves * off**2) / (beats - 1))
    enlarge = np.sqrt(np.append(factors[rows], factors.max()))
    return ErrorBars(np.asarray(white * np.outer(enlarge, enlarge)), scatter, beats)


def _of_beats(solved: Solved, times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Deviations (B, p) of whole beats from the mean one, and their covariances (B, p, p)."""
    phases = solved.gait.phases(times)
    number = np.floor(phases - phases[0]).astype(np.int64)
    whole = int(np.floor(phases[-1] - phases[0] + 0.5 / max(1, len(phases))))
    slopes = solved.slopes[:, :, :-1]
    size = slopes.shape[2]
    information = solved.information[:-1, :-1]
    deviations, variances = [], []
    for beat in range(whole):
        inside = number == beat
        if inside.sum() < _LEAST_PART * len(times) / max(1, whole):
            continue
        own = slopes[inside].reshape(-1, size)
        known = own.T @ own
        # A gap in one beat must not make it the worst one.
        inverse = np.linalg.inv(known + _LEAST_KNOWN / whole * information)
        deviations.append(inverse @ (own.T @ solved.weighted[inside].ravel()))
        variances.append(inverse * solved.variance)
    return np.reshape(deviations, (-1, size)), np.reshape(variances, (-1, size, size))


def polar(cosine: float, sine: float, covariance: FloatArray) -> tuple[float, float, float, float]:
    """Amplitude and phase of a harmonic A sin(m tau + phi), and their standard errors.

    Args:
        cosine, sine: its coefficients, A sin(phi) and A cos(phi).
        covariance: of these (2, 2).
    """
    amplitude, phase = math.hypot(cosine, sine), math.atan2(cosine, sine)
    if amplitude == 0.0:
        return 0.0, 0.0, math.sqrt(float(np.trace(covariance)) / 2.0), _UNKNOWN_PHASE
    along = np.array([cosine, sine]) / amplitude
    across = np.array([sine, -cosine]) / amplitude**2
    error = math.sqrt(max(0.0, float(along @ covariance @ along)))
    turned = math.sqrt(max(0.0, float(across @ covariance @ across)))
    return amplitude, phase, error, min(turned, _UNKNOWN_PHASE)


def phase_gradient(cosine: float, sine: float) -> FloatArray:
    """Derivatives (2,) of the phase of a harmonic by its coefficients."""
    square = cosine**2 + sine**2
    return np.array([sine, -cosine]) / square if square > 0.0 else np.zeros(2)
