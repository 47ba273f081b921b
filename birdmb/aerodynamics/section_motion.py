"""How the sections of a wing move: at three quarters and at half of their chords, and turning.

The wake's lags are driven by the velocity of the air at the three-quarter-chord point, apparent
mass by the acceleration of the mid-chord point across the chord.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.wing.shape import WingShape


class SectionMotion(NamedTuple):
    """Motion of N sections relative to the axes that they are given in.

    Accelerations are the rates of change of the components.
    """

    rear_velocity: FloatArray  # (N, 3) m/s, of the three-quarter-chord points
    middle_velocity: FloatArray  # (N, 3) m/s, of the mid-chord points
    middle_acceleration: FloatArray  # (N, 3) m/s2
    pitch_rate: FloatArray  # (N,) rad/s, about the span, nose up
    pitch_acceleration: FloatArray  # (N,) rad/s2
    normal_rate: FloatArray  # (N, 3) 1/s
    span_rate: FloatArray  # (N, 3) 1/s


@kernel
def middle_velocity(shape: WingShape) -> FloatArray:
    """Velocities (N, 3) m/s of the mid-chord points."""
    return shape.velocity + 0.25 * shape.chord_rate


@kernel
def pitch_rate(shape: WingShape) -> FloatArray:
    """Angular velocities (N,) rad/s of the sections about the span, nose up."""
    return -np.sum(shape.normal * shape.chord_rate, axis=1) / shape.chord


@kernel
def section_motion(
    before: WingShape, now: WingShape, after: WingShape, step: float
) -> SectionMotion:
    """Motion of a shape's sections, of the shapes a short time `step` (s) before and after it.

    By central differences. The shapes before and after have moved at constant angular velocities of
    those joints whose accelerations are to count apart.
    """
    per_second = 0.5 / step
    return SectionMotion(
        now.velocity + 0.5 * now.chord_rate,
        middle_velocity(now),
        per_second * (middle_velocity(after) - middle_velocity(before)),
        pitch_rate(now),
        per_second * (pitch_rate(after) - pitch_rate(before)),
        per_second * (after.normal - before.normal),
        per_second * (after.span_direction - before.span_direction),
    )
