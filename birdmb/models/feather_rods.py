"""Hinged feathers as rods: where their mass is, seen from the bones that carry them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import TopologyError
from birdmb.topology import Bird
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.chain import joint_chain
from birdmb.wing.edges import feather_ends

# Sine of the angle to the hinge's axis below which a rod has no inertia about it.
_ALONG_THE_AXIS = 1e-6


class FeatherRod(NamedTuple):
    """A hinged feather as a slender straight rod, in the frame of its bone, hinge at zero.

    The mass of a feather is spread evenly from root to tip.
    """

    bone: str
    root: FloatArray  # (3,) m, from the bone's root
    direction: FloatArray  # (3,) unit, from root to tip
    length: float  # m
    mass: float  # kg


def feather_rods(bird: Bird) -> list[FeatherRod]:
    """Rods of the hinged feathers of the right wing, from the shoulder outwards.

    A feather that follows shares of joint angles fans out within its bone's frame. Its mass, next
    to nothing beside the bones', does not: it stays where it is with all drivers at their offsets.

    Raises:
        TopologyError: a feather points along the axis of its hinge.
    """
    if not bird.hinged_feathers:
        return []
    wing = wing_arrays(bird)
    angles = wing.offset.astype(complex)
    angles[wing.segment.size :] = 0.0
    bones = joint_chain(wing, angles)
    roots, tips = feather_ends(wing, bones, angles)
    rods = []
    for i, feather in enumerate(bird.feathers):
        if feather.hinge is None:
            continue
        bone = wing.feather_bone[i]
        to_bone = bones.rotation[bone].T.real
        root = to_bone @ (roots[i] - bones.origin[bone]).real
        direction = to_bone @ (tips[i] - roots[i]).real / feather.length
        if np.hypot(direction[0], direction[2]) < _ALONG_THE_AXIS:
            raise TopologyError(
                f"{bird.name}: feathers.{feather.name}.hinge: with the joints at their offsets the "
                "feather points along its bone, about which the hinge turns it; root it firmly"
            )
        rods.append(FeatherRod(feather.bone, root, direction, feather.length, feather.hinge.mass))
    return rods
