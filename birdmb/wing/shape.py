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
from birdmb.wing.edges import COMPLEX_STEP
from birdmb.wing.hinges import one_step_wing, orthogonal_wing
from birdmb.wing.line import PairedEdges, station_parameters
from birdmb.wing.rotations import cross
from birdmb.wing.rounded import leg_lengths, points, rounded_along, smooth_step


class WingShape(NamedTuple):
    """Right wing with N elements; origin at the shoulder, axes as its maker says."""

    line: FloatArray  # (2 N, 3) m, quarter-chord points: control, node, control, ... node at tip
    velocity: FloatArray  # (N, 3) m/s of the control points
    chord_direction: FloatArray  # (N, 3) unit, towards the trailing edge
    normal: FloatArray  # (N, 3) up
    span_direction: FloatArray  # (N, 3) outwards
    chord: FloatArray  # (N,) m
    profile: FloatArray  # (N, 3) lift slope 1/rad, zero-lift angle rad, moment coefficient
    distal_fraction: FloatArray  # (N, B - 1) of the element's load, carried beyond each bone
    converged: bool  # the line was found, and its chords point backwards along the first bone
    hinge_twist: FloatArray  # (H, N, 6) velocity (m) of the control point and spin of the chord
    chord_rate: (
        FloatArray  # (N, 3) m/s, rate of change of the chords, from leading to trailing edge
    )


@kernel
def _length(v: FloatArray) -> float:
    return np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


class LeadingArc(NamedTuple):
    """Where the controls of the elements are along the leading edge."""

    reached: FloatArray  # (N,) m, from the shoulder
    whole: float  # m, to the wing tip
    legs: FloatArray  # (m - 1,) m, of the edge's vertices


