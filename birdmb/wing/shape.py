"""The wing as the aerodynamics sees it: a lifting line with chords, and how fast it moves.

Stations alternate between control points (even, the first at the shoulder) and nodes (odd, the last
at the wing tip), so N elements take 2 N stations; see `birdmb.aerodynamics.elements` for the gap
over the body.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import ComplexArray, FloatArray, IntArray
from birdmb.wing.arrays import WingArrays
from birdmb.wing.chain import joint_chain
from birdmb.wing.edges import COMPLEX_STEP, HUMERUS
from birdmb.wing.hinges import one_step_wing, orthogonal_wing
from birdmb.wing.line import PairedEdges
from birdmb.wing.rounded import smooth_step


class WingShape(NamedTuple):
    """Right wing with N elements; origin at the shoulder, axes as its maker says."""

    line: FloatArray  # (2 N, 3) m, quarter-chord points: control, node, control, ... node at tip
    velocity: FloatArray  # (N, 3) m/s of the control points
    chord_direction: FloatArray  # (N, 3) unit, towards the trailing edge
    normal: FloatArray  # (N, 3) up
    span_direction: FloatArray  # (N, 3) outwards
    chord: FloatArray  # (N,) m
    distal_fraction: FloatArray  # (N, 2) of the element's load, carried beyond the elbow, the wrist
    converged: bool  # the lifting line was found, and its chords point backwards along the humerus
    hinge_velocity: FloatArray  # (H, N, 3) m, of the control points per rate of each hinge


@kernel
def _length(v: FloatArray) -> float:
    return np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


@kernel
def _cross(a: FloatArray, b: FloatArray, out: FloatArray) -> None:
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]


@kernel
def _distal_fractions(leading: FloatArray, edge: FloatArray, rounding: float) -> FloatArray:
    """Fractions (N, 2) of each element's load that the bones beyond elbow and wrist carry.

    An element belongs to the bone abreast of its leading-edge point; around the corners the share
    passes over smoothly, for loads on a bone must not jump in time.
    """
    legs = np.empty(edge.shape[0] - 1)
    for i in range(legs.size):
        legs[i] = _length(edge[i + 1] - edge[i])
    n = leading.shape[0] // 2
    distal_fraction = np.empty((n, 2))
    reached = 0.0
    for j in range(2 * n):
        if j > 0:
            x = leading[j, 0] - leading[j - 1, 0]
            y = leading[j, 1] - leading[j - 1, 1]
            z = leading[j, 2] - leading[j - 1, 2]
            reached += np.sqrt(x * x + y * y + z * z)
        if j % 2 == 0:
            corner = 0.0
            for k in range(2):
                corner += legs[k]
                width = rounding * legs[k] * legs[k + 1] / (legs[k] + legs[k + 1])
                distal_fraction[j // 2, k] = smooth_step((reached - corner) / width)
    return distal_fraction


def wing_shape(
    wing: WingArrays,
    angles: FloatArray,
    rates: FloatArray,
    elements: int,
    rounding: float,
    published: bool,
) -> WingShape:
    """Shape and velocities of the right wing for `angles` (A,) rad and `rates` (A,) rad/s.

    Of the joints, then of the feathers' hinges. Body axes; velocities relative to the body.
    `published` takes the reference program's line instead of the orthogonal one.
    """
    try:
        hinges = np.arange(wing.segment.size, wing.offset.size)
        scheme = published or None
        return shape_of_edges(wing, angles, rates, elements, rounding, scheme, hinges)[0]
    except ZeroDivisionError:  # a leg or a chord without length
        return _no_shape(wing, elements)


@kernel
def shape_of_edges(
    wing: WingArrays,
    angles: FloatArray,
    rates: FloatArray,
    elements: int,
    rounding: float,
    published: bool | None,
    singly: IntArray,
) -> tuple[WingShape, FloatArray]:
    """As `wing_shape`, and velocities (M, N, 3) m per rate of each of the angles `singly` (M,).

    These end with the hinges'. Raises `ZeroDivisionError` where an edge or a chord has no length.
    Of `published`, `None` is false: numba then does not compile what only the other line needs.
    """
    moving = angles + 1j * COMPLEX_STEP * rates
    if published is not None:
        pairs, leading, guide, per_rate = one_step_wing(wing, moving, 2 * elements, singly)
    else:
        pairs, leading, guide, per_rate = orthogonal_wing(
            wing, moving, 2 * elements, rounding, singly
        )
    per_hinge = per_rate[singly.size - (wing.offset.size - wing.segment.size) :].copy()
    shape = _assemble(pairs, guide, leading, per_hinge, rounding, published is not None)
    forward = joint_chain(wing, moving).rotation[HUMERUS, :, 0].real
    # Written so that what is not finite does not pass.
    sound = bool(np.isfinite(shape.line).all() and np.isfinite(shape.velocity).all())
    for e in range(elements):
        aft = 0.0
        for i in range(3):
            aft -= shape.chord_direction[e, i] * forward[i]
        sound = sound and aft > 0.0
    shape = WingShape(
        shape.line,
        shape.velocity,
        shape.chord_direction,
        shape.normal,
        shape.span_direction,
        shape.chord,
        shape.distal_fraction,
        shape.converged and sound,
        shape.hinge_velocity,
    )
    return shape, per_rate


def _no_shape(wing: WingArrays, elements: int) -> WingShape:
    vectors = np.full((elements, 3), np.nan)
    return WingShape(
        line=np.full((2 * elements, 3), np.nan),
        velocity=vectors,
        chord_direction=vectors,
        normal=vectors,
        span_direction=vectors,
        chord=vectors[:, 0].copy(),
        distal_fraction=np.zeros((elements, 2)),
        converged=False,
        hinge_velocity=np.zeros((wing.offset.size - wing.segment.size, elements, 3)),
    )


@kernel
def _assemble(
    pairs: PairedEdges,
    guide: ComplexArray,
    edge: ComplexArray,
    hinge_velocity: FloatArray,
    rounding: float,
    published: bool,
) -> WingShape:
    n = pairs.leading.shape[0] // 2
    line = 0.75 * pairs.leading + 0.25 * pairs.trailing
    chord = np.empty(n)
    chord_direction = np.empty((n, 3))
    normal = np.empty((n, 3))
    span = np.empty((n, 3))
    along = np.empty(3)
    for e in range(n):
        c, up, j = chord_direction[e], normal[e], 2 * e
        for i in range(3):
            c[i] = pairs.trailing[j, i].real - pairs.leading[j, i].real
            # Central differences, one-sided at the shoulder: stations crowd there like j^2, so that
            # it errs by no more.
            along[i] = guide[j + 1, i].real - guide[max(j - 1, 0), i].real
        chord[e], step = _length(c), _length(along)
        for i in range(3):
            c[i] /= chord[e]
            along[i] /= step
        _cross(c, along, up)
        if not published:
            size = _length(up)
            for i in range(3):
                up[i] /= size
        _cross(up, c, span[e])
    distal_fraction = _distal_fractions(pairs.leading.real.copy(), edge.real.copy(), rounding)
    velocity = line[0::2].imag / COMPLEX_STEP
    return WingShape(
        line.real.copy(),
        velocity,
        chord_direction,
        normal,
        span,
        chord,
        distal_fraction,
        pairs.converged,
        hinge_velocity,
    )


@kernel
def turned(shape: WingShape, R: FloatArray, spin: FloatArray) -> WingShape:
    """The shape seen from axes in which its own axes are `R` (3, 3) and turn at `spin` (3,) rad/s.

    `spin` is given in the new axes and acts about the shoulder.
    """
    line = shape.line @ R.T
    velocity = shape.velocity @ R.T
    for e in range(velocity.shape[0]):
        p = line[2 * e]
        velocity[e, 0] += spin[1] * p[2] - spin[2] * p[1]
        velocity[e, 1] += spin[2] * p[0] - spin[0] * p[2]
        velocity[e, 2] += spin[0] * p[1] - spin[1] * p[0]
    hinge_velocity = np.empty_like(shape.hinge_velocity)
    for h in range(hinge_velocity.shape[0]):
        hinge_velocity[h] = shape.hinge_velocity[h] @ R.T
    return WingShape(
        line,
        velocity,
        shape.chord_direction @ R.T,
        shape.normal @ R.T,
        shape.span_direction @ R.T,
        shape.chord,
        shape.distal_fraction,
        shape.converged,
        hinge_velocity,
    )
