"""What moves the joints of a bird's tree, and what holds its body: forces, torques, power."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.models.compiled_calls import calls_compiled_code
from birdmb.models.failures import overflow_told
from birdmb.models.loads import LoadsAlong
from birdmb.models.partition import partitioned
from birdmb.models.springs import spring_torques_along
from birdmb.models.tree_coordinates import body_forces, coordinates_along
from birdmb.models.tree_model import TreeModel


class ActuatedTree(TreeModel):
    """A tree with its actuators, springs and dampers; see `birdmb.MultibodyModel`."""

    def accelerations(self, t: float, x: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Accelerations (n,) of all coordinates and the actuators' forces (n,) on them.

        Coordinates of the body as `tree_coordinates.COORDINATES`, in the plane of symmetry X, Z (m)
        and pitch (rad) alone, then joints and hinges of the right and of the left wing (rad). The
        forces (N, N m) are those that hold the prescribed joints to their drivers, without springs
        and dampers, and a held body in its motion.
        """
        times, states = np.array([t]), np.asarray(x, dtype=float)[None, :]
        a, forces = self._accelerations(times, states, self.loads_along(times, states))
        return a[0], forces[0]

    @calls_compiled_code
    def _accelerations(
        self, times: FloatArray, states: FloatArray, loads: LoadsAlong
    ) -> tuple[FloatArray, FloatArray]:
        """As `accelerations`, each (K, c)."""
        q, v = self._coordinates(times, states)
        mass, bias = self.tree.inertia.at(q, v)
        torques = loads.joint_torques + self._spring_torques_along(times, states)
        place, _ = coordinates_along(self.body_in_space(states))
        on_body = body_forces(place, np.hstack([loads.stack.force, loads.stack.moment]))
        _, _, driving = self.drivers_of_both(times)
        count = times.size
        given = np.zeros(q.shape)
        given[:, self._joints] = driving.reshape(count, -1)
        applied = np.hstack([on_body[:, self._coordinates_of_body], torques.reshape(count, -1)])
        with overflow_told(self.bird, f"the acceleration at t = {times[0]:.4g} s"):
            return partitioned(mass, bias - applied, given, self.prescribed)

    def _spring_torques_along(self, times: FloatArray, states: FloatArray) -> FloatArray:
        """Torques (K, 2, A) N m of springs and dampers."""
        angles, rates = self.motion_of_both(times, states)
        driver_angles, driver_rates, _ = self.drivers_of_both(times)
        flat = times.size, -1
        torques = spring_torques_along(
            self._springs,
            (angles - driver_angles).reshape(flat),
            (rates - driver_rates).reshape(flat),
        )
        return np.asarray(torques.reshape(angles.shape))

    def actuator_torques_along(
        self, times: FloatArray, states: FloatArray, loads: LoadsAlong
    ) -> FloatArray:
        """Torques (K, 2, A) N m that move joints and hinges of the right and of the left wing.

        Of the actuators that hold prescribed joints to their drivers, inertia included; of spring
        and damper where a joint is compliant.
        """
        _, forces = self._accelerations(times, states, loads)
        springs = self._spring_torques_along(times, states)
        return np.asarray(forces[:, self._joints].reshape(springs.shape) + springs)

    def holding_power(self, times: FloatArray, states: FloatArray, loads: LoadsAlong) -> FloatArray:
        """Power (K,) W of what holds the body in its motion; 0 where it flies."""
        if self._held is None:
            return super().holding_power(times, states, loads)
        _, forces = self._accelerations(times, states, loads)
        body = self._coordinates_of_body.size
        _, v = self._coordinates(times, states)
        return np.asarray((forces[:, :body] * v[:, :body]).sum(axis=1))
