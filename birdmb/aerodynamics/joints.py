"""Loads of the wing about its joints and the hinges of its feathers."""

from __future__ import annotations

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.wing.arrays import WingArrays
from birdmb.wing.chain import Chain


@kernel
def joint_torques(
    wing: WingArrays,
    chain: Chain,
    position: FloatArray,
    force: FloatArray,
    distal_fraction: FloatArray,
) -> FloatArray:
    """Torques (J,) N m that the elements' loads exert about the joints of the right wing.

    Each segment carries the loads of its elements.

    `position` (N, 3) m of the loads from G, `force` (N, 3) N, both in body axes; `distal_fraction`
    (N, 2) is carried beyond elbow and wrist.
    """
    torque = np.zeros(wing.segment.size)
    moment = np.zeros((3, 3))
    for e in range(force.shape[0]):
        fx, fy, fz = force[e]
        for bone in range(3):
            share = 1.0 if bone == 0 else distal_fraction[e, bone - 1]
            # Numbers, not vectors: making these would take most of the time.
            x = position[e, 0] - wing.root[0] - chain.origin[bone, 0]
            y = position[e, 1] - wing.root[1] - chain.origin[bone, 1]
            z = position[e, 2] - wing.root[2] - chain.origin[bone, 2]
            moment[bone, 0] += share * (y * fz - z * fy)
            moment[bone, 1] += share * (z * fx - x * fz)
            moment[bone, 2] += share * (x * fy - y * fx)
    for j in range(torque.size):
        for i in range(3):
            torque[j] += chain.axis[j, i] * moment[wing.segment[j], i]
    return torque


@kernel
def hinge_torques(hinge_velocity: FloatArray, force: FloatArray) -> FloatArray:
    """Torques (H,) N m that the elements' loads exert about the feathers' hinges, by virtual work.

    `hinge_velocity` (H, N, 3) m are the elements' velocities per rate of each hinge, `force`
    (N, 3) N their loads, both in body axes.
    """
    torque = np.zeros(hinge_velocity.shape[0])
    for h in range(torque.size):
        for e in range(force.shape[0]):
            for i in range(3):
                torque[h] += hinge_velocity[h, e, i] * force[e, i]
    return torque
