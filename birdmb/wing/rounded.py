"""A polyline with its corners rounded: smooth along its length and in its vertices.

The polyline, as a function of its arc length, is convolved with a bump of half-width eps_k around
corner k. Its tangent then turns from one leg to the next by a smooth step, and the curve leaves the
legs only within eps_k of the corner. The bump is (1 - x^2)^2, so the result is C3.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import Array, FloatArray


class RoundedPolyline(NamedTuple):
    """n vertices as start, first tangent and n - 2 turns; the parameter runs from 0 to 1.

    In space, or of any three values that go linearly from one vertex to the next.
    """

    start: Array  # (3,) m
    tangent: Array  # (3,) m, derivative by the parameter on the first leg
    turn: Array  # (n - 2, 3) m, change of that derivative at each corner
    corner: Array  # (n - 2,) parameter of each corner
    width: Array  # (n - 2,) half-width of its rounding
    per_width: Array  # (n - 2,) its inverse: a complex division costs ten products


@kernel
def rounded_polyline(vertices: Array, rounding: float) -> RoundedPolyline:
    """Round the polyline through `vertices` (n, 3), each corner over `rounding` a b/(a + b).

    a and b are the lengths of the legs that meet there: for `rounding` up to 1 no rounding reaches
    the end of a leg.
    """
    return rounded_along(vertices, leg_lengths(vertices), rounding)


@kernel
def leg_lengths(vertices: Array) -> Array:
    """Lengths (n - 1,) m of the legs between vertices (n, 3) m."""
    legs = vertices[1:] - vertices[:-1]
    length = np.empty(legs.shape[0], vertices.dtype)
    for i in range(length.size):
        length[i] = np.sqrt(
            legs[i, 0] * legs[i, 0] + legs[i, 1] * legs[i, 1] + legs[i, 2] * legs[i, 2]
        )
    return length


@kernel
def rounded_along(vertices: Array, length: Array, rounding: float) -> RoundedPolyline:
    """As `rounded_polyline`, of any three values (n, 3) at vertices so far apart (n - 1,) m."""
    n = vertices.shape[0]
    legs = vertices[1:] - vertices[:-1]
    total = length.sum()
    corner = np.empty(n - 2, vertices.dtype)
    width = np.empty(n - 2, vertices.dtype)
    turn = np.empty((n - 2, 3), vertices.dtype)
    reached = 0.0 * total
    for k in range(n - 2):
        reached = reached + length[k]
        corner[k] = reached / total
        width[k] = rounding * length[k] * length[k + 1] / ((length[k] + length[k + 1]) * total)
        turn[k] = (legs[k + 1] / length[k + 1] - legs[k] / length[k]) * total
    tangent = legs[0] / length[0] * total
    return RoundedPolyline(vertices[0].copy(), tangent, turn, corner, width, 1.0 / width)


@kernel
def smooth_step(x: complex) -> complex:
    """From 0 at x <= -1 to 1 at x >= 1, with two continuous derivatives.

    Powers are products: a complex power goes through a logarithm, whose round-off would drown the
    tiny imaginary part of a complex step.
    """
    if x.real <= -1.0:
        return 0.0 * x
    if x.real >= 1.0:
        return 0.0 * x + 1.0
    return _step_within(x)


@kernel
def _step_within(x: complex) -> complex:
    square = x * x
    return 0.5 + 15.0 / 16.0 * x * (1.0 - square * (2.0 / 3.0 - square / 5.0))


@kernel
def _smooth_ramp(x: complex) -> complex:
    """Integral of `smooth_step`: 0 before x = -1, x after x = 1."""
    if x.real <= -1.0:
        return 0.0 * x
    if x.real >= 1.0:
        return x
    return _ramp_within(x)


@kernel
def _ramp_within(x: complex) -> complex:
    square = x * x
    bulge = square * (0.5 - square * (1.0 / 6.0 - square / 30.0))
    return 5.0 / 32.0 + 0.5 * x + 15.0 / 16.0 * bulge


@kernel
def points(line: RoundedPolyline, parameters: Array) -> Array:
    """Points (n, 3) m at n parameters; before 0 and after 1 the end legs go straight on."""
    n = parameters.size
    found = np.empty((n, 3), line.start.dtype)
    for j in range(n):
        s = parameters[j]
        for i in range(3):
            found[j, i] = line.start[i] + s * line.tangent[i]
        for k in range(line.corner.size):
            past = s - line.corner[k]
            if past.real <= -line.width[k].real:
                break
            ramp = line.width[k] * _smooth_ramp(past * line.per_width[k])
            for i in range(3):
                found[j, i] += line.turn[k, i] * ramp
    return found


@kernel
def write_points_and_tangents(
    line: RoundedPolyline, parameters: FloatArray, found: FloatArray, tangents: FloatArray
) -> None:
    """Write points and derivatives by the parameter of a real line at n parameters, (n, 3) m."""
    for j in range(parameters.size):
        s = parameters[j]
        for i in range(3):
            found[j, i] = line.start[i] + s * line.tangent[i]
            tangents[j, i] = line.tangent[i]
        for k in range(line.corner.size):
            width = line.width[k]
            past = s - line.corner[k]
            if past <= -width:
                break
            step, ramp = 1.0, past
            if past < width:
                x = past * line.per_width[k]
                step, ramp = _step_within(x).real, width * _ramp_within(x).real
            for i in range(3):
                found[j, i] += line.turn[k, i] * ramp
                tangents[j, i] += line.turn[k, i] * step


@kernel
def write_rates(line: RoundedPolyline, parameters: FloatArray, rates: FloatArray) -> None:
    """Write how fast points at n fixed parameters move, (n, 3), by a line's imaginary parts.

    Those of `points`, to first order: complex numbers would take three times as long.
    """
    for j in range(parameters.size):
        s = parameters[j]
        for i in range(3):
            rates[j, i] = line.start[i].imag + s * line.tangent[i].imag
        for k in range(line.corner.size):
            width, corner_rate = line.width[k].real, line.corner[k].imag
            past = s - line.corner[k].real
            if past <= -width:
                break
            ramp, ramp_rate = past, -corner_rate
            if past < width:
                x = past * line.per_width[k].real
                step, share = _step_within(x).real, _ramp_within(x).real
                ramp = width * share
                ramp_rate = line.width[k].imag * (share - step * x) - step * corner_rate
            for i in range(3):
                turn = line.turn[k, i]
                rates[j, i] += turn.imag * ramp + turn.real * ramp_rate
