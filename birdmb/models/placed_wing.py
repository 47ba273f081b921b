"""A wing of a bird, hung up on the body and turned by the joints that carry it as a whole."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.aerodynamics.elements import Elements, place_elements
from birdmb.aerodynamics.joints import twist_per_joint_rate
from birdmb.wing.arrays import JointArrays
from birdmb.wing.chain import Chain, joint_chain
from birdmb.wing.shape import WingShape, turned, turned_rows


class PlacedWing(NamedTuple):
    """A right wing, or a left one mirrored onto the right side, in body axes."""

    chain: Chain
    axes: FloatArray  # (3, 3) behind the joints that turn the wing as a whole, to body axes
    elements: Elements
    twist_per_rate: FloatArray  # (A, N, 6) m and 1, of the elements' loads, per angle's rate


@kernel
def place_wing(
    joints: JointArrays,
    shape: WingShape,
    rigid_joint_count: int,
    angles: FloatArray,
    rates: FloatArray,
) -> PlacedWing:
    """Place a shape whose first `rigid_joint_count` joints are at zero and at rest.

    `angles` and `rates` (A,) rad, rad/s are those of joints and hinges.
    """
    chain = joint_chain(joints, angles)
    axes = chain.frame[rigid_joint_count]
    placed = turned(shape, axes, spin_of(chain, rigid_joint_count, rates))
    elements = place_elements(placed, joints.root)
    per_rate = twist_per_joint_rate(
        joints.root, joints.segment, chain, elements.position, placed.distal_fraction
    )
    if joints.segment.size < joints.angle_count:
        per_rate = np.concatenate((per_rate, placed.hinge_twist))
    return PlacedWing(chain, axes, elements, per_rate)


@kernel
def spin_of(chain: Chain, rigid_joint_count: int, rates: FloatArray) -> FloatArray:
    """Angular velocity (3,) rad/s that the first joints give to the wing as a whole."""
    spin = np.zeros(3)
    for j in range(rigid_joint_count):
        for i in range(3):
            spin[i] += rates[j] * chain.axis[j, i]
    return spin


@kernel
def swung(
    velocity: FloatArray, placed: PlacedWing, root: FloatArray, spin: FloatArray
) -> FloatArray:
    """Velocities (N, 3) m/s of a placed wing's control points relative to the body.

    `velocity` (N, 3) m/s are those within the wing, in its own axes, that turn at `spin` (3,) rad/s
    about the `root` (3,) m.
    """
    swung, position = turned_rows(velocity, placed.axes), placed.elements.position
    sx, sy, sz = spin[0], spin[1], spin[2]
    for e in range(len(swung)):
        x, y, z = position[e, 0] - root[0], position[e, 1] - root[1], position[e, 2] - root[2]
        swung[e, 0] += sy * z - sz * y
        swung[e, 1] += sz * x - sx * z
        swung[e, 2] += sx * y - sy * x
    return swung


@kernel
def spin_change(
    chain: Chain, rigid_joint_count: int, rates: FloatArray, accelerations: FloatArray
) -> FloatArray:
    """Rate of change (3,) rad/s2 of `spin_of`, at these accelerations (A,) rad/s2 of the joints."""
    spin, change = np.zeros(3), np.zeros(3)
    for j in range(rigid_joint_count):
        x, y, z = chain.axis[j, 0], chain.axis[j, 1], chain.axis[j, 2]
        # The joint's axis turns with all that carries it.
        change[0] += rates[j] * (spin[1] * z - spin[2] * y) + accelerations[j] * x
        change[1] += rates[j] * (spin[2] * x - spin[0] * z) + accelerations[j] * y
        change[2] += rates[j] * (spin[0] * y - spin[1] * x) + accelerations[j] * z
        spin[0] += rates[j] * x
        spin[1] += rates[j] * y
        spin[2] += rates[j] * z
    return change
