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
from birdmb.wing.rounded import RoundedPolyline, point, smooth_step, tangent

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


@kernel
def line_ends(leading: RoundedPolyline, trailing: RoundedPolyline, step: float) -> LineEnds:
    """Conditions for a line whose first and last stations are `step` of the parameter apart."""
    p = np.empty(3, leading.start.dtype)
    r = np.empty(3, leading.start.dtype)
    chord = trailing.start - leading.start
    tangent(leading, 0.0, p)
    tangent(trailing, 0.0, r)
    shoulder = _narrowing(chord, p, r, step)
    point(leading, 1.0, p)
    point(trailing, 1.0, r)
    chord = r - p
    tangent(leading, 1.0, p)
    tangent(trailing, 1.0, r)
    square = _dot(chord, chord).real > _POINTED**2 * _dot(p, p).real
    tip = _narrowing(chord, -p, -r, step)
    # With steps p and k r along leading and trailing edge, chords stay parallel, and orthogonal to
    # the line, if (k r - p) . (3 p + k r) = 0.
    length_p, length_r = np.sqrt(_dot(p, p)), np.sqrt(_dot(r, r))
    cosine = _dot(p, r) / (length_p * length_r)
    k = (np.sqrt(3.0 + cosine * cosine) - cosine) * length_p / length_r
    return LineEnds(shoulder, tip, 0.75 * p + 0.25 * k * r, square)


@kernel
def _narrowing(chord: Array, p: Array, r: Array, step: float) -> complex:
    """From 0 to 1 where the chord shrinks inwards, the edges running inwards as `p` and `r`.

    It passes over where one step along the edges changes the chord by about as much as one that
    turns it, so that the equation stays solvable.
    """
    width = step * np.sqrt(_dot(p, p) * _dot(r, r))
    return smooth_step(-0.75 * _dot(chord, r - p) / width)
