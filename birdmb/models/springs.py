"""Springs and dampers: of compliant joints to their drivers, of hinges to their rest."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.topology import Bird


class Springs(NamedTuple):
    """Springs and dampers of the A joints and hinges of one wing, 0 where a joint is prescribed.

    See `birdmb.topology.Joint` and `Hinge` for the torques.
    """

    above: FloatArray  # (A,) N m/rad, stiffness at positive deflections
    below: FloatArray  # (A,) N m/rad, at negative ones
    cubic: FloatArray  # (A,) N m/rad3
    damping: FloatArray  # (A,) N m s/rad


def springs_of(bird: Bird) -> Springs:
    """Springs and dampers of a bird's joints, then of its feathers' hinges."""
    compliant = np.array([joint.mode == "compliant" for joint in bird.joints])
    joints = bird.joints
    above = compliant * np.array([joint.stiffness or 0.0 for joint in joints])
    below = [j.stiffness if j.stiffness_below is None else j.stiffness_below for j in joints]
    below = compliant * np.array([stiffness or 0.0 for stiffness in below])
    cubic = compliant * np.array([joint.cubic_stiffness for joint in joints])
    damping = compliant * np.array([joint.damping or 0.0 for joint in joints])
    hinges = [feather.hinge for feather in bird.feathers if feather.hinge]
    stiffness = [hinge.stiffness for hinge in hinges]
    return Springs(
        np.concatenate([above, stiffness]),
        np.concatenate([below, stiffness]),
        np.concatenate([cubic, [0.0] * len(hinges)]),
        np.concatenate([damping, [hinge.damping for hinge in hinges]]),
    )


def has_two_sides(springs: Springs) -> bool:
    """Whether a spring is stiffer to one side, which puts a kink into its torque."""
    return bool((springs.above != springs.below).any())


@kernel
def spring_torques(
    springs: Springs, deflection: FloatArray, deflection_rate: FloatArray
) -> FloatArray:
    """Torques (A,) N m at these deflections from drivers or rest (A,) rad, rad/s."""
    torques = np.empty(deflection.size)
    for j in range(torques.size):
        d = deflection[j]
        stiffness = springs.above[j] if d > 0.0 else springs.below[j]
        stiffness += springs.cubic[j] * d * d
        torques[j] = -springs.damping[j] * deflection_rate[j] - stiffness * d
    return torques


@kernel
def spring_torques_along(
    springs: Springs, deflections: FloatArray, deflection_rates: FloatArray
) -> FloatArray:
    """As `spring_torques`, (K, A), at deflections and rates (K, A)."""
    torques = np.empty(deflections.shape)
    for k in range(deflections.shape[0]):
        torques[k] = spring_torques(springs, deflections[k], deflection_rates[k])
    return torques
