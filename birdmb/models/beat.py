"""One wingbeat of a limit cycle: its motion, loads and powers at equidistant times."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from birdmb._typing import FloatArray
from birdmb.models.loads import Loads, LoadsAlong


@dataclass(frozen=True)
class Beat:
    """One wingbeat of a limit cycle at K equidistant times, the first repeated at the end."""

    times: FloatArray
    """(K,) s."""
    states: FloatArray
    """(K, n)."""
    loads_along: LoadsAlong
    """At K instants."""
    joint_rates: FloatArray
    """(K, A) rad/s, of the joints and the feathers' hinges."""
    actuator_torques: FloatArray
    """(K, A) N m, that actuator, or spring and damper, put on each joint and hinge of one wing."""
    driver_rates: FloatArray
    """(K, A) rad/s, of the joints' drivers; 0 of hinges."""

    @cached_property
    def loads(self) -> tuple[Loads, ...]:
        """K entries."""
        return tuple(self.loads_along.at(k) for k in range(self.times.size))

    @property
    def force(self) -> FloatArray:
        """Resultant of the air (K, 3) N, body axes."""
        return self.loads_along.stack.force

    @property
    def moment(self) -> FloatArray:
        """Moment of the air about G (K, 3) N m, body axes."""
        return self.loads_along.stack.moment

    @property
    def wing_power(self) -> FloatArray:
        """Power (K,) W that the wings' motion against the air takes."""
        return self.loads_along.power

    @property
    def air_torques(self) -> FloatArray:
        """Torques of the air (K, A) N m about each joint and hinge of one wing."""
        return self.loads_along.stack.joint_torques

    @cached_property
    def joint_power(self) -> FloatArray:
        """Power (K, A) W into each pair of joints or hinges, left and right together."""
        return 2.0 * self.actuator_torques * self.joint_rates

    @cached_property
    def air_power(self) -> FloatArray:
        """Power (K,) W of the air on the whole bird: on the body and about the joints."""
        u, w, q = self.states[:, 0], self.states[:, 1], self.states[:, 2]
        on_body = self.force[:, 0] * u + self.force[:, 2] * w + self.moment[:, 1] * q
        about_joints = self.air_torques * self.joint_rates
        return np.asarray(on_body + 2.0 * about_joints.sum(axis=1))

    @cached_property
    def driver_power(self) -> FloatArray:
        """Power (K, A) W of the drivers of each pair of joints; 0 of hinges."""
        return 2.0 * self.actuator_torques * self.driver_rates

    @cached_property
    def dissipation(self) -> FloatArray:
        """Power (K, 4) W lost to the air by lift, profile drag, tail and body."""
        return self.loads_along.dissipation(self.states[:, :3])

    @property
    def tail_angle(self) -> FloatArray:
        """Angle of attack (K,) rad of the tail; NaN where there is none."""
        return self.loads_along.stack.tail_angle
