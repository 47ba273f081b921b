"""The lifting line: quarter-chord curve to which every chord is orthogonal.

A station j pairs a point A_j of the leading edge with a point B_j of the trailing edge; its chord
is c_j = B_j - A_j and its point of the line P_j = 3/4 A_j + 1/4 B_j. The edges' starts at the
shoulder are a pair, and so are their ends at a pointed tip; the other pairs follow from

    c_j . (P_{j+1} - P_{j-1}) = 0,

with differences to one side where `birdmb.wing.line_ends` says so, solved for one shift d_j a
station, by which the chord turns about P_j: A_j = A(s_j - d_j) and B_j = B(s_j + 3 d_j), with A and
B the rounded edges. The system is tridiagonal; Newton's method starts at d = 0 on few stations,
which are then doubled, so the line is a function of the joint angles alone, as smooth as the edges
are.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import Array, ComplexArray, FloatArray
from birdmb.wing.line_ends import LineEnds, line_ends
from birdmb.wing.rounded import (
    RoundedPolyline,
    points,
    rounded_polyline,
    write_points_and_tangents,
)

MAX_NEWTON_STEPS = 40
SHORTEST_DAMPING = 1e-3
COARSEST = 16
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
    leading_slope: FloatArray  # (n, 3) m, by the pair's own shift
    trailing_slope: FloatArray  # (n, 3) m
    residual: FloatArray  # (n,) m2
    lower: FloatArray  # (n,) m2
    diagonal: FloatArray  # (n,) m2
    upper: FloatArray  # (n,) m2


class SolvedLine(NamedTuple):
    """The rounded edges at an instant, the shifts that make the chords orthogonal, and slopes."""

    leading: RoundedPolyline
    trailing: RoundedPolyline
    station: FloatArray  # (n,) parameters of the stations
    shift: FloatArray  # (n,)
    linear: Linearised
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
def _newton_step(linear: Linearised, residual: FloatArray) -> FloatArray:
    """Change (n,) of the shifts that makes the `residual` (n,) vanish to first order.

    Thomas algorithm; row i reads lower[i] x[i-1] + diagonal[i] x[i] + upper[i] x[i+1].
    """
    n = residual.size
    c, x = np.empty(n), np.empty(n)
    c[0] = linear.upper[0] / linear.diagonal[0]
    x[0] = -residual[0] / linear.diagonal[0]
    for i in range(1, n):
        per_pivot = 1.0 / (linear.diagonal[i] - linear.lower[i] * c[i - 1])
        c[i] = linear.upper[i] * per_pivot
        x[i] = (-residual[i] - linear.lower[i] * x[i - 1]) * per_pivot
    for i in range(n - 2, -1, -1):
        x[i] -= c[i] * x[i + 1]
    return x


@kernel
def _pair(
    leading: RoundedPolyline, trailing: RoundedPolyline, s: FloatArray, shift: Array
) -> tuple[Array, Array]:
    return points(leading, s - shift), points(trailing, s + 3.0 * shift)


@kernel
def _obliqueness(A: Array, B: Array, ends: LineEnds, last: float) -> Array:
    """Residual chord . step (n,) m^2, zero where chords are given: at shoulder and pointed tip.

    The steps are central differences of the line but for the ends; `last` is the parameter's last.
    """
    n = A.shape[0]
    F = np.zeros(n, A.dtype)
    for i in range(3):
        behind, here = 0.75 * A[0, i] + 0.25 * B[0, i], 0.75 * A[1, i] + 0.25 * B[1, i]
        first = here - behind
        for j in range(1, n - 1):
            ahead = 0.75 * A[j + 1, i] + 0.25 * B[j + 1, i]
            F[j] += (B[j, i] - A[j, i]) * (ahead - behind)
            behind, here = here, ahead
        F[1] -= (B[1, i] - A[1, i]) * ends.shoulder * first
        if ends.square:
            step = ends.tip * (here - behind) + (1.0 - ends.tip) * last * ends.direction[i]
            F[n - 1] += (B[n - 1, i] - A[n - 1, i]) * step
    return F


@kernel
def _linearise(
    line: tuple[RoundedPolyline, RoundedPolyline, LineEnds],
    s: FloatArray,
    shift: FloatArray,
    out: Linearised,
) -> float:
    """Write pairs, residual and derivatives at the shifts (n,); the residual's sum of squares."""
    leading, trailing, ends = line
    A, B, dA, dB, F, lower, diagonal, upper = out
    n, last = s.size, s[-1] - s[-2]
    write_points_and_tangents(leading, s - shift, A, dA)
    write_points_and_tangents(trailing, s + 3.0 * shift, B, dB)
    for j in range(n):
        F[j] = lower[j] = upper[j] = 0.0
        diagonal[j] = 1.0
        for i in range(3):
            dA[j, i] *= -1.0
            dB[j, i] *= 3.0
    for j in range(1, n if ends.square else n - 1):
        ahead, here, behind = 1.0, 0.0, -1.0
        if j == 1:
            here, behind = -ends.shoulder.real, ends.shoulder.real - 1.0
        if j == n - 1:
            ahead, here, behind = 0.0, ends.tip.real, -ends.tip.real
        before, after = j - 1, min(j + 1, n - 1)
        oblique = by_own = by_before = by_after = 0.0
        for i in range(3):
            chord = B[j, i] - A[j, i]
            step = (
                ahead * (0.75 * A[after, i] + 0.25 * B[after, i])
                + here * (0.75 * A[j, i] + 0.25 * B[j, i])
                + behind * (0.75 * A[before, i] + 0.25 * B[before, i])
            )
            if j == n - 1:
                step += (1.0 - ends.tip.real) * last * ends.direction[i].real
            oblique += chord * step
            own = 0.75 * dA[j, i] + 0.25 * dB[j, i]
            by_own += (dB[j, i] - dA[j, i]) * step + here * chord * own
            by_after += ahead * chord * (0.75 * dA[after, i] + 0.25 * dB[after, i])
            by_before += behind * chord * (0.75 * dA[before, i] + 0.25 * dB[before, i])
        F[j], lower[j], diagonal[j], upper[j] = oblique, by_before, by_own, by_after
    return np.sum(F * F)


