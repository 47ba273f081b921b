"""Loads of the wing about its joints and the hinges of its feathers, by virtual work."""

from __future__ import annotations

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.wing.chain import Chain


@kernel
def velocity_per_joint_rate(
    root: FloatArray,
    segment: IntArray,
    chain: Chain,
    position: FloatArray,
    distal_fraction: FloatArray,
) -> FloatArray:
    """Velocities (J, N, 3) m per rate of each joint of the points that its loads act at.

    Each segment carries the loads of its elements: where a part of an element's load is on bones
    beyond a joint, only that part moves. `root` (3,) m is the shoulder's place from G, `segment`
    (J,) the bone that each joint carries, `position` (N, 3) m that of the loads from G, all in body
    axes; `distal_fraction` (N, 2) of a load is carried beyond elbow and wrist.
    """
    joints, n = segment.size, position.shape[0]
    velocity = np.empty((joints, n, 3))
    for j in range(joints):
        bone = segment[j]
        ax, ay, az = chain.axis[j, 0], chain.axis[j, 1], chain.axis[j, 2]
        ox = root[0] + chain.origin[bone, 0]
        oy = root[1] + chain.origin[bone, 1]
        oz = root[2] + chain.origin[bone, 2]
        for e in range(n):
            share = 1.0 if bone == 0 else distal_fraction[e, bone - 1]
            x, y, z = position[e, 0] - ox, position[e, 1] - oy, position[e, 2] - oz
            velocity[j, e, 0] = share * (ay * z - az * y)
            velocity[j, e, 1] = share * (az * x - ax * z)
            velocity[j, e, 2] = share * (ax * y - ay * x)
    return velocity


@kernel
def torques_along(velocity_per_rate: FloatArray, forces: FloatArray) -> FloatArray:
    """Torques (R, A) N m about joints or hinges of loads (R, N, 3, 1) N on the elements.

    `velocity_per_rate` (A, N, 3) m are the velocities of the points that the loads act at; all in
    body axes.
    """
    angles, n, _ = velocity_per_rate.shape
    each = np.ascontiguousarray(forces).reshape(len(forces), 3 * n)
    return each @ velocity_per_rate.reshape(angles, 3 * n).T


@kernel
def torques(velocity_per_rate: FloatArray, force: FloatArray) -> FloatArray:
    """As `torques_along`, (A,), of one set of loads (N, 3) N."""
    return torques_along(velocity_per_rate, force.reshape(1, len(force), 3, 1))[0]
