"""How the sections of a wing move: at three quarters and at half of their chords, and turning.

The wake's lags are driven by the velocity of the air at the three-quarter-chord point, apparent
mass by the acceleration of the mid-chord point across the chord.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.aerodynamics.elements import Elements
from birdmb.wing.rotations import cross
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


@kernel
def turned_sections(
    motion: SectionMotion,
    elements: Elements,
    root: FloatArray,
    axes: FloatArray,
    spin: FloatArray,
    change: FloatArray,
) -> SectionMotion:
    """Motion relative to the body of sections whose own axes turn about the shoulder.

    `motion` is that relative to these axes, (3, 3) in body axes, which turn at `spin` (3,) rad/s
    that changes at `change` (3,) rad/s2; `elements` are placed in body axes, `root` (3,) m is the
    shoulder.
    """
    n, turn = elements.chord.size, np.ascontiguousarray(axes.T)
    rear, middle = motion.rear_velocity @ turn, motion.middle_velocity @ turn
    acceleration = motion.middle_acceleration @ turn
    normal_rate, span_rate = motion.normal_rate @ turn, motion.span_rate @ turn
    pitch_rate, pitch_acceleration = motion.pitch_rate.copy(), motion.pitch_acceleration.copy()
    at, moves, again = np.empty(3), np.empty(3), np.empty(3)
    for e in range(n):
        quarter, span = 0.25 * elements.chord[e], elements.span_direction[e]
        for i in range(3):
            pitch_rate[e] += span[i] * spin[i]
            pitch_acceleration[e] += span_rate[e, i] * spin[i] + span[i] * change[i]
            at[i] = elements.position[e, i] - root[i] + quarter * elements.chord_direction[e, i]
        cross(spin, middle[e], moves)
        acceleration[e] += 2.0 * moves
        cross(change, at, moves)
        acceleration[e] += moves
        cross(spin, at, moves)
        middle[e] += moves
        cross(spin, moves, again)
        acceleration[e] += again
        for i in range(3):
            at[i] += quarter * elements.chord_direction[e, i]
        cross(spin, at, moves)
        rear[e] += moves
        cross(spin, elements.normal[e], moves)
        normal_rate[e] += moves
        cross(spin, span, moves)
        span_rate[e] += moves
    return SectionMotion(
        rear,
        middle,
        acceleration,
        pitch_rate,
        pitch_acceleration,
        normal_rate,
        span_rate,
    )
