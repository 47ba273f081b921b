"""Springs and dampers between compliant joints and their drivers."""

import numpy as np

from birdmb._typing import FloatArray
from birdmb.topology import Bird


class Springs:
    """Springs and dampers of the joints of one wing, none where a joint is prescribed.

    Args:
        bird: the bird; see `birdmb.topology.Joint` for the torque of a joint.
    """

    def __init__(self, bird: Bird) -> None:
        compliant = np.array([joint.mode == "compliant" for joint in bird.joints])
        joints = bird.joints
        self._above = compliant * np.array([joint.stiffness or 0.0 for joint in joints])
        below = [j.stiffness if j.stiffness_below is None else j.stiffness_below for j in joints]
        self._below = compliant * np.array([stiffness or 0.0 for stiffness in below])
        self._cubic = compliant * np.array([joint.cubic_stiffness for joint in joints])
        self._damping = compliant * np.array([joint.damping or 0.0 for joint in joints])
        self._linear = not self._cubic.any() and (self._above == self._below).all()

    def torques(self, deflection: FloatArray, deflection_rate: FloatArray) -> FloatArray:
        """Torques (J,) N m for joints (J,) that are ahead of their drivers by these rad, rad/s."""
        damper = -self._damping * deflection_rate
        if self._linear:
            return damper - self._above * deflection
        stiffness = np.where(deflection > 0.0, self._above, self._below)
        return damper - (stiffness + self._cubic * deflection**2) * deflection
