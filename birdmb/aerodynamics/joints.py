"""Loads of the wing about its joints and the hinges of its feathers."""

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.wing.arrays import WingArrays
from birdmb.wing.chain import Chain


@kernel
def joint_torques(
    wing: WingArrays, chain: Chain, position: FloatArray, force: FloatArray, beyond: FloatArray
) -> FloatArray:
    """Torques (J,) N m that the elements' loads exert about the joints of the right wing.

    Each segment carries the loads of its elements.

    `position` (N, 3) m of the loads from G, `force` (N, 3) N, both in body axes; `beyond` (N, 2)
    the fractions carried beyond elbow and wrist.
    """
    torque = np.zeros(wing.segment.size)
    moment = np.zeros((3, 3))
    for e in range(force.shape[0]):
        f = force[e]
        for bone in range(3):
            share = 1.0 if bone == 0 else beyond[e, bone - 1]
            r = position[e] - wing.root - chain.origin[bone]
            moment[bone, 0] += share * (r[1] * f[2] - r[2] * f[1])
            moment[bone, 1] += share * (r[2] * f[0] - r[0] * f[2])
            moment[bone, 2] += share * (r[0] * f[1] - r[1] * f[0])
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
