"""Work done by joints, apart by sign."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from birdmb._typing import FloatArray


class Work(NamedTuple):
    """Mean power over a beat, W, by the sign of what is done at each instant."""

    positive: float
    """Delivered; 0 or more."""
    negative: float
    """Absorbed; 0 or less."""

    def net(self, recovery: float = 1.0) -> float:
        """Mean power, W, if the part `recovery` of the negative work can be used again."""
        return self.positive + recovery * self.negative


def work_by_sign(times: FloatArray, power: FloatArray) -> Work:
    """Split the mean of a periodic power (K,) W at `times` (K,) s, the first repeated at the end.

    By a periodic cubic spline, integrated from zero to zero: of fourth order, in spite of the kinks
    that the sign makes.
    """
    # The ends agree to the orbit's closure; a spline wants them equal.
    spline = CubicSpline(times, np.append(power[:-1], power[0]), bc_type="periodic")
    zeros = spline.roots(extrapolate=False)
    ends = np.unique(np.concatenate([times[[0, -1]], zeros[np.isfinite(zeros)]]))
    parts = np.diff(spline.antiderivative()(ends)) / (times[-1] - times[0])
    return Work(float(parts[parts > 0].sum()), float(parts[parts < 0].sum()))
