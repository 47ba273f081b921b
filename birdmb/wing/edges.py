"""Feathers and the two edges between which the wing is spanned.

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
HUMERUS, FOREARM, HAND = 0, 1, 2


@kernel
def _feather_root_aft(wing: WingArrays, bones: Chain, angles: Array, feather: int) -> Array:
    """Aft direction of the bones where a feather is rooted: at a joint, the two bones' mean."""
    bone = wing.feather_bone[feather]
    position = wing.feather_position[feather]
    if position == 0.0:
        R = bones.root_rotation[bone]
    elif position == 1.0:
        R = bones.rotation[bone]
    else:
        R = bones.root_rotation[bone]
        for j in range(wing.segment.size):
            if wing.segment[j] == bone and wing.twist[j]:
                R = rotate_about(R, wing.axis[j], position * angles[j])
    aft = -R[:, 0]
    if position == 1.0 and bone < HAND:
        aft = 0.5 * (aft - bones.root_rotation[bone + 1][:, 0])
    elif position == 0.0 and bone > HUMERUS:
        aft = 0.5 * (aft - bones.rotation[bone - 1][:, 0])
    return aft


@kernel
def trailing_edge(wing: WingArrays, bones: Chain, angles: Array) -> Array:
    """Vertices (F, 3) of the trailing edge: the tips of the feathers, from shoulder to wing tip."""
    n = wing.feather_length.size
    vertices = np.empty((n, 3), angles.dtype)
    for i in range(n):
        bone = wing.feather_bone[i]
        R = np.eye(3).astype(angles.dtype)
        for j in range(wing.segment.size):
            share = wing.feather_share[i, j]
            if share != 0.0:
                R = rotate_about(R, wing.axis[j], share * angles[j])
        # The rest angle turns from straight aft (0) to outwards along the bone (90 deg).
        direction = (
            -np.cos(wing.feather_rest_angle[i]) * R[:, 0]
            + np.sin(wing.feather_rest_angle[i]) * R[:, 1]
        )
        hinge = wing.feather_hinge[i]
        if hinge >= 0:
            direction = turned_about(bones.rotation[bone][:, 1], angles[hinge], direction)
        root = (
            bones.origin[bone]
            + wing.feather_position[i] * wing.bone_length[bone] * bones.rotation[bone][:, 1]
            + wing.half_thickness * _feather_root_aft(wing, bones, angles, i)
        )
        vertices[i] = root + wing.feather_length[i] * direction
    return vertices


def feather_ends(wing: WingArrays, bones: Chain, angles: Array) -> tuple[Array, Array]:
    """Roots and tips (F, 3) m of the feathers, from shoulder to wing tip."""
    # A feather of no length ends at its root.
    rootlets = wing._replace(feather_length=0.0 * wing.feather_length)
    return trailing_edge(rootlets, bones, angles), trailing_edge(wing, bones, angles)


@kernel
def leading_edge(wing: WingArrays, bones: Chain, tip: Array) -> Array:
    """Vertices (5, 3) of the leading edge: shoulder, abreast of the elbow, wrist, hand tip, `tip`.

    From the shoulder the edge runs straight to the wrist (the skin in front of the elbow); its own
    forward direction is square to that line and to the humerus' up axis.
    """
    wrist = bones.origin[HAND]
    arm = np.sqrt(wrist[0] * wrist[0] + wrist[1] * wrist[1] + wrist[2] * wrist[2])
    out = wrist / arm
    up = -bones.rotation[HUMERUS][:, 2]
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
    upper_arm = wing.bone_length[HUMERUS] / (wing.bone_length[HUMERUS] + wing.bone_length[FOREARM])
    a = wing.half_thickness
    vertices = np.empty((5, 3), wrist.dtype)
    vertices[0] = a * forward
    vertices[1] = upper_arm * wrist + a * forward
    vertices[2] = wrist + 0.5 * a * (forward + bones.root_rotation[HAND][:, 0])
    vertices[3] = bones.tip + a * bones.rotation[HAND][:, 0]
    vertices[4] = tip
    return vertices


@kernel
def wing_edges(wing: WingArrays, angles: Array) -> tuple[Array, Array]:
    """Vertices of the leading (5, 3) and trailing (F, 3) edge, m, at `angles` (A,) rad."""
    bones = joint_chain(wing, angles)
    trailing = trailing_edge(wing, bones, angles)
    leading = leading_edge(wing, bones, trailing[-1])
    if wing.square_tip:
        leading = _without_tip_edge(leading)
    return leading, trailing


@kernel
def _without_tip_edge(leading: Array) -> Array:
    """The leading edge (4, 3) m up to a square tip, its last leg lengthened if the tip is raked.

    The wing's last chord passes through the quarter point between this end and the trailing edge's.
    Lengthening by a third of what the tip edge reaches outwards takes that point half as far, which
    leaves the wing's area what it is.
    """
    hand = leading[-2] - leading[-3]
    reach = np.sum((leading[-1] - leading[-2]) * hand) / np.sum(hand * hand)
    shortened = leading[:-1].copy()
    shortened[-1] += reach / 3.0 * hand
    return shortened
