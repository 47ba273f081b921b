"""Coordinates of the body in Exudyn's tree: its place and its attitude by three angles.

In space X, Y, Z (m, forward, right, down) and the angles yaw, pitch, roll (rad), by which the axes
of the world are turned in this order about z, y and x into those of the body (Etkin & Reid,
Dynamics of Flight, 1996, section 4.4); in the plane of symmetry X, Z and pitch.
"""

from __future__ import annotations

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.models.motion import SPACE_STATES, heading_rate, heading_velocity

COORDINATES = ("X", "Y", "Z", "yaw", "pitch", "roll")
IN_PLANE, IN_SPACE = np.array([0, 2, 4]), np.arange(6)
_PHI, _THETA = SPACE_STATES.index("phi"), SPACE_STATES.index("theta")


def coordinates_along(space: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Coordinates and velocities (K, 6) of states in space (K, 8), at the origin with no yaw."""
    q, v = np.zeros((len(space), 6)), np.empty((len(space), 6))
    phi, theta = space[:, _PHI], space[:, _THETA]
    q[:, 4], q[:, 5] = theta, phi
    v[:, :3] = heading_velocity(space) * [1.0, 1.0, -1.0]
    v[:, 3] = heading_rate(space)
    v[:, 4] = space[:, 4] * np.cos(phi) - space[:, 5] * np.sin(phi)
    v[:, 5] = space[:, 3] + np.sin(theta) * v[:, 3]
    return q, v


@kernel
def attitude(q: FloatArray) -> FloatArray:
    """Axes of the body, columns of (3, 3), in the world at coordinates q (6,)."""
    cy, sy, cp, sp = np.cos(q[3]), np.sin(q[3]), np.cos(q[4]), np.sin(q[4])
    cr, sr = np.cos(q[5]), np.sin(q[5])
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


@kernel
def _spin_per_rate(q: FloatArray) -> FloatArray:
    """Angular velocity p, q, r along the body's axes per rate of yaw, pitch and roll, (3, 3)."""
    cp, sp, cr, sr = np.cos(q[4]), np.sin(q[4]), np.cos(q[5]), np.sin(q[5])
    return np.array([[-sp, 0.0, 1.0], [cp * sr, cr, 0.0], [cp * cr, -sr, 0.0]])


@kernel
def spin_change(q: FloatArray, v: FloatArray) -> FloatArray:
    """Angular acceleration (3,) along the body's axes where yaw, pitch and roll do not accelerate.

    At coordinates q and velocities v (6,): the change of p, q and r.
    """
    cp, sp, cr, sr = np.cos(q[4]), np.sin(q[4]), np.cos(q[5]), np.sin(q[5])
    yaw, pitch, roll = v[3:]
    return np.array(
        [
            -cp * pitch * yaw,
            (cp * cr * roll - sp * sr * pitch) * yaw - sr * roll * pitch,
            -(cp * sr * roll + sp * cr * pitch) * yaw - cr * roll * pitch,
        ]
    )


@kernel
def twist_per_rate(q: FloatArray) -> FloatArray:
    """Velocity and angular velocity along the body's axes per rate of each coordinate, (6, 6)."""
    found = np.zeros((6, 6))
    found[:3, :3], found[3:, 3:] = attitude(q).T, _spin_per_rate(q)
    return found


@kernel
def space_state(q: FloatArray, v: FloatArray) -> FloatArray:
    """State in space (8,) at coordinates q and velocities v (6,)."""
    state = np.empty(8)
    state[:3] = attitude(q).T @ v[:3].copy()
    state[3:6] = _spin_per_rate(q) @ v[3:].copy()
    state[_PHI], state[_THETA] = q[5], q[4]
    return state


@kernel
def generalised(q: FloatArray, wrench: FloatArray) -> FloatArray:
    """Generalised forces (6,) at coordinates q (6,) of a wrench (6,) in body axes."""
    forces = np.empty(6)
    forces[:3] = attitude(q) @ wrench[:3].copy()
    forces[3:] = _spin_per_rate(q).T @ wrench[3:].copy()
    return forces


@kernel
def whole(part: FloatArray, coordinates: IntArray) -> FloatArray:
    """Coordinates, or their rates, (6,) of which only some are not zero."""
    found = np.zeros(6)
    for b in range(coordinates.size):
        found[coordinates[b]] = part[b]
    return found


@kernel
def body_forces(q: FloatArray, wrenches: FloatArray) -> FloatArray:
    """As `generalised`, each (K, 6)."""
    forces = np.empty(wrenches.shape)
    for k in range(len(wrenches)):
        forces[k] = generalised(q[k], wrenches[k])
    return forces


@kernel
def state_rates(space: FloatArray, accelerations: FloatArray) -> FloatArray:
    """Rates (K, 8) of states in space (K, 8) of a body with these accelerations (K, 6).

    Those of velocity and angular velocity in space, along the body's axes.
    """
    rates = np.empty(space.shape)
    for k in range(len(space)):
        u, v, w, p, q, r, phi, theta = space[k]
        rates[k, 0] = accelerations[k, 0] - (q * w - r * v)
        rates[k, 1] = accelerations[k, 1] - (r * u - p * w)
        rates[k, 2] = accelerations[k, 2] - (p * v - q * u)
        rates[k, 3:6] = accelerations[k, 3:]
        yawing = q * np.sin(phi) + r * np.cos(phi)
        rates[k, _PHI] = p + np.tan(theta) * yawing
        rates[k, _THETA] = q * np.cos(phi) - r * np.sin(phi)
    return rates
