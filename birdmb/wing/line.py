"""The lifting line: quarter-chord curve to which every chord is orthogonal (MODEL section 5).

A station j pairs a point A_j of the leading edge with a point B_j of the trailing edge; its chord
is c_j = B_j - A_j and its point of the line P_j = 3/4 A_j + 1/4 B_j. Shoulder and wing tip are
paired with themselves; the pairs between follow from

    c_j . (P_{j+1} - P_{j-1}) = 0,

solved for one shift d_j a station, by which the chord turns about P_j: A_j = A(s_j - d_j) and
B_j = B(s_j + 3 d_j), with A and B the rounded edges. The system is tridiagonal and Newton's method
started at d = 0 needs some five steps, so the line is a function of the joint angles alone, as
smooth as the edges are.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from birdmb._typing import Array, ComplexArray, FloatArray
from birdmb.wing.rounded import RoundedPolyline, point, rounded_polyline, tangent

MAX_NEWTON_STEPS = 40
# Of the shift, a fraction of the wing's length: well below anything the loads can tell.
SHIFT_TOLERANCE = 1e-11


class PairedEdges(NamedTuple):
    """Stations of the lifting line from shoulder to tip, each (n, 3) m.

    `converged` is False when the Newton iteration did not reach its tolerance.
    """

    leading: Array
    trailing: Array
    converged: bool


@njit(cache=True)
def station_parameters(n: int) -> FloatArray:
    """Parameters in [0, 1] of n stations, drawn together towards the wing tip by a sine.

    The circulation falls to zero at the tip with a steep slope; the sine makes the trapezoidal sums
    over the trailing vortices there as accurate as elsewhere (Glauert's substitution).
    """
    return 0.5 * (1.0 - np.cos(np.pi * np.arange(n) / (n - 1)))


@njit(cache=True)
def _solve_tridiagonal(lower: Array, diagonal: Array, upper: Array, rhs: Array) -> Array:
    """Thomas algorithm; row i reads lower[i] x[i-1] + diagonal[i] x[i] + upper[i] x[i+1]."""
    n = diagonal.size
    c = np.empty(n)
    x = np.empty(n)
    c[0] = upper[0] / diagonal[0]
    x[0] = rhs[0] / diagonal[0]
    for i in range(1, n):
        pivot = diagonal[i] - lower[i] * c[i - 1]
        c[i] = upper[i] / pivot
        x[i] = (rhs[i] - lower[i] * x[i - 1]) / pivot
    for i in range(n - 2, -1, -1):
        x[i] -= c[i] * x[i + 1]
    return x


@njit(cache=True)
def _pair(
    leading: RoundedPolyline, trailing: RoundedPolyline, s: FloatArray, shift: Array
) -> tuple[Array, Array]:
    A = np.empty((s.size, 3), shift.dtype)
    B = np.empty((s.size, 3), shift.dtype)
    for j in range(s.size):
        point(leading, s[j] - shift[j], A[j])
        point(trailing, s[j] + 3.0 * shift[j], B[j])
    return A, B


@njit(cache=True)
def _obliqueness(A: Array, B: Array) -> Array:
    """Residual c_j . (P_{j+1} - P_{j-1}) (n,) m^2, zero at both ends."""
    n = A.shape[0]
    F = np.zeros(n, A.dtype)
    for j in range(1, n - 1):
        for i in range(3):
            step = 0.75 * (A[j + 1, i] - A[j - 1, i]) + 0.25 * (B[j + 1, i] - B[j - 1, i])
            F[j] += (B[j, i] - A[j, i]) * step
    return F


@njit(cache=True)
def _newton_step(
    leading: RoundedPolyline,
    trailing: RoundedPolyline,
    s: FloatArray,
    shift: FloatArray,
    A: FloatArray,
    B: FloatArray,
    F: FloatArray,
) -> FloatArray:
    """Change of the shifts that makes the residual `F` vanish to first order."""
    n = s.size
    dA = np.empty(3)
    dB = np.empty(3)
    dP = np.empty((n, 3))
    dc = np.empty((n, 3))
    for j in range(n):
        tangent(leading, s[j] - shift[j], dA)
        tangent(trailing, s[j] + 3.0 * shift[j], dB)
        for i in range(3):
            dP[j, i] = 0.75 * (dB[i] - dA[i])
            dc[j, i] = 3.0 * dB[i] + dA[i]
    lower = np.zeros(n)
    diagonal = np.ones(n)
    upper = np.zeros(n)
    for j in range(1, n - 1):
        diagonal[j] = 0.0
        for i in range(3):
            step = 0.75 * (A[j + 1, i] - A[j - 1, i]) + 0.25 * (B[j + 1, i] - B[j - 1, i])
            c = B[j, i] - A[j, i]
            diagonal[j] += dc[j, i] * step
            upper[j] += c * dP[j + 1, i]
            lower[j] -= c * dP[j - 1, i]
    return _solve_tridiagonal(lower, diagonal, upper, -F)


@njit(cache=True)
def orthogonal_line(
    leading_edge: ComplexArray, trailing_edge: ComplexArray, stations: int, rounding: float
) -> PairedEdges:
    """Pair the edges (vertices (m, 3) m) at `stations` stations, chords orthogonal to the line.

    The imaginary parts of the vertices are taken for infinitesimal rates (complex step): the last
    Newton step is repeated with them, which by the implicit function theorem is exact.
    """
    s = station_parameters(stations)
    lead = rounded_polyline(leading_edge.real.copy(), rounding)
    trail = rounded_polyline(trailing_edge.real.copy(), rounding)
    shift = np.zeros(stations)
    A, B = _pair(lead, trail, s, shift)
    F = _obliqueness(A, B)
    converged = False
    for _ in range(MAX_NEWTON_STEPS):
        step = _newton_step(lead, trail, s, shift, A, B, F)
        before = np.sum(F * F)
        damping = 1.0
        while True:
            A, B = _pair(lead, trail, s, shift + damping * step)
            F = _obliqueness(A, B)
            if np.sum(F * F) <= before or damping < 1e-3:
                break
            damping *= 0.5
        shift = shift + damping * step
        if np.max(np.abs(step)) < SHIFT_TOLERANCE:
            converged = True
            break
    lead_c = rounded_polyline(leading_edge, rounding)
    trail_c = rounded_polyline(trailing_edge, rounding)
    shift_c = shift.astype(np.complex128)
    A_c, B_c = _pair(lead_c, trail_c, s, shift_c)
    rate = _newton_step(lead, trail, s, shift, A, B, _obliqueness(A_c, B_c).imag.copy())
    A_c, B_c = _pair(lead_c, trail_c, s, shift_c + 1j * rate)
    return PairedEdges(A_c, B_c, converged)
