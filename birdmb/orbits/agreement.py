"""Agreement of segment Jacobians with differences of the flow that they belong to.

The variational equations are no derivative of the flow where the right-hand side jumps (they leave
out the saltation matrix: Aizerman & Gantmakher 1958; Leine & Nijmeijer 2004, chapter 7), nor where
a Jacobian that a user wrote is wrong. One difference along one direction in general position shows
either.
"""

from __future__ import annotations

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.orbits.problem import flow_accuracy
from birdmb.orbits.segments import Segments

# Displacements in units of the state scale, the next one where neighbours at the one before are no
# longer neighbours; truncation 1e-12 and the noise 1e-7 of a flow good to 1e-10 at the first.
_STEPS = (1e-3, 3e-5, 1e-6, 3e-8)
# A disagreement is taken back by a shorter difference that is known to this part of it: the
# right-hand side bends between the two, and does not jump.
_TAKEN_BACK = 0.1
# A difference that is known to no more than this part of itself does not decide.
_SHARP = 1e-3
# By how much a disagreement must exceed what the differences themselves are known to.
_MARGIN = 3.0
_LEAST_ACCURACY = 1e-10


def jacobian_gaps(
    segments: Segments, points: FloatArray, period: float, factors: FloatArray, ends: FloatArray
) -> FloatArray:
    """Distance (M, n, n) of the segment Jacobians `factors` from differences of the flow.

    Zero where they agree along a direction in general position, as far as differences resolve
    (1e-7 for a flow good to 1e-10): four flows a segment, and four more for each shorter step that
    is tried where they do not. Else the distance of the farther of the
    one-sided differences for each start state, in the units of the Jacobians: 2 n flows more.
    `points` and `ends` (M, n) are the starts and ends of the segments. Where the flow fails beside
    the points nothing is compared.
    """
    m, n = points.shape
    directions = np.random.default_rng(0).standard_normal((m, n))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    units = np.divide.outer(segments.scale, segments.scale)
    claimed = np.einsum("kij,kj->ki", factors / units, directions)
    growth = np.maximum(1.0, np.abs(claimed).max(axis=1, keepdims=True))
    apart, at = 0.0, _STEPS[-1]
    for step in _STEPS:
        try:
            gap, own, sharp = _compare(
                segments, points, period, ends, directions, claimed, step / growth
            )
        except StateError:
            continue
        if (gap > own).any():
            if apart == 0.0:
                apart, at = float(gap.max()), step
        elif own.max() <= _TAKEN_BACK * apart if apart else sharp:
            return np.zeros_like(factors)
    try:
        return _one_sided_distance(segments, points, period, factors, ends, at)
    except StateError:
        return np.zeros_like(factors)


def _compare(
    segments: Segments,
    points: FloatArray,
    period: float,
    ends: FloatArray,
    directions: FloatArray,
    claimed: FloatArray,
    steps: FloatArray,
) -> tuple[FloatArray, FloatArray, bool]:
    """Gap (M, n) from the claim, what the difference is known to (M, n), whether that decides."""
    shifts = steps * directions * segments.scale
    starts = points + np.multiply.outer([1.0, -1.0, 2.0, -2.0], shifts)
    plus, minus, far_plus, far_minus = (
        segments.ends_from(starts[:, :, None, :], period)[:, :, 0] - ends
    ) / segments.scale
    near, far = (plus - minus) / (2 * steps), (far_plus - far_minus) / (4 * steps)
    # Of a smooth flow the one-sided differences part in proportion to the step, of a kink not.
    kink = np.abs(2 * (plus + minus) / steps - (far_plus + far_minus) / (2 * steps))
    size = 1.0 + np.abs(claimed).max(axis=1, keepdims=True)
    noise = max(flow_accuracy(segments.model), _LEAST_ACCURACY) * size / steps
    truncation = np.abs(near - far)
    # Richardson's extrapolation is off by about the square of what it takes off.
    extrapolated = truncation * np.minimum(1.0, 10 * truncation / size)
    gap = np.abs((4 * near - far) / 3 - claimed) + kink
    sharp = bool((truncation <= _SHARP * size + _MARGIN * noise).all())
    return gap, _MARGIN * (extrapolated + noise), sharp


def _one_sided_distance(
    segments: Segments,
    points: FloatArray,
    period: float,
    factors: FloatArray,
    ends: FloatArray,
    step: float,
) -> FloatArray:
    plus, minus, taken = segments.both_sides(points, period, step)
    half = taken[:, :, None] / 2
    ahead, behind = (plus - ends[:, None, :]) / half, (ends[:, None, :] - minus) / half
    claimed = np.swapaxes(factors, 1, 2)
    distance = np.maximum(np.abs(ahead - claimed), np.abs(behind - claimed))
    return np.swapaxes(distance, 1, 2)
