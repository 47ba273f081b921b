"""The joint chain of the right wing: where its joints and bones are.

Body axes, origin at the shoulder joint. The kernel takes complex angles as well: with q + i h q' (h
tiny) the imaginary part of everything it returns is h times its exact time derivative (complex
step; Squire and Trapp, SIAM Rev. 40, 1998).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import Array
from birdmb.wing.arrays import JointArrays, WingArrays
from birdmb.wing.rotations import rotate_about


class Chain(NamedTuple):
    """Joints and B bones of the right wing, from the shoulder outwards."""

    axis: Array  # (J, 3) unit vectors of the joints
    frame: Array  # (J + 1, 3, 3) behind so many joints, to body axes
    origin: Array  # (B, 3) m, where each bone starts
    tip: Array  # (3,) m, end of the last bone
    rotation: Array  # (B, 3, 3) each bone's frame to body axes
    root_rotation: Array  # (B, 3, 3) the same without the bone's own twist joints


@kernel
def joint_chain(wing: WingArrays | JointArrays, angles: Array) -> Chain:
    """Place joints and bones at `angles` (J,) rad, real or complex; more are not read."""
    n, bones = wing.segment.size, wing.bone_length.size
    axis = np.zeros((n, 3), angles.dtype)
    frame = np.empty((n + 1, 3, 3), angles.dtype)
    origin = np.zeros((bones + 1, 3), angles.dtype)
    rotation = np.empty((bones, 3, 3), angles.dtype)
    root_rotation = np.empty((bones, 3, 3), angles.dtype)
    R = np.eye(3).astype(angles.dtype)
    _copy(R, frame[0])
    joint = 0
    for bone in range(bones):
        untwisted, twists = R, False
        while joint < n and wing.segment[joint] == bone:
            for i in range(3):
                for m in range(3):
                    axis[joint, i] += R[i, m] * wing.axis[joint, m]
            R = rotate_about(R, wing.axis[joint], angles[joint])
            if wing.twist[joint]:
                twists = True
            elif twists:
                untwisted = rotate_about(untwisted, wing.axis[joint], angles[joint])
            else:
                untwisted = R
            joint += 1
            _copy(R, frame[joint])
        _copy(R, rotation[bone])
        _copy(untwisted, root_rotation[bone])
        for i in range(3):
            origin[bone + 1, i] = origin[bone, i] + wing.bone_length[bone] * R[i, 1]
    return Chain(axis, frame, origin[:bones], origin[bones], rotation, root_rotation)


@kernel
def _copy(matrix: Array, out: Array) -> None:
    """Copy a matrix (3, 3); numba's own assignment takes longer than such a matrix's product."""
    for i in range(3):
        for j in range(3):
            out[i, j] = matrix[i, j]


def joints_turning_the_whole(wing: WingArrays) -> int:
    """How many joints at the shoulder only turn a shape that the other joints determine.

    Zero if a feather follows one of them by another share than fully, or one is a twist.
    """
    shoulder = int(np.count_nonzero(wing.segment == 0))
    whole = (wing.feather_share[:, :shoulder] == 1.0).all()
    return shoulder if whole and not wing.twist[:shoulder].any() else 0
