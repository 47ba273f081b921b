"""A wing of a bird, hung up on the body and turned by the joints that carry it as a whole."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.aerodynamics.elements import Elements, place_elements
from birdmb.aerodynamics.joints import hinge_torques, joint_torques
from birdmb.wing.arrays import WingArrays
from birdmb.wing.chain import Chain, frame_after, joint_chain
from birdmb.wing.shape import WingShape, turned


class PlacedWing(NamedTuple):
    """A right wing, or a left one mirrored onto the right side, in body axes."""

    chain: Chain
    axes: FloatArray  # (3, 3) behind the joints that turn the wing as a whole, to body axes
    shape: WingShape
    elements: Elements


@kernel
def place_wing(
    wing: WingArrays,
    shape: WingShape,
    rigid_joint_count: int,
    angles: FloatArray,
    rates: FloatArray,
) -> PlacedWing:
    """Place a shape whose first `rigid_joint_count` joints are at zero and at rest.

    `angles` and `rates` (A,) rad, rad/s are those of joints and hinges.
    """
    chain = joint_chain(wing, angles)
    axes = frame_after(wing, angles, rigid_joint_count)
    placed = turned(shape, axes, spin_of(chain, rigid_joint_count, rates))
    return PlacedWing(chain, axes, placed, place_elements(placed, wing.root))


@kernel
def spin_of(chain: Chain, rigid_joint_count: int, rates: FloatArray) -> FloatArray:
    """Angular velocity (3,) rad/s that the first joints give to the wing as a whole."""
    spin = np.zeros(3)
    for j in range(rigid_joint_count):
        spin += rates[j] * chain.axis[j]
    return spin


@kernel
def torques_of(wing: WingArrays, placed: PlacedWing, force: FloatArray) -> FloatArray:
    """Torques (A,) N m of forces (N, 3) N on the elements about joints and hinges."""
    position, fraction = placed.elements.position, placed.shape.distal_fraction
    about_joints = joint_torques(wing, placed.chain, position, force, fraction)
    return np.concatenate((about_joints, hinge_torques(placed.shape.hinge_velocity, force)))
