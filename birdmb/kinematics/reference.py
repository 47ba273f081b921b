"""Where in the beat a measured motion is: phases are told from one joint's, as in the topology."""

from __future__ import annotations

import math

import numpy as np

from birdmb.kinematics.series import Gait
from birdmb.topology import Bird, Joint
from birdmb.topology.roles import flap_joint

_ENOUGH = 0.25  # of the largest amplitude


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


def lead_of(bird: Bird, gait: Gait) -> float:
    """How far after t = 0 the gait's phase 0 is, in beats."""
    joint = reference_joint(bird, gait)
    _, cosine, sine = gait.coefficients[gait.joints.index(joint), :3]
    return (math.atan2(cosine, sine) - _phase_before(bird.joints[joint])) / (2.0 * math.pi)


def _phase_before(joint: Joint) -> float:
    """Phase of a joint's first harmonic at t = 0 as it is in the topology, rad.

    Where it has none, t = 0 is in the middle of the stroke along which a wing goes down, if the
    joint flaps.
    """
    driver = joint.driver
    if driver.amplitudes[:1].any():
        return math.atan2(driver.cosine[0], driver.sine[0])
    return 0.0 if joint.axis[0] > 0.0 else math.pi
