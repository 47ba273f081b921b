"""Joint axes and bone origins of the right wing, for torques about the joints."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.wing.arrays import JointArrays, WingArrays
from birdmb.wing.rotations import rotate_about


class Chain(NamedTuple):
    """The chain in body axes, origin at the shoulder joint."""

    axis: FloatArray  # (J, 3) unit vectors
    origin: FloatArray  # (3, 3) m, where humerus, forearm and hand start


@kernel
def joint_chain(wing: WingArrays | JointArrays, angles: FloatArray) -> Chain:
    """Axes of the joints and origins of the bones at `angles` (J,) rad; more are not read."""
    n = wing.segment.size
    axis = np.empty((n, 3))
    origin = np.zeros((3, 3))
    R = np.eye(3)
    joint = 0
    for bone in range(3):
        while joint < n and wing.segment[joint] == bone:
            axis[joint] = R @ wing.axis[joint]
            R = rotate_about(R, wing.axis[joint], angles[joint])
            joint += 1
        if bone < 2:
            origin[bone + 1] = origin[bone] + wing.bone_length[bone] * R[:, 1]
    return Chain(axis, origin)


@kernel
def frame_after(wing: WingArrays | JointArrays, angles: FloatArray, joints: int) -> FloatArray:
    """Rotation (3, 3) of the frame behind the first `joints` joints, to body axes."""
    R = np.eye(3)
    for j in range(joints):
        R = rotate_about(R, wing.axis[j], angles[j])
    return R


def joints_turning_the_whole(wing: WingArrays) -> int:
    """How many joints at the shoulder only turn a shape that the other joints determine.

    Zero if a feather follows one of them by another share than fully, or one is a twist.
    """
    shoulder = int(np.count_nonzero(wing.segment == 0))
    whole = (wing.feather_share[:, :shoulder] == 1.0).all()
    return shoulder if whole and not wing.twist[:shoulder].any() else 0
