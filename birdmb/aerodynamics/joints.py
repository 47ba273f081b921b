"""Loads of the wing about its joints and the hinges of its feathers, by virtual work."""

from __future__ import annotations

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.wing.chain import Chain


@kernel
def twist_per_joint_rate(
    root: FloatArray,
    segment: IntArray,
    chain: Chain,
    position: FloatArray,
    distal_fraction: FloatArray,
) -> FloatArray:
    """Twists (J, N, 6) per rate of each joint of the points that its loads act at.

    Velocities (m) and angular velocities. Each segment carries the loads of its elements: where a
    part of an element's load is on bones beyond a joint, only that part moves. `root` (3,) m is the
    shoulder's place from G, `segment` (J,) the bone that each joint carries, `position` (N, 3) m
    that of the loads from G, all in body axes; `distal_fraction` (N, B - 1) of a load is carried
    beyond each of the B bones.
    """
    joints, n = segment.size, position.shape[0]
    twist = np.empty((joints, n, 6))
    for j in range(joints):
        bone = segment[j]
        ax, ay, az = chain.axis[j, 0], chain.axis[j, 1], chain.axis[j, 2]
        ox = root[0] + chain.origin[bone, 0]
        oy = root[1] + chain.origin[bone, 1]
        oz = root[2] + chain.origin[bone, 2]
        for e in range(n):
            share = 1.0 if bone == 0 else distal_fraction[e, bone - 1]
            x, y, z = position[e, 0] - ox, position[e, 1] - oy, position[e, 2] - oz
            twist[j, e, 0] = share * (ay * z - az * y)
            twist[j, e, 1] = share * (az * x - ax * z)
            twist[j, e, 2] = share * (ax * y - ay * x)
            twist[j, e, 3], twist[j, e, 4], twist[j, e, 5] = share * ax, share * ay, share * az
    return twist


@kernel
def torques_along(twist_per_rate: FloatArray, loads: FloatArray) -> FloatArray:
    """Torques (R, A) N m about joints or hinges of loads (R, N, 6, 1) N and N m on the elements.

    `twist_per_rate` (A, N, 6) m and 1 are the velocities and angular velocities of the points that
    the loads act at; all in body axes.
    """
    angles, n, _ = twist_per_rate.shape
    each = np.ascontiguousarray(loads).reshape(len(loads), 6 * n)
    return each @ twist_per_rate.reshape(angles, 6 * n).T


@kernel
def torques(twist_per_rate: FloatArray, loads: FloatArray) -> FloatArray:
    """As `torques_along`, (A,), of one set of loads (N, 6)."""
    return torques_along(twist_per_rate, loads.reshape(1, len(loads), 6, 1))[0]