@kernel
def _solve_shifts(
    leading: RoundedPolyline,
    trailing: RoundedPolyline,
    s: FloatArray,
    guess: FloatArray,
    tolerance: float,
) -> tuple[FloatArray, Linearised, bool]:
    """Damped Newton iteration for the shifts; also whether it reached the tolerance."""
    shift, n = guess, s.size
    line = leading, trailing, line_ends(leading, trailing, s[-1] - s[-2])
    linear = Linearised(
        np.empty((n, 3)),
        np.empty((n, 3)),
        np.empty((n, 3)),
        np.empty((n, 3)),
        np.empty(n),
        np.empty(n),
        np.empty(n),
        np.empty(n),
    )
    squares = _linearise(line, s, shift, linear)
    earlier = 0.0
    for _ in range(MAX_NEWTON_STEPS):
        step = _newton_step(linear, linear.residual)
        before, damping = squares, 1.0
        while True:
            squares = _linearise(line, s, shift + damping * step, linear)
            if squares <= before or damping < SHORTEST_DAMPING:
                break
            damping *= 0.5
        shift = shift + damping * step
        size = np.max(np.abs(step))
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
    leading_edge: ComplexArray, trailing_edge: ComplexArray, stations: int, rounding: float
) -> SolvedLine:
    """Find the shifts that make the chords orthogonal; imaginary parts of the edges are ignored."""
    leading = rounded_polyline(leading_edge.real.copy(), rounding)
    trailing = rounded_polyline(trailing_edge.real.copy(), rounding)
    # On many stations Newton's method from zero may end on a line that doubles back on itself; a
    # coarse line, refined, leads to the plain one.
    n = min(COARSEST, stations)
    shift = np.zeros(n)
    while n < stations:
        s = station_parameters(n)
        shift, _, _ = _solve_shifts(leading, trailing, s, shift, COARSE_TOLERANCE)
        n = min(2 * n, stations)
        shift = _refined(shift, n)
    s = station_parameters(n)
    shift, linear, converged = _solve_shifts(leading, trailing, s, shift, SHIFT_TOLERANCE)
    return SolvedLine(leading, trailing, s, shift, linear, converged)


@kernel
def moved_line(
    line: SolvedLine, leading_edge: ComplexArray, trailing_edge: ComplexArray, rounding: float
) -> PairedEdges:
    """Pair the edges as `line` does, which was solved for their real parts.

    The imaginary parts of the vertices are taken for infinitesimal rates (complex step): a Newton
    step is made with them, which by the implicit function theorem is exact.
    """
    s, linear = line.station, line.linear
    moving_leading = rounded_polyline(leading_edge, rounding)
    moving_trailing = rounded_polyline(trailing_edge, rounding)
    A, B = _pair(moving_leading, moving_trailing, s, line.shift.astype(np.complex128))
    last = s[-1] - s[-2]
    ends = line_ends(moving_leading, moving_trailing, last)
    shift_rate = _newton_step(linear, _obliqueness(A, B, ends, last).imag.copy())
    for j in range(s.size):
        for i in range(3):
            A[j, i] += 1j * linear.leading_slope[j, i] * shift_rate[j]
            B[j, i] += 1j * linear.trailing_slope[j, i] * shift_rate[j]
    return PairedEdges(A, B, line.converged)


@kernel
def line_to_follow(line: SolvedLine, pairs: PairedEdges) -> Array:
    """Points (n, 3) m whose differences are the direction of the line of `pairs`.

    They are its own but for the shoulder's where the chord there is given against the equation
    (`LineEnds.shoulder`): beside it the line is displaced, and its direction is that of what
    follows.
    """
    points = 0.75 * pairs.leading + 0.25 * pairs.trailing
    weight = line_ends(line.leading, line.trailing, line.station[-1] - line.station[-2]).shoulder
    first = points[1] - points[0]
    points[0] -= weight.real * (points[2] - points[1] - first)
    return points


@kernel
def orthogonal_line(
    leading_edge: ComplexArray, trailing_edge: ComplexArray, stations: int, rounding: float
) -> PairedEdges:
    """Pair the edges (vertices (m, 3) m) at `stations` stations, chords orthogonal to the line.

    Complex vertices carry rates, see `moved_line`.
    """
    line = solved_line(leading_edge, trailing_edge, stations, rounding)
    return moved_line(line, leading_edge, trailing_edge, rounding)
