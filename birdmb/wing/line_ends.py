"""What the lifting line obeys at shoulder and wing tip.

In the equation for the pairing of the edges information runs from the short chords to the long
ones. Where chords grow away from an end, the line needs a condition there; where they shrink away
from it, the equation itself settles the line, and another condition would leave an error of
alternating sign that does not vanish on more stations. Differences to one side take its place.

A wing tip is *pointed* where both edges end in one point, which is then paired with itself. It is
*square* where they end a chord apart, on either side of a tip edge. The chords of a square tip that
needs a condition stay parallel to each other: as the last legs of the edges are straight, that is
the one solution of the equation in them which is smooth.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import Array
from birdmb.wing.rounded import RoundedPolyline, smooth_step

# Of the edges' lengths, between their ends at a pointed tip: more than round-off.
_POINTED = 1e-9


class LineEnds(NamedTuple):
    """Conditions at both ends; the weights run from 0 to 1."""

    shoulder: complex  # weight of the difference to one side beside the shoulder
    tip: complex  # weight of the difference to one side at a square tip
    direction: Array  # (3,) m, of the line at a square tip whose chords stay parallel
    square: bool  # whether the tip is square


@kernel
def _dot(a: Array, b: Array) -> complex:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


class EdgeEnds(NamedTuple):
    """Chords and directions of the edges, by their parameter, at shoulder and tip, (3,) m."""

    first_chord: Array
    leading_start: Array  # direction of the leading edge, outwards
    trailing_start: Array
    last_chord: Array
    leading_end: Array
    trailing_end: Array


@kernel
def edge_ends(leading: RoundedPolyline, trailing: RoundedPolyline) -> EdgeEnds:
    """Ends of two edges; their first and last legs are straight there."""
    leading_end, trailing_end = leading.tangent.copy(), trailing.tangent.copy()
    chord = trailing.start - leading.start
    last = np.empty_like(chord)
    for i in range(3):
        front, back = leading.start[i], trailing.start[i]
        front += leading.tangent[i]
        back += trailing.tangent[i]
        for k in range(leading.corner.size):
            leading_end[i] += leading.turn[k, i]
            front += (1.0 - leading.corner[k]) * leading.turn[k, i]
        for k in range(trailing.corner.size):
            trailing_end[i] += trailing.turn[k, i]
            back += (1.0 - trailing.corner[k]) * trailing.turn[k, i]
        last[i] = back - front
    return EdgeEnds(chord, leading.tangent, trailing.tangent, last, leading_end, trailing_end)


@kernel
def line_ends(edges: EdgeEnds, step: float) -> LineEnds:
    """Conditions for a line whose first and last stations are `step` of the parameter apart."""
    p, r, chord = edges.leading_end, edges.trailing_end, edges.last_chord
    shoulder = _narrowing(edges.first_chord, edges.leading_start, edges.trailing_start, step)
    tip = _narrowing(chord, -p, -r, step)
    square_p, square_r, both = _dot(p, p), _dot(r, r), _dot(p, r)
    square = _dot(chord, chord).real > _POINTED**2 * square_p.real
    # With steps p and k r along leading and trailing edge, chords stay parallel, and orthogonal to
    # the line, if (k r - p) . (3 p + k r) = 0.
    k = (np.sqrt(3.0 * square_p * square_r + both * both) - both) / square_r
    return LineEnds(shoulder, tip, 0.75 * p + 0.25 * k * r, square)


@kernel
def _narrowing(chord: Array, p: Array, r: Array, step: float) -> complex:
    """From 0 to 1 where the chord shrinks inwards, the edges running inwards as `p` and `r`.

    It passes over where one step along the edges changes the chord by about as much as one that
    turns it, so that the equation stays solvable.
    """
    width = step * np.sqrt(_dot(p, p) * _dot(r, r))
    return smooth_step(-0.75 * _dot(chord, r - p) / width)
