"""Natural oscillation of a compliant joint, and of a feather on its hinge, without air."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from birdmb.models.feather_rods import feather_rods
from birdmb.topology import SIDES, Bird, Joint
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.chain import joint_chain

# Of the inertia that the whole wing's mass would have a metre away: round-off of the sum.
_ROUND_OFF = 1e-14
_NEAR_RESONANCE = 0.2


@dataclass(frozen=True)
class NaturalOscillation:
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

    def is_near(self, frequency: float) -> bool:
        """Whether driving it at this frequency, Hz, comes close to resonance."""
        return abs(self.frequency / frequency - 1) < _NEAR_RESONANCE


def joint_oscillation(bird: Bird, joint: Joint) -> NaturalOscillation:
    """Stiffness, damping and carried inertia of a compliant joint, drivers at their means."""
    bird = bird.assembled
    angles = np.array([j.driver.mean for j in bird.joints])
    wing = wing_arrays(bird)
    chain = joint_chain(wing, angles)
    number = bird.joint_names.index(joint.name)
    axis = chain.axis[number]
    first = bird.segments.names.index(joint.segment)
    pivot = chain.origin[first]
    inertia, largest = 0.0, 0.0
    for i, (_, segment) in enumerate(bird.segments.items()):
        if i < first:
            continue
        R = chain.rotation[i]
        lever = np.cross(axis, chain.origin[i] + R @ np.array(segment.centre_of_mass) - pivot)
        local = R.T @ axis
        inertia += segment.mass * float(lever @ lever)
        inertia += float(local @ np.array(segment.inertia) @ local)
        largest += segment.mass
    return NaturalOscillation(
        stiffness=joint.stiffness or 0.0,
        damping=joint.damping or 0.0,
        inertia=inertia if inertia > _ROUND_OFF * largest else 0.0,
    )


def joint_oscillations(bird: Bird) -> dict[str, NaturalOscillation]:
    """Those of the compliant joints, by the joints' names, as `oscillations_of`."""
    found: dict[str, NaturalOscillation] = {}
    for joint in bird.compliant_joints:
        found |= oscillations_of(bird, joint)
    return found


def oscillations_of(bird: Bird, joint: Joint) -> dict[str, NaturalOscillation]:
    """That of a compliant joint, by its name, or of each side where the sides differ."""
    if bird.is_symmetric:
        return {joint.name: joint_oscillation(bird.side("right"), joint.on("right"))}
    return {
        f"{joint.name}.{side}": joint_oscillation(bird.side(side), joint.on(side)) for side in SIDES
    }


def hinge_oscillations(bird: Bird) -> dict[str, NaturalOscillation]:
    """Stiffness, damping and inertia of the feathers' hinges, by the hinges' names."""
    hinges = [(f.hinge_name, f.hinge) for f in bird.feathers if f.hinge]
    return {
        name: NaturalOscillation(
            stiffness=hinge.stiffness,
            damping=hinge.damping,
            inertia=rod.mass
            * rod.length**2
            / 3
            * float(rod.direction[[0, 2]] @ rod.direction[[0, 2]]),
        )
        for (name, hinge), rod in zip(hinges, feather_rods(bird), strict=True)
    }
