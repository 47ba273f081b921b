"""How a compliant joint, or a feather on its hinge, swings by itself."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from birdmb.models.feather_rods import feather_rods
from birdmb.topology import BONES, Bird, Joint
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.chain import joint_chain
from birdmb.wing.edges import skeleton

# Of the inertia that the whole wing's mass would have a metre away: round-off of the sum.
_ROUND_OFF = 1e-14


@dataclass(frozen=True)
class Spring:
    """A compliant joint or hinge with what it moves, all others held still."""

    stiffness: float
    """N m/rad."""
    damping: float
    """N m s/rad."""
    inertia: float
    """kg m2 about its axis, of what it carries."""

    @property
    def frequency(self) -> float:
        """Undamped natural frequency, Hz."""
        return math.sqrt(self.stiffness / self.inertia) / (2 * math.pi)


def spring_of(bird: Bird, joint: Joint) -> Spring:
    """Stiffness, damping and carried inertia of a compliant joint, drivers at their offsets."""
    angles = np.array([j.offset for j in bird.joints])
    wing = wing_arrays(bird)
    chain = joint_chain(wing, angles)
    bones = skeleton(wing, angles.astype(complex))
    number = bird.joint_names.index(joint.name)
    axis = chain.axis[number]
    pivot = chain.origin[BONES.index(joint.segment)]
    inertia, largest = 0.0, 0.0
    for i in range(BONES.index(joint.segment), len(BONES)):
        segment = getattr(bird.segments, BONES[i])
        R = bones.rotation[i].real
        lever = np.cross(axis, chain.origin[i] + R @ np.array(segment.centre_of_mass) - pivot)
        local = R.T @ axis
        inertia += segment.mass * float(lever @ lever)
        inertia += float(local @ np.array(segment.inertia) @ local)
        largest += segment.mass
    return Spring(
        stiffness=joint.stiffness or 0.0,
        damping=joint.damping or 0.0,
        inertia=inertia if inertia > _ROUND_OFF * largest else 0.0,
    )


def hinge_springs(bird: Bird) -> dict[str, Spring]:
    """Stiffness, damping and inertia of the feathers' hinges, by the hinges' names."""
    hinges = [(f.hinge_name, f.hinge) for f in bird.feathers if f.hinge]
    return {
        name: Spring(
            stiffness=hinge.stiffness,
            damping=hinge.damping,
            inertia=rod.mass
            * rod.length**2
            / 3
            * float(rod.direction[[0, 2]] @ rod.direction[[0, 2]]),
        )
        for (name, hinge), rod in zip(hinges, feather_rods(bird), strict=True)
    }
