"""Compiled integration of the rigid four-state bird and of its variational equations."""

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.airframe import Airframe
from birdmb.aerodynamics.prescribed import PrescribedWing, bird_loads


class RigidBody(NamedTuple):
    """The constants of the body's motion."""

    mass: float  # kg
    inertia: float  # kg m2, in pitch
    gravity: float  # m/s2


@kernel
def rigid_rates(
    wing: PrescribedWing,
    k: int,
    x: FloatArray,
    gust: FloatArray,
    frame: Airframe,
    body: RigidBody,
) -> tuple[FloatArray, FloatArray]:
    """Rates (4,) of u, w, q, theta at the k-th tabulated phase, and their Jacobian (4, 4).

    `gust` (2,) m/s is the velocity of the air in the world, along X (forward) and Z (down).
    """
    u, w, q, theta = x
    s, c = np.sin(theta), np.cos(theta)
    air_u, air_w = gust[0] * c - gust[1] * s, gust[0] * s + gust[1] * c
    loads = bird_loads(wing, k, frame, u - air_u, w - air_w, q)
    rates = np.empty(4)
    rates[0] = -q * w - body.gravity * s + loads[0, 0] / body.mass
    rates[1] = q * u + body.gravity * c + loads[1, 0] / body.mass
    rates[2] = loads[2, 0] / body.inertia
    rates[3] = q
    jacobian = np.zeros((4, 4))
    for i in range(3):
        weight = body.inertia if i == 2 else body.mass
        for m in range(3):
            jacobian[i, m] = loads[i, m + 1] / weight
        # As the body turns, the gust turns in its axes.
        jacobian[i, 3] = (loads[i, 1] * air_w - loads[i, 2] * air_u) / weight
    jacobian[0, 1] -= q
    jacobian[0, 2] -= w
    jacobian[0, 3] -= body.gravity * c
    jacobian[1, 0] += q
    jacobian[1, 2] += u
    jacobian[1, 3] -= body.gravity * s
    jacobian[3, 2] = 1.0
    return rates, jacobian


@kernel
def rates_along(
    wing: PrescribedWing,
    phase: IntArray,
    states: FloatArray,
    gusts: FloatArray,
    frame: Airframe,
    body: RigidBody,
) -> tuple[FloatArray, FloatArray]:
    """Rates (K, 4) of `states` (K, 4) at tabulated phases (K,), and their Jacobians (K, 4, 4).

    `gusts` (K, 2) m/s as for `rigid_rates`. NaN where a state is not finite.
    """
    rates = np.full(states.shape, np.nan)
    jacobians = np.full((states.shape[0], 4, 4), np.nan)
    for i in range(states.shape[0]):
        if np.isfinite(states[i]).all():
            rates[i], jacobians[i] = rigid_rates(wing, phase[i], states[i], gusts[i], frame, body)
    return rates, jacobians


@kernel
def integrate_rigid(
    wing: PrescribedWing,
    x0: FloatArray,
    step: float,
    gusts: FloatArray,
    frame: Airframe,
    body: RigidBody,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Classical Runge-Kutta steps over a table at every half step.

    `gusts` (2 steps + 1, 2) m/s, as for `rigid_rates`. Returns the states (steps + 1, 4), their
    rates, and the derivative (4, 4) of the last state by the first.
    """
    steps = (wing.inverse.shape[0] - 1) // 2
    states = np.empty((steps + 1, 4))
    rates = np.empty((steps + 1, 4))
    states[0] = x0
    x = x0.copy()
    sensitivity = np.eye(4)
    for i in range(steps):
        k, g = 2 * i, gusts[2 * i + 1]
        k1, j1 = rigid_rates(wing, k, x, gusts[k], frame, body)
        s1 = j1 @ sensitivity
        k2, j2 = rigid_rates(wing, k + 1, x + 0.5 * step * k1, g, frame, body)
        s2 = j2 @ (sensitivity + 0.5 * step * s1)
        k3, j3 = rigid_rates(wing, k + 1, x + 0.5 * step * k2, g, frame, body)
        s3 = j3 @ (sensitivity + 0.5 * step * s2)
        k4, j4 = rigid_rates(wing, k + 2, x + step * k3, gusts[k + 2], frame, body)
        s4 = j4 @ (sensitivity + step * s3)
        x = x + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        sensitivity = sensitivity + step / 6.0 * (s1 + 2.0 * s2 + 2.0 * s3 + s4)
        rates[i] = k1
        states[i + 1] = x
    rates[steps], _ = rigid_rates(wing, 2 * steps, x, gusts[2 * steps], frame, body)
    return states, rates, sensitivity
