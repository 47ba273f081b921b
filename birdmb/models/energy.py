"""Work done by joints, apart by sign, and energy lost to the air."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from birdmb._typing import FloatArray

if TYPE_CHECKING:
    from birdmb.models.loads import Loads

DISSIPATORS = ("lift", "profile", "tail", "body")


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


def dissipation(loads: Loads, u: float, w: float, q: float) -> dict[str, float]:
    """Power (W) that each load takes from a bird that moves at u, w (m/s), q (rad/s) in still air.

    "lift" is that of the lifting line, which is its induced drag; "profile" the drag of the wing's
    sections; "tail" and "body" all of theirs. Minus force times velocity of the point it acts at.
    """
    x, z = loads.position[:, 0], loads.position[:, 2]
    velocity = loads.velocity + np.column_stack([u + q * z, np.zeros_like(x), w - q * x])
    profile = -2.0 * float(np.sum(loads.profile_drag * velocity))
    wing = -2.0 * float(np.sum(loads.element_force * velocity))
    tail = 0.0
    if loads.tail is not None:
        (fx, _, fz), (tx, _, tz) = loads.tail.force, loads.tail.position
        tail = -float(fx * (u + q * tz) + fz * (w - q * tx))
    body = -float(loads.body_drag[0] * u + loads.body_drag[2] * w)
    return dict(zip(DISSIPATORS, (wing - profile, profile, tail, body), strict=True))
