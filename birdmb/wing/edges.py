"""The two edges between which the wing is spanned: by feathers, or by sections along the bones.

Frame: the right wing, body axes (x forward, y right, z down), origin at the shoulder joint. The
kernels take complex angles as well, for exact time derivatives (`birdmb.wing.chain`).
Angles (A,) are those of the joints, then those of the feathers' hinges.
"""

from __future__ import annotations

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import Array
from birdmb.wing.arrays import WingArrays
from birdmb.wing.chain import Chain, joint_chain
from birdmb.wing.rotations import rotate_about, turned_about

# Small enough for its square to vanish beside 1, large enough to stay clear of denormal numbers.
COMPLEX_STEP = 1e-30


@kernel
def _aft_at(wing: WingArrays, bones: Chain, angles: Array, bone: int, position: float) -> Array:
    """Aft direction (3,) at a position along a bone; at a joint the mean of both bones'."""
    aft = np.empty(3, angles.dtype)
    # Written out, here and below: for three numbers, operations on arrays take ten times as long.
    if 0.0 < position < 1.0:
        R = bones.root_rotation[bone]
        for j in range(wing.segment.size):
            if wing.segment[j] == bone and wing.twist[j]:
                R = rotate_about(R, wing.axis[j], position * angles[j])
        for i in range(3):
            aft[i] = -R[i, 0]
        return aft
    inner, outer = (bone - 1, bone) if position == 0.0 else (bone, bone + 1)
    for i in range(3):
        if inner < 0:
            aft[i] = -bones.root_rotation[outer, i, 0]
        elif outer == wing.bone_length.size:
            aft[i] = -bones.rotation[inner, i, 0]
        else:
            aft[i] = -0.5 * (bones.rotation[inner, i, 0] + bones.root_rotation[outer, i, 0])
    return aft


@kernel
def feather_tip(wing: WingArrays, bones: Chain, angles: Array, feather: int) -> Array:
    """The tip (3,) of one feather."""
    bone, count = wing.feather_bone[feather], wing.segment.size
    followed = 0
    while followed < count and wing.feather_share[feather, followed] == 1.0:
        followed += 1
    R = bones.frame[followed]
    for j in range(followed, count):
        share = wing.feather_share[feather, j]
        if share != 0.0:
            R = rotate_about(R, wing.axis[j], share * angles[j])
    # The rest angle turns from straight aft (0) to outwards along the bone (90 deg).
    rest = wing.feather_rest_angle[feather]
    backwards, outwards = -np.cos(rest), np.sin(rest)
    direction = np.empty(3, angles.dtype)
    for i in range(3):
        direction[i] = backwards * R[i, 0] + outwards * R[i, 1]
    hinge = wing.feather_hinge[feather]
    if hinge >= 0:
        direction = turned_about(bones.rotation[bone, :, 1], angles[hinge], direction)
    position, tip = wing.feather_position[feather], np.empty(3, angles.dtype)
    aft = _aft_at(wing, bones, angles, bone, position)
    reach = position * wing.bone_length[bone]
    for i in range(3):
        root = bones.origin[bone, i] + reach * bones.rotation[bone, i, 1]
        tip[i] = root + wing.half_thickness * aft[i] + wing.feather_length[feather] * direction[i]
    return tip


@kernel
def trailing_edge(wing: WingArrays, bones: Chain, angles: Array) -> Array:
    """Vertices (F, 3) of the trailing edge: the tips of the feathers, from shoulder to wing tip."""
    vertices = np.empty((wing.feather_length.size, 3), angles.dtype)
    for feather in range(vertices.shape[0]):
        tip = feather_tip(wing, bones, angles, feather)
        for i in range(3):
            vertices[feather, i] = tip[i]
    return vertices


def feather_ends(wing: WingArrays, bones: Chain, angles: Array) -> tuple[Array, Array]:
    """Roots and tips (F, 3) m of the feathers, from shoulder to wing tip; none of sections."""
    # A feather of no length ends at its root.
    rootlets = wing._replace(feather_length=0.0 * wing.feather_length)
    return trailing_edge(rootlets, bones, angles), trailing_edge(wing, bones, angles)