@kernel
def _leading_arc(leading: FloatArray, edge: FloatArray) -> LeadingArc:
    n = leading.shape[0] // 2
    reached, whole = np.empty(n), 0.0
    for j in range(2 * n):
        if j > 0:
            x = leading[j, 0] - leading[j - 1, 0]
            y = leading[j, 1] - leading[j - 1, 1]
            z = leading[j, 2] - leading[j - 1, 2]
            whole += np.sqrt(x * x + y * y + z * z)
        if j % 2 == 0:
            reached[j // 2] = whole
    return LeadingArc(reached, whole, leg_lengths(edge))


@kernel
def _distal_fractions(arc: LeadingArc, bone_end: FloatArray, rounding: float) -> FloatArray:
    """Fractions (N, B - 1) of each element's load that the bones beyond each joint carry.

    An element belongs to the bone abreast of its leading-edge point; around the corners the share
    passes over smoothly, for loads on a bone must not jump in time. `bone_end` (B,) tells where
    among the edge's vertices these are.
    """
    n, bones = arc.reached.size, bone_end.size
    corner, length = np.empty(bones), np.empty(bones)
    reached, leg = 0.0, 0
    for k in range(bones):
        while leg + 1 <= bone_end[k] and leg + 1 < arc.legs.size:
            reached += arc.legs[leg]
            leg += 1
        corner[k] = reached + (bone_end[k] - leg) * arc.legs[leg]
        length[k] = corner[k] - (corner[k - 1] if k > 0 else 0.0)
    distal_fraction = np.empty((n, bones - 1))
    for k in range(bones - 1):
        width = rounding * length[k] * length[k + 1] / (length[k] + length[k + 1])
        for e in range(n):
            distal_fraction[e, k] = smooth_step((arc.reached[e] - corner[k]) / width)
    return distal_fraction


@kernel
def _profiles(arc: LeadingArc, profile: FloatArray, rounding: float) -> FloatArray:
    """Profiles (N, 3) of the elements, from those of all (1, 3) or of each section (S, 3).

    Between sections linear along the leading edge, and rounded at them as the edge is: an element
    that moves along the edge over the beat must not meet a kink.
    """
    n = arc.reached.size
    if profile.shape[0] == 1:
        found = np.empty((n, 3))
        found[:] = profile[0]
        return found
    return points(rounded_along(profile, arc.legs, rounding), arc.reached / arc.whole)


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
        stations = station_parameters(2 * elements)
        return shape_of_edges(wing, angles, rates, stations, rounding, scheme, hinges)[0]
    except ZeroDivisionError:  # a leg or a chord without length
        return _no_shape(wing, elements)


@kernel
def shape_of_edges(
    wing: WingArrays,
    angles: FloatArray,
    rates: FloatArray,
    stations: FloatArray,
    rounding: float,
    published: bool | None,
    singly: IntArray,
) -> tuple[WingShape, FloatArray]:
    """As `wing_shape`, and twists (M, N, 6) per rate of each of the angles `singly` (M,).

    `stations` (2 N,) are the `station_parameters` of the line.
    Velocities (m) of the control points and angular velocities of the chords, which end with the
    hinges'. Raises `ZeroDivisionError` where an edge or a chord has no length.
    Of `published`, `None` is false: numba then does not compile what only the other line needs.
    """
    moving = angles + 1j * COMPLEX_STEP * rates
    bones = joint_chain(wing, moving)
    if published is not None:
        pairs, leading, guide, per_rate = one_step_wing(wing, bones, moving, stations.size, singly)
    else:
        pairs, leading, guide, per_rate = orthogonal_wing(
            wing, bones, moving, stations, rounding, singly
        )
    per_hinge = per_rate[singly.size - (wing.offset.size - wing.segment.size) :].copy()
    shape = _assemble(wing, pairs, guide, leading, per_hinge, rounding, published is not None)
    forward = bones.rotation[0, :, 0].real
    # Written so that what is not finite does not pass.
    sound = bool(np.isfinite(shape.line).all() and np.isfinite(shape.velocity).all())
    for e in range(stations.size // 2):
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
        shape.profile,
        shape.distal_fraction,
        shape.converged and sound,
        shape.hinge_twist,
        shape.chord_rate,
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
        profile=vectors,
        distal_fraction=np.zeros((elements, wing.bone_length.size - 1)),
        converged=False,
        hinge_twist=np.zeros((wing.offset.size - wing.segment.size, elements, 6)),
        chord_rate=vectors,
    )


@kernel
def _assemble(
    wing: WingArrays,
    pairs: PairedEdges,
    guide: FloatArray,
    edge: ComplexArray,
    hinge_twist: FloatArray,
    rounding: float,
    published: bool,
) -> WingShape:
    n = pairs.leading.shape[0] // 2
    line, velocity = np.empty((2 * n, 3)), np.empty((n, 3))
    for j in range(2 * n):
        for i in range(3):
            place = 0.75 * pairs.leading[j, i] + 0.25 * pairs.trailing[j, i]
            line[j, i] = place.real
            if j % 2 == 0:
                velocity[j // 2, i] = place.imag / COMPLEX_STEP
    chord = np.empty(n)
    chord_direction = np.empty((n, 3))
    chord_rate = np.empty((n, 3))
    normal = np.empty((n, 3))
    span = np.empty((n, 3))
    along = np.empty(3)
    for e in range(n):
        c, up, j = chord_direction[e], normal[e], 2 * e
        for i in range(3):
            across = pairs.trailing[j, i] - pairs.leading[j, i]
            c[i], chord_rate[e, i] = across.real, across.imag / COMPLEX_STEP
            # Central differences, one-sided at the shoulder: stations crowd there like j^2, so that
            # it errs by no more.
            along[i] = guide[j + 1, i] - guide[max(j - 1, 0), i]
        chord[e], step = _length(c), _length(along)
        for i in range(3):
            c[i] /= chord[e]
            along[i] /= step
        cross(c, along, up)
        if not published:
            size = _length(up)
            for i in range(3):
                up[i] /= size
        cross(up, c, span[e])
    arc = _leading_arc(pairs.leading.real.copy(), edge.real.copy())
    return WingShape(
        line,
        velocity,
        chord_direction,
        normal,
        span,
        chord,
        _profiles(arc, wing.profile, rounding),
        _distal_fractions(arc, wing.bone_end, rounding),
        pairs.converged,
        hinge_twist,
        chord_rate,
    )


@kernel
def turned_rows(vectors: FloatArray, R: FloatArray) -> FloatArray:
    """Vectors (n, 3) as seen from axes in which their own axes are `R` (3, 3)."""
    # Libraries for products of matrices take several times as long for so few numbers.
    turned = np.empty(vectors.shape)
    xx, xy, xz = R[0, 0], R[0, 1], R[0, 2]
    yx, yy, yz = R[1, 0], R[1, 1], R[1, 2]
    zx, zy, zz = R[2, 0], R[2, 1], R[2, 2]
    for k in range(len(vectors)):
        x, y, z = vectors[k, 0], vectors[k, 1], vectors[k, 2]
        turned[k, 0] = xx * x + xy * y + xz * z
        turned[k, 1] = yx * x + yy * y + yz * z
        turned[k, 2] = zx * x + zy * y + zz * z
    return turned


@kernel
def turned(shape: WingShape, R: FloatArray, spin: FloatArray) -> WingShape:
    """The shape seen from axes in which its own axes are `R` (3, 3) and turn at `spin` (3,) rad/s.

    `spin` is given in the new axes and acts about the shoulder.
    """
    line, velocity = turned_rows(shape.line, R), turned_rows(shape.velocity, R)
    chord_rate = turned_rows(shape.chord_rate, R)
    chord_direction = turned_rows(shape.chord_direction, R)
    sx, sy, sz = spin[0], spin[1], spin[2]
    for e in range(velocity.shape[0]):
        x, y, z = line[2 * e, 0], line[2 * e, 1], line[2 * e, 2]
        velocity[e, 0] += sy * z - sz * y
        velocity[e, 1] += sz * x - sx * z
        velocity[e, 2] += sx * y - sy * x
        x, y, z = chord_direction[e, 0], chord_direction[e, 1], chord_direction[e, 2]
        size = shape.chord[e]
        chord_rate[e, 0] += size * (sy * z - sz * y)
        chord_rate[e, 1] += size * (sz * x - sx * z)
        chord_rate[e, 2] += size * (sx * y - sy * x)
    twists = np.ascontiguousarray(shape.hinge_twist)
    hinge_twist = turned_rows(twists.reshape(-1, 3), R).reshape(twists.shape)
    return WingShape(
        line,
        velocity,
        chord_direction,
        turned_rows(shape.normal, R),
        turned_rows(shape.span_direction, R),
        shape.chord,
        shape.profile,
        shape.distal_fraction,
        shape.converged,
        hinge_twist,
        chord_rate,
    )
