"""Standard errors of a fitted gait, and how much the beats differ from each other."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from birdmb._typing import FloatArray
from birdmb.kinematics.series import Solved

_FEWEST_BEATS = 2
_LEAST_PART = 0.5  # of the samples that a beat has on average
_LEAST_KNOWN = 1e-3  # of the mean information, which a beat's own is added to
_NEARLY = 1e-3  # of a beat that may be missing
_SURE = 0.99


@dataclass(frozen=True)
class ErrorBars:
    """Errors and scatter of a gait.

    Attributes:
        covariance: (p, p) of the unknowns, frequency times span last. That of independent samples,
            enlarged for joints whose beats differ by more than it allows (Birge, Phys. Rev. 40,
            1932).
        deviations: (B, p) of the whole beats from the mean one; that of the frequency is 0.
        scatter: (joints,) rms of the beats' angles from their mean, rad; NaN of one beat.
    """

    covariance: FloatArray
    deviations: FloatArray
    scatter: FloatArray

    @property
    def beats(self) -> int:
        """How many whole beats there are."""
        return len(self.deviations)

    def error(self, gradient: FloatArray) -> float:
        """Standard error of what depends on the unknowns by a gradient (p,).

        From the covariance, or from the scatter over the beats where that is significantly more.
        """
        stated = max(0.0, float(gradient @ self.covariance @ gradient))
        if self.beats < _FEWEST_BEATS:
            return math.sqrt(stated)
        off = self.deviations @ gradient
        freedom = self.beats - 1
        squares = float(np.sum(off**2)) / self.beats
        significant = squares > stated * chi2.ppf(_SURE, freedom)
        return math.sqrt(squares / freedom if significant else stated)


def error_bars(solved: Solved, times: FloatArray) -> ErrorBars:
    """The errors of the unknowns, and the scatter over the whole beats in `times` (N,)."""
    white = np.linalg.pinv(solved.information, hermitian=True) * solved.variance
    rows, _ = solved.gait.unknowns
    joints = len(solved.gait.joints)
    deviations, variances = _of_beats(solved, times)
    factors, scatter = np.ones(joints), np.full(joints, np.nan)
    beats = len(deviations)
    for joint in range(joints) if beats >= _FEWEST_BEATS else ():
        own = np.flatnonzero(rows == joint)
        off, block = deviations[:, own], variances[:, own[:, None], own]
        misfit = float(np.sum(off * np.linalg.solve(block, off[:, :, None])[:, :, 0]))
        factors[joint] = max(1.0, misfit / ((beats - 1) * own.size))
        halves = np.where(np.arange(own.size) == 0, 1.0, 0.5)
        scatter[joint] = math.sqrt(np.sum(halves * off**2) / (beats - 1))
    enlarge = np.sqrt(np.append(factors[rows], factors.max()))
    covariance = np.asarray(white * np.outer(enlarge, enlarge))
    return ErrorBars(covariance, np.pad(deviations, ((0, 0), (0, 1))), scatter)


def _of_beats(solved: Solved, times: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Deviations (B, p) of whole beats from the mean one, and their covariances (B, p, p)."""
    phases = solved.gait.phases(times)
    number = np.floor(phases - phases[0]).astype(np.int64)
    span = phases[-1] - phases[0]
    # The last frame stands for the time up to the one that would follow.
    whole = int(np.floor(span * len(phases) / (len(phases) - 1) + _NEARLY))
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


def amplitude_gradient(cosine: float, sine: float) -> FloatArray:
    """Derivatives (2,) of the amplitude A of a harmonic by its coefficients A sin(phi), A cos(phi).

    Where it has none, in one of all directions.
    """
    size = math.hypot(cosine, sine)
    return np.array([cosine, sine]) / size if size > 0.0 else np.array([1.0, 0.0])


def phase_gradient(cosine: float, sine: float) -> FloatArray:
    """Derivatives (2,) of the phase phi of a harmonic by its coefficients."""
    square = cosine**2 + sine**2
    return np.array([sine, -cosine]) / square if square > 0.0 else np.full(2, np.inf)
