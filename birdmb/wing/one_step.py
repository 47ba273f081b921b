"""The published discretisation of the lifting line, kept to regress against (preset "published").

The reference program walks 16 points along each edge, joins them into chords, moves the quarter
points by a quarter of one step towards orthogonality and walks along the result once more. Neither
the line nor its rates are smooth: use it to compare, not to compute.
"""

from __future__ import annotations

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import Array, ComplexArray
from birdmb.wing.line import PairedEdges

RELAXATION = 0.25


@kernel
def _norm(v: Array) -> complex:
    return np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


@kernel
def _walk(path: Array, n: int) -> tuple[Array, Array]:
    """Legs and weights of n points at equal walking distance along the vertices of `path`.

    A stride that passes a vertex is measured straight to it from the last point, as published.
    Returns (n,) indices i and weights w: point = (1 - w) path[i] + w path[i + 1].
    """
    last = path.shape[0] - 1
    stride = 0.0 * path[0, 0]
    for i in range(last):
        stride += _norm(path[i + 1] - path[i])
    stride = stride / (n - 1)
    leg = np.zeros(n, np.int64)
    weight = np.zeros(n, path.dtype)
    here = path[0].copy()
    j = 0
    for i in range(1, n):
        if j < last:
            distance = _norm(path[j + 1] - here)
            while distance.real < stride.real:
                j += 1
                if j == last:
                    break
                distance += _norm(path[j + 1] - path[j])
        if j < last:
            leg[i] = j
            weight[i] = 1.0 - (distance - stride) / _norm(path[j + 1] - path[j])
            here = path[j] + weight[i] * (path[j + 1] - path[j])
        else:
            leg[i] = last - 1
            weight[i] = 1.0
            here = path[last].copy()
    return leg, weight


@kernel
def _sample(path: Array, leg: Array, weight: Array) -> Array:
    out = np.empty((leg.size, 3), path.dtype)
    for i in range(leg.size):
        out[i] = path[leg[i]] + weight[i] * (path[leg[i] + 1] - path[leg[i]])
    return out


@kernel
def _crossing(edge: Array, P: Array, direction: Array) -> Array:
    """Point where the straight line through the two vertices of `edge` nearest to the chord's line
    comes closest to it; the chord's line passes through P along the unit `direction`."""
    best = second = 0
    d_best = d_second = np.inf
    for j in range(edge.shape[0]):
        r = edge[j] - P
        along = np.sum(r * direction)
        d = _norm(r - along * direction).real
        if d < d_best:
            second, d_second = best, d_best
            best, d_best = j, d
        elif d < d_second:
            second, d_second = j, d
    v = edge[second] - edge[best]
    v = v / _norm(v)
    cosine = np.sum(v * direction)
    r = P - edge[best]
    s = (np.sum(r * v) - np.sum(r * direction) * cosine) / (1.0 - cosine * cosine)
    return edge[best] + s * v


@kernel
def one_step_line(
    leading_edge: ComplexArray, trailing_edge: ComplexArray, stations: int
) -> tuple[PairedEdges, Array]:
    """Pair the edges (vertices (m, 3) m) as the reference program does.

    Returns the pairs and the line (stations, 3) from which it takes the span direction, which is
    the one before its last resampling. Complex vertices carry rates, as in `orthogonal_line`.
    """
    edge_a = _sample(leading_edge, *_walk(leading_edge, stations))
    edge_b = _sample(trailing_edge, *_walk(trailing_edge, stations))
    leg, weight = _walk(0.75 * edge_a + 0.25 * edge_b, stations)
    A = _sample(edge_a, leg, weight)
    B = _sample(edge_b, leg, weight)
    P = 0.75 * A + 0.25 * B
    new_a = A.copy()
    new_b = B.copy()
    for j in range(1, stations - 1):
        along = P[j + 1] - P[j - 1]
        along = along / _norm(along)
        chord = B[j] - A[j]
        chord = chord - np.sum(along * chord) * along
        chord = chord / _norm(chord)
        new_a[j] = A[j] + RELAXATION * (_crossing(edge_a, P[j], chord) - A[j])
        new_b[j] = B[j] + RELAXATION * (_crossing(edge_b, P[j], chord) - B[j])
    line = 0.75 * new_a + 0.25 * new_b
    leg, weight = _walk(line, stations)
    pairs = PairedEdges(_sample(new_a, leg, weight), _sample(new_b, leg, weight), True)
    return pairs, line
