"""One wingbeat of a limit cycle: its motion, loads and powers at equidistant times."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from birdmb._typing import FloatArray
from birdmb.models.loads import Loads, LoadsAlong
from birdmb.summary import Summarised


@dataclass(frozen=True, repr=False)
class Beat(Summarised):
    """One wingbeat of a limit cycle at K equidistant times, the first repeated at the end."""

    times: FloatArray
    """(K,) s."""
    states: FloatArray
    """(K, n)."""
    twists: FloatArray
    """(K, 6) m/s and rad/s, of the body."""
    loads_along: LoadsAlong
    """At K instants."""
    joint_rates: FloatArray
    """(K, 2, A) rad/s, of joints and feathers' hinges of the right wing and of the left one."""
    actuator_torques: FloatArray
    """(K, 2, A) N m, of actuators, or springs and dampers, on them."""
    driver_rates: FloatArray
    """(K, 2, A) rad/s, of the joints' drivers; 0 of hinges."""
    holding_power: FloatArray
    """(K,) W, of what holds the body in its motion; 0 in flight."""

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
        """Torques of the air (K, 2, A) N m about joints and hinges of right and left wing."""
        return self.loads_along.joint_torques

    @cached_property
    def joint_power(self) -> FloatArray:
        """Power (K, A) W into each pair of joints or hinges, left and right together."""
        return np.asarray((self.actuator_torques * self.joint_rates).sum(axis=1))

    @cached_property
    def air_power(self) -> FloatArray:
        """Power (K,) W of the air on the whole bird: on the body and about the joints."""
        wrench = np.hstack([self.force, self.moment])
        about_joints = (self.air_torques * self.joint_rates).sum(axis=(1, 2))
        return np.asarray((wrench * self.twists).sum(axis=1) + about_joints)

    @cached_property
    def driver_power(self) -> FloatArray:
        """Power (K, A) W of the drivers of each pair of joints; 0 of hinges."""
        return np.asarray((self.actuator_torques * self.driver_rates).sum(axis=1))

    @cached_property
    def dissipation(self) -> FloatArray:
        """Power (K, 4) W lost to the air by lift, profile drag, tail and body."""
        return self.loads_along.dissipation(self.twists)

    @property
    def tail_angle(self) -> FloatArray:
        """Angle of attack (K,) rad of the tail; NaN where there is none."""
        return self.loads_along.stack.tail_angle
