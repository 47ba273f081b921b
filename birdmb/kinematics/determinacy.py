"""Which joints the measured columns tell, and which they do not."""

from __future__ import annotations

import math

import numpy as np

from birdmb._typing import FloatArray
from birdmb.kinematics.observations import Observations, without
from birdmb.kinematics.poses import PHASES, MeanBeat

UNSURE = math.radians(10.0)
_FEWEST_PHASES = PHASES // 3


def told_joints(seen: Observations, beat: MeanBeat, angles: FloatArray) -> tuple[int, ...]:
    """The joints that the columns tell, at the angles (PHASES, A) of the beat.

    At each phase the covariance of the angles is that of least squares with the samples that there
    are, and with an angle known to a radian beforehand: along a null direction of the Jacobian the
    radian is left. The joint that is known worst is taken out until all others are known to 10
    degrees at a third of the phases or more.
    """
    weights = np.sqrt(beat.counts) / np.maximum(beat.noise, 1e-4 * seen.typical)
    weights[~np.isfinite(beat.values)] = 0.0
    slopes = seen.derivatives(angles) * weights[:, :, None]
    basis = seen.body_motion_basis(weights, seen.predicted(angles))
    slopes = without(basis, slopes)
    kept = list(range(slopes.shape[2]))
    while kept:
        own = slopes[:, :, kept]
        known = own.transpose(0, 2, 1) @ own + np.eye(len(kept))
        unsure = np.sqrt(np.linalg.inv(known).diagonal(axis1=1, axis2=2))
        seldom = (unsure < UNSURE).sum(axis=0) < _FEWEST_PHASES
        if not seldom.any():
            break
        # Of several the one that the bones' ends show least.
        worst = np.where(seldom, np.median(unsure, axis=0), -1.0)
        kept.pop(int(np.argmax(worst)))
    return tuple(kept)