@kernel
def leading_edge(wing: WingArrays, bones: Chain, tip: Array) -> Array:
    """Vertices (B + 2, 3) of the leading edge: shoulder, abreast of each bone's end, `tip`.

    From the shoulder the edge runs straight to the end of the bone `skin` (the skin before an
    elbow); its own forward direction is square to that line and to the first bone's up axis. From
    there it follows the bones.
    """
    count, skin, a = wing.bone_length.size, wing.skin, wing.half_thickness
    stretched = bones.tip if skin == count - 1 else bones.origin[skin + 1]
    reach = np.sqrt(
        stretched[0] * stretched[0] + stretched[1] * stretched[1] + stretched[2] * stretched[2]
    )
    out = stretched / reach
    up = -bones.rotation[0][:, 2]
    forward = np.array(
        [
            up[1] * out[2] - up[2] * out[1],
            up[2] * out[0] - up[0] * out[2],
            up[0] * out[1] - up[1] * out[0],
        ]
    )
    forward = forward / np.sqrt(
        forward[0] * forward[0] + forward[1] * forward[1] + forward[2] * forward[2]
    )
    vertices = np.empty((count + 2, 3), stretched.dtype)
    vertices[0] = a * forward
    along, whole = 0.0, wing.bone_length[: skin + 1].sum()
    for bone in range(skin):
        along += wing.bone_length[bone]
        vertices[bone + 1] = along / whole * stretched + a * forward
    for bone in range(skin, count):
        end = bones.tip if bone == count - 1 else bones.origin[bone + 1]
        inner = forward if bone == skin else bones.rotation[bone][:, 0]
        if bone == count - 1:
            vertices[bone + 1] = end + a * inner
        else:
            vertices[bone + 1] = end + 0.5 * a * (inner + bones.root_rotation[bone + 1][:, 0])
    vertices[count + 1] = tip
    return vertices


@kernel
def wing_edges(wing: WingArrays, angles: Array) -> tuple[Array, Array]:
    """Vertices (m, 3) of the leading and of the trailing edge, m, at `angles` (A,) rad."""
    return edges_along(wing, joint_chain(wing, angles), angles)


@kernel
def edges_along(wing: WingArrays, bones: Chain, angles: Array) -> tuple[Array, Array]:
    """As `wing_edges`, of bones that are placed."""
    if wing.section_bone.size > 0:
        return section_ends(wing, bones, angles)
    trailing = trailing_edge(wing, bones, angles)
    return leading_edge_to(wing, bones, trailing[-1]), trailing


@kernel
def leading_edge_to(wing: WingArrays, bones: Chain, tip: Array) -> Array:
    """Vertices (m, 3) of the leading edge of feathers, of which the last ends at `tip` (3,)."""
    leading = leading_edge(wing, bones, tip)
    if wing.square_tip:
        leading = _without_tip_edge(leading)
    return leading


@kernel
def section_ends(wing: WingArrays, bones: Chain, angles: Array) -> tuple[Array, Array]:
    """Leading and trailing ends, each (S, 3) m, of the sections, from the shoulder outwards."""
    n = wing.section_bone.size
    leading, trailing = np.empty((n, 3), angles.dtype), np.empty((n, 3), angles.dtype)
    for i in range(n):
        bone, position = wing.section_bone[i], wing.section_position[i]
        out = _out_at(wing, bones, bone, position)
        # Square to the bone, which the mean of two directions need not be.
        forward = -_aft_at(wing, bones, angles, bone, position)
        forward = _unit(forward - np.sum(forward * out) * out)
        forward = turned_about(out, wing.section_twist[i], forward)
        place = bones.origin[bone] + position * wing.bone_length[bone] * bones.rotation[bone][:, 1]
        quarter, chord = place + wing.section_offset[i] * forward, wing.section_chord[i]
        leading[i] = quarter + 0.25 * chord * forward
        trailing[i] = quarter - 0.75 * chord * forward
    return leading, trailing


@kernel
def _out_at(wing: WingArrays, bones: Chain, bone: int, position: float) -> Array:
    """Unit vector outwards along a bone; at a joint midway between both bones."""
    out = bones.rotation[bone][:, 1].copy()
    if position == 1.0 and bone < wing.bone_length.size - 1:
        out = _unit(out + bones.rotation[bone + 1][:, 1])
    elif position == 0.0 and bone > 0:
        out = _unit(out + bones.rotation[bone - 1][:, 1])
    return out


@kernel
def _unit(v: Array) -> Array:
    return v / np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


@kernel
def _without_tip_edge(leading: Array) -> Array:
    """The leading edge (B + 1, 3) m up to a square tip, its last leg longer if the tip is raked.

    The wing's last chord passes through the quarter point between this end and the trailing edge's.
    Lengthening by a third of what the tip edge reaches outwards takes that point half as far, which
    leaves the wing's area what it is.
    """
    hand = leading[-2] - leading[-3]
    reach = np.sum((leading[-1] - leading[-2]) * hand) / np.sum(hand * hand)
    shortened = leading[:-1].copy()
    shortened[-1] += reach / 3.0 * hand
    return shortened
