"""Springs and dampers: of compliant joints to their drivers, of hinges to their rest."""

import numpy as np

from birdmb._typing import FloatArray
from birdmb.topology import Bird


class Springs:
    """Springs and dampers of joints and hinges of one wing, none where a joint is prescribed.

    Args:
        bird: the bird; see `birdmb.topology.Joint` and `Hinge` for the torques.
    """

    def __init__(self, bird: Bird) -> None:
        compliant = np.array([joint.mode == "compliant" for joint in bird.joints])
        joints = bird.joints
        above = compliant * np.array([joint.stiffness or 0.0 for joint in joints])
        below = [j.stiffness if j.stiffness_below is None else j.stiffness_below for j in joints]
        below = compliant * np.array([stiffness or 0.0 for stiffness in below])
        cubic = compliant * np.array([joint.cubic_stiffness for joint in joints])
        damping = compliant * np.array([joint.damping or 0.0 for joint in joints])
        hinges = [feather.hinge for feather in bird.feathers if feather.hinge]
        stiffness = [hinge.stiffness for hinge in hinges]
        self._above = np.concatenate([above, stiffness])
        self._below = np.concatenate([below, stiffness])
        self._cubic = np.concatenate([cubic, [0.0] * len(hinges)])
        self._damping = np.concatenate([damping, [hinge.damping for hinge in hinges]])
        self.have_two_sides = bool((self._above != self._below).any())
        self._linear = not (self._cubic.any() or self.have_two_sides)

    def torques(self, deflection: FloatArray, deflection_rate: FloatArray) -> FloatArray:
        """Torques (A,) N m at these deflections from drivers or rest (A,) rad, rad/s."""
        damper = -self._damping * deflection_rate
        if self._linear:
            return damper - self._above * deflection
        stiffness = np.where(deflection > 0.0, self._above, self._below)
        return damper - (stiffness + self._cubic * deflection**2) * deflection
