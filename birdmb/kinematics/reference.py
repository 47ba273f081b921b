"""Where in the beat a measured motion is: phases are told from one joint's, as in the topology."""

from __future__ import annotations

import math

import numpy as np

from birdmb.aerodynamics.prescribed import driver_motion_along
from birdmb.kinematics.observations import Observations
from birdmb.kinematics.series import Gait
from birdmb.topology import Bird
from birdmb.topology.roles import flap_joint

_ENOUGH = 0.25  # of the largest amplitude
_INSTANTS = 64
_STILL = 1e-9


def reference_joint(bird: Bird, gait: Gait) -> int:
    """The joint that gives the beat its beginning: the one that flaps, or else moves most."""
    amplitudes = np.hypot(gait.coefficients[:, 1], gait.coefficients[:, 2])
    flapping = flap_joint(bird)
    if flapping is not None:
        flap = bird.joint_names.index(flapping.name)
        enough = _ENOUGH * amplitudes.max()
        if flap in gait.joints and amplitudes[gait.joints.index(flap)] >= enough:
            return flap
    return gait.joints[int(np.argmax(amplitudes))]


def wanted_phase(seen: Observations, bird: Bird, joint: int) -> float:
    """Phase of a joint's first harmonic at t = 0, rad, as in the topology.

    Where it stands still there, t = 0 is in the middle of the stroke along which a wing goes down
    if the joint flaps.
    """
    beat = 2.0 * np.pi / seen.wing.angular_frequency
    phases = np.arange(_INSTANTS) / _INSTANTS
    angle = driver_motion_along(seen.wing, phases * beat)[0][:, joint]
    turned = 2.0 / _INSTANTS * np.sum(angle * np.exp(-2j * np.pi * phases))
    if abs(turned) < _STILL:
        return 0.0 if bird.joints[joint].axis[0] > 0.0 else math.pi
    return math.atan2(turned.real, -turned.imag)


def lead_of(seen: Observations, bird: Bird, gait: Gait) -> float:
    """How far after t = 0 the gait's phase 0 is, in beats."""
    joint = reference_joint(bird, gait)
    _, cosine, sine = gait.coefficients[gait.joints.index(joint), :3]
    return (math.atan2(cosine, sine) - wanted_phase(seen, bird, joint)) / (2.0 * math.pi)
