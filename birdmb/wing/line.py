"""The lifting line: quarter-chord curve to which every chord is orthogonal.

A station j pairs a point A_j of the leading edge with a point B_j of the trailing edge; its chord
is c_j = B_j - A_j and its point of the line P_j = 3/4 A_j + 1/4 B_j. The edges' starts at the
shoulder are a pair, and so are their ends at a pointed tip; the other pairs follow from

    c_j . (P_{j+1} - P_{j-1}) = 0,

with differences to one side where `birdmb.wing.line_ends` says so, solved for one shift d_j a
station, by which the chord turns about P_j: A_j = A(s_j - d_j) and B_j = B(s_j + 3 d_j), with A and
B the rounded edges. The system is tridiagonal; Newton's method starts at d = 0 on few stations,
which are then refined, so the line is a function of the joint angles alone, as smooth as the edges
are.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import Array, ComplexArray, FloatArray
from birdmb.wing.line_ends import LineEnds, edge_ends, line_ends
from birdmb.wing.rounded import (
    RoundedPolyline,
    rounded_polyline,
    write_points_and_tangents,
    write_rates,
)

MAX_NEWTON_STEPS = 40
SHORTEST_DAMPING = 1e-3
COARSEST = 16
# More than this many times the stations are reached by further coarse lines.
FINER = 4
COARSE_TOLERANCE = 1e-3
# Of the shift, a fraction of the wing's length: well below anything the loads can tell.
SHIFT_TOLERANCE = 1e-11
# Newton's method has entered its region of quadratic convergence where a step is so much smaller
# than the one before.
QUADRATIC = 0.1


class PairedEdges(NamedTuple):
    """Stations of the lifting line from shoulder to tip, each (n, 3) m.

    `converged` is False when the Newton iteration did not reach its tolerance.
    """

    leading: Array
    trailing: Array
    converged: bool


class Linearised(NamedTuple):
    """Pairs of real edges, the residual and its derivative by the shifts, which is tridiagonal.

    Made once a search and written over at each step: at this size making arrays takes longest.
    """

    leading: FloatArray  # (n, 3) m
    trailing: FloatArray  # (n, 3) m
    leading_slope: FloatArray  # (n, 3) m, by the edge's parameter
    trailing_slope: FloatArray  # (n, 3) m
    residual: FloatArray  # (n,) m2
    lower: FloatArray  # (n,) m2
    diagonal: FloatArray  # (n,) m2
    upper: FloatArray  # (n,) m2
    step: FloatArray  # (n,) of Newton's method


class SolvedLine(NamedTuple):
    """The rounded edges at an instant, the shifts that make the chords orthogonal, and slopes."""

    leading: RoundedPolyline
    trailing: RoundedPolyline
    station: FloatArray  # (n,) parameters of the stations
    shift: FloatArray  # (n,)
    linear: Linearised
    shoulder: float  # weight of the difference to one side there, see `LineEnds`
    converged: bool


@kernel
def station_parameters(n: int) -> FloatArray:
    """Parameters in [0, 1] of n stations, crowded towards shoulder and tip like a cosine.

    The circulation falls to zero at the tip, and leaves the constant over the body at the shoulder,
    like a square root; in the cosine's argument it is smooth, and sums over the trailing vortices
    are as accurate there as elsewhere (Glauert's substitution).
    """
    return 0.5 * (1.0 - np.cos(np.pi * np.arange(n) / (n - 1)))


@kernel
def _newton_step(linear: Linearised, residual: FloatArray) -> None:
    """Write the change (n,) of the shifts that makes the `residual` (n,) vanish to first order.

    Thomas algorithm; row i reads lower[i] x[i-1] + diagonal[i] x[i] + upper[i] x[i+1].
    """
    n, x, c = residual.size, linear.step, np.empty(residual.size)
    before = above = 0.0
    for i in range(n):
        per_pivot = 1.0 / (linear.diagonal[i] - linear.lower[i] * above)
        before = (-residual[i] - linear.lower[i] * before) * per_pivot
        above = linear.upper[i] * per_pivot
        x[i], c[i] = before, above
    after = 0.0
    for i in range(n - 1, -1, -1):
        after = x[i] - c[i] * after
        x[i] = after


@kernel
def _on_line(leading: Array, trailing: Array, j: int, i: int) -> complex:
    """A coordinate of the line's point of the j-th pair, or of its rate."""
    return 0.75 * leading[j, i] + 0.25 * trailing[j, i]


@kernel
def _linearise(
    line: tuple[RoundedPolyline, RoundedPolyline, LineEnds],
    s: FloatArray,
    shift: FloatArray,
    out: Linearised,
) -> float:
    """Write pairs, residual and derivatives at the shifts (n,); the residual's sum of squares.

    The residual is chord . step (n,) m2, with central differences of the line for steps but at its
    ends, and zero where chords are given: at the shoulder and at a pointed tip.
    """
    leading, trailing, ends = line
    A, B, dA, dB, F, lower, diagonal, upper, _ = out
    n, last = s.size, s[-1] - s[-2]
    write_points_and_tangents(leading, s - shift, A, dA)
    write_points_and_tangents(trailing, s + 3.0 * shift, B, dB)
    for j in range(n):
        F[j] = lower[j] = diagonal[j] = upper[j] = 0.0
    diagonal[0] = 1.0
    for i in range(3):
        # By a shift the leading edge's parameter falls by one, the trailing edge's rises by three.
        behind, behind_slope = _on_line(A, B, 0, i), 0.75 * (dB[0, i] - dA[0, i])
        here, slope = _on_line(A, B, 1, i), 0.75 * (dB[1, i] - dA[1, i])
        first, first_slope, second_slope = here - behind, behind_slope, slope
        for j in range(1, n - 1):
            chord, turning = B[j, i] - A[j, i], 3.0 * dB[j, i] + dA[j, i]
            ahead, ahead_slope = _on_line(A, B, j + 1, i), 0.75 * (dB[j + 1, i] - dA[j + 1, i])
            step = ahead - behind
            F[j] += chord * step
            lower[j] -= chord * behind_slope
            diagonal[j] += turning * step
            upper[j] += chord * ahead_slope
            behind, behind_slope, here, slope = here, slope, ahead, ahead_slope
        weight, chord = ends.shoulder.real, B[1, i] - A[1, i]
        F[1] -= weight * chord * first
        lower[1] += weight * chord * first_slope
        diagonal[1] -= weight * ((3.0 * dB[1, i] + dA[1, i]) * first + chord * second_slope)
        if ends.square:
            j, weight = n - 1, ends.tip.real
            chord = B[j, i] - A[j, i]
            step = weight * (here - behind) + (1.0 - weight) * last * ends.direction[i].real
            F[j] += chord * step
            lower[j] -= weight * chord * behind_slope
            diagonal[j] += (3.0 * dB[j, i] + dA[j, i]) * step + weight * chord * slope
    if not ends.square:
        diagonal[n - 1] = 1.0
    return np.sum(F * F)


@kernel
def _residual_rates(
    linear: Linearised, ends: LineEnds, last: float, dA: FloatArray, dB: FloatArray
) -> FloatArray:
    """Rates (n,) m2 of the residual if the points move at rates `dA` and `dB` (n, 3) m.

    The imaginary parts of `ends` are their rates; `last` is the parameter's last step.
    """
    A, B, n = linear.leading, linear.trailing, linear.step.size
    rates = np.zeros(n)
    for i in range(3):
        behind, behind_rate = _on_line(A, B, 0, i), _on_line(dA, dB, 0, i)
        here, rate = _on_line(A, B, 1, i), _on_line(dA, dB, 1, i)
        first, first_rate = here - behind, rate - behind_rate
        for j in range(1, n - 1):
            ahead, ahead_rate = _on_line(A, B, j + 1, i), _on_line(dA, dB, j + 1, i)
            rates[j] += (dB[j, i] - dA[j, i]) * (ahead - behind)
            rates[j] += (B[j, i] - A[j, i]) * (ahead_rate - behind_rate)
            behind, behind_rate, here, rate = here, rate, ahead, ahead_rate
        weight = ends.shoulder
        rates[1] -= weight.real * (dB[1, i] - dA[1, i]) * first
        rates[1] -= (B[1, i] - A[1, i]) * (weight.imag * first + weight.real * first_rate)
        if ends.square:
            j, weight, parallel = n - 1, ends.tip, last * ends.direction[i]
            step = weight.real * (here - behind) + (1.0 - weight.real) * parallel.real
            step_rate = weight.real * (rate - behind_rate) + (1.0 - weight.real) * parallel.imag
            step_rate += weight.imag * (here - behind - parallel.real)
            rates[j] += (dB[j, i] - dA[j, i]) * step + (B[j, i] - A[j, i]) * step_rate
    return rates


@kernel
def _solve_shifts(
    line: tuple[RoundedPolyline, RoundedPolyline, LineEnds],
    s: FloatArray,
    guess: FloatArray,
    tolerance: float,
) -> tuple[FloatArray, Linearised, bool]:
    """Damped Newton iteration for the shifts; also whether it reached the tolerance."""
    shift, n = guess, s.size
    vectors, values = np.empty((4, n, 3)), np.empty((5, n))
    linear = Linearised(
        vectors[0],
        vectors[1],
        vectors[2],
        vectors[3],
        values[0],
        values[1],
        values[2],
        values[3],
        values[4],
    )
    squares = _linearise(line, s, shift, linear)
    earlier = 0.0
    for _ in range(MAX_NEWTON_STEPS):
        _newton_step(linear, linear.residual)
        before, damping = squares, 1.0
        while True:
            squares = _linearise(line, s, shift + damping * linear.step, linear)
            if squares <= before or damping < SHORTEST_DAMPING:
                break
            damping *= 0.5
        shift = shift + damping * linear.step
        size = np.max(np.abs(linear.step))
        # Where full steps converge quadratically, the next one would be about size^3/earlier^2.
        quadratic = damping == 1.0 and size < QUADRATIC * earlier
        if size < tolerance or (quadratic and size**3 < tolerance * earlier**2):
            return shift, linear, True
        earlier = size
    return shift, linear, False


@kernel
def _refined(shift: FloatArray, stations: int) -> FloatArray:
    """Shifts (stations,) by cubic interpolation through those of fewer stations.

    In the cosine's argument, in which both are evenly spread.
    """
    n = shift.size
    finer = np.empty(stations)
    for j in range(stations):
        place = j * (n - 1) / (stations - 1)
        first = min(max(int(place) - 1, 0), n - 4)
        x = place - first
        finer[j] = (
            -shift[first] * (x - 1.0) * (x - 2.0) * (x - 3.0) / 6.0
            + shift[first + 1] * x * (x - 2.0) * (x - 3.0) / 2.0
            - shift[first + 2] * x * (x - 1.0) * (x - 3.0) / 2.0
            + shift[first + 3] * x * (x - 1.0) * (x - 2.0) / 6.0
        )
    return finer


@kernel
def solved_line(
    leading_edge: ComplexArray, trailing_edge: ComplexArray, s: FloatArray, rounding: float
) -> SolvedLine:
    """Find the shifts that make the chords orthogonal; imaginary parts of the edges are ignored.

    At stations with the parameters `s` (n,), those of `station_parameters`.
    """
    leading = rounded_polyline(leading_edge.real.copy(), rounding)
    trailing = rounded_polyline(trailing_edge.real.copy(), rounding)
    edges = edge_ends(leading, trailing)
    # On many stations Newton's method from zero may end on a line that doubles back on itself; a
    # coarse line, refined, leads to the plain one.
    n = min(COARSEST, s.size)
    shift = np.zeros(n)
    while n < s.size:
        few = station_parameters(n)
        line = leading, trailing, line_ends(edges, few[-1] - few[-2])
        shift, _, _ = _solve_shifts(line, few, shift, COARSE_TOLERANCE)
        n = min(FINER * n, s.size)
        shift = _refined(shift, n)
    ends = line_ends(edges, s[-1] - s[-2])
    line = leading, trailing, ends
    shift, linear, converged = _solve_shifts(line, s, shift, SHIFT_TOLERANCE)
    return SolvedLine(leading, trailing, s, shift, linear, ends.shoulder.real, converged)


@kernel
def moved_line(
    line: SolvedLine, leading_edge: ComplexArray, trailing_edge: ComplexArray, rounding: float
) -> PairedEdges:
    """Pair the edges as `line` does, which was solved for their real parts.

    The imaginary parts of the vertices are taken for infinitesimal rates (complex step): a Newton
    step is made with them, which by the implicit function theorem is exact.
    """
    s, linear = line.station, line.linear
    leading = rounded_polyline(leading_edge, rounding)
    trailing = rounded_polyline(trailing_edge, rounding)
    dA, dB = np.empty((s.size, 3)), np.empty((s.size, 3))
    write_rates(leading, s - line.shift, dA)
    write_rates(trailing, s + 3.0 * line.shift, dB)
    last = s[-1] - s[-2]
    ends = line_ends(edge_ends(leading, trailing), last)
    _newton_step(linear, _residual_rates(linear, ends, last, dA, dB))
    A, B = np.empty((s.size, 3), np.complex128), np.empty((s.size, 3), np.complex128)
    for j in range(s.size):
        shift_rate = linear.step[j]
        for i in range(3):
            dA[j, i] -= linear.leading_slope[j, i] * shift_rate
            dB[j, i] += 3.0 * linear.trailing_slope[j, i] * shift_rate
            A[j, i] = linear.leading[j, i] + 1j * dA[j, i]
            B[j, i] = linear.trailing[j, i] + 1j * dB[j, i]
    return PairedEdges(A, B, line.converged)


@kernel
def line_to_follow(line: SolvedLine, pairs: PairedEdges) -> FloatArray:
    """Points (n, 3) m whose differences are the direction of the line of `pairs`.

    They are its own but for the shoulder's where the chord there is given against the equation
    (`LineEnds.shoulder`): beside it the line is displaced, and its direction is that of what
    follows.
    """
    n = line.shift.size
    points = np.empty((n, 3))
    for j in range(n):
        for i in range(3):
            points[j, i] = _on_line(pairs.leading, pairs.trailing, j, i).real
    for i in range(3):
        first = points[1, i] - points[0, i]
        points[0, i] -= line.shoulder * (points[2, i] - points[1, i] - first)
    return points


@kernel
def orthogonal_line(
    leading_edge: ComplexArray, trailing_edge: ComplexArray, stations: int, rounding: float
) -> PairedEdges:
    """Pair the edges (vertices (m, 3) m) at `stations` stations, chords orthogonal to the line.

    Complex vertices carry rates, see `moved_line`.
    """
    line = solved_line(leading_edge, trailing_edge, station_parameters(stations), rounding)
    return moved_line(line, leading_edge, trailing_edge, rounding)
