"""Compiled equations of motion of the rigid bird in space, their derivatives and integration.

Equations (Etkin & Reid, Dynamics of Flight, 1996, chapter 4), in body axes about the centre of
mass: m (V' + omega x V) = F + m g, I omega' + omega x I omega = M, phi' = p + tan(theta) (q
sin(phi) + r cos(phi)), theta' = q cos(phi) - r sin(phi). Planar flight is their restriction to its
states.
"""

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.airframe import Airframe
from birdmb.aerodynamics.prescribed import OddWing, PrescribedWing, free_loads, symmetric_loads

_PHI, _THETA, _SIZE = 6, 7, 8


class RigidBody(NamedTuple):
    """The constants of the body's motion."""

    mass: float  # kg
    inertia: FloatArray  # (3, 3) kg m2, about G
    inverse: FloatArray  # (3, 3), of the inertia
    gravity: float  # m/s2
    states: IntArray  # (n,) positions of the model's states among those in space
    directions: IntArray  # (d,) those of them that belong to the twist


@kernel
def _attitude(x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Axes of the heading along those of the body, (3, 3), and their slopes by phi and theta."""
    cr, sr, c, s = np.cos(x[_PHI]), np.sin(x[_PHI]), np.cos(x[_THETA]), np.sin(x[_THETA])
    axes = np.array([[c, 0.0, -s], [s * sr, cr, c * sr], [s * cr, -sr, c * cr]])
    by_phi = np.array([[0.0, 0.0, 0.0], [s * cr, -sr, c * cr], [-s * sr, -cr, -c * sr]])
    by_theta = np.array([[-s, 0.0, -c], [c * sr, 0.0, -s * sr], [c * cr, 0.0, -s * cr]])
    return axes, by_phi, by_theta


@kernel
def _crossing(vector: FloatArray) -> FloatArray:
    """Matrix (3, 3) of the product vector x ..."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


@kernel
def rigid_rates(
    wing: PrescribedWing,
    odd: OddWing,
    k: int,
    states: FloatArray,
    air: FloatArray,
    frame: Airframe,
    body: RigidBody,
) -> tuple[FloatArray, FloatArray]:
    """Rates (n,) of the states (n,) at the k-th tabulated phase, and their Jacobian (n, n).

    `air` (3,) m/s is the velocity of the air along the heading, to the right of it and down.
    """
    x = np.zeros(_SIZE)
    x[body.states] = states
    axes, by_phi, by_theta = _attitude(x)
    twist = x[:6].copy()
    twist[:3] -= axes @ air
    if body.directions.size == 6:
        found = free_loads(wing, odd, k, frame, twist, body.directions)
    else:
        found = symmetric_loads(wing, k, frame, twist, body.directions)
    by_twist = np.zeros((6, _SIZE))
    by_twist[:, body.directions] = found[:, 1:]
    # As the body turns, the air's velocity turns in its axes.
    by_twist[:, _PHI] = -by_twist[:, :3] @ (by_phi @ air)
    by_twist[:, _THETA] = -by_twist[:, :3] @ (by_theta @ air)

    velocity, spin = x[:3].copy(), x[3:6].copy()
    turning = _crossing(spin)
    momentum = body.inertia @ spin
    weight = np.array([0.0, 0.0, body.gravity])
    rates, jacobian = np.zeros(_SIZE), np.zeros((_SIZE, _SIZE))
    rates[:3] = found[:3, 0] / body.mass + axes @ weight - turning @ velocity
    rates[3:6] = body.inverse @ (found[3:, 0] - turning @ momentum)
    jacobian[:3] = by_twist[:3] / body.mass
    jacobian[:3, :3] -= turning
    jacobian[:3, 3:6] += _crossing(velocity)
    jacobian[:3, _PHI] += by_phi @ weight
    jacobian[:3, _THETA] += by_theta @ weight
    by_twist[3:, 3:6] += _crossing(momentum) - turning @ body.inertia
    jacobian[3:6] = body.inverse @ by_twist[3:].copy()

    _, q, r = spin
    cr, sr, slope = np.cos(x[_PHI]), np.sin(x[_PHI]), np.tan(x[_THETA])
    yawing = q * sr + r * cr
    rates[_PHI] = spin[0] + slope * yawing
    rates[_THETA] = q * cr - r * sr
    jacobian[_PHI, 3], jacobian[_PHI, 4], jacobian[_PHI, 5] = 1.0, slope * sr, slope * cr
    jacobian[_PHI, _PHI] = slope * rates[_THETA]
    jacobian[_PHI, _THETA] = (1.0 + slope * slope) * yawing
    jacobian[_THETA, 4], jacobian[_THETA, 5] = cr, -sr
    jacobian[_THETA, _PHI] = -yawing
    return rates[body.states], jacobian[body.states][:, body.states]


@kernel
def rates_along(
    wing: PrescribedWing,
    odd: OddWing,
    phase: IntArray,
    states: FloatArray,
    air: FloatArray,
    frame: Airframe,
    body: RigidBody,
) -> tuple[FloatArray, FloatArray]:
    """Rates (K, n) of `states` (K, n) at tabulated phases (K,), and their Jacobians (K, n, n).

    `air` (K, 3) m/s as for `rigid_rates`. NaN where a state is not finite.
    """
    count, n = states.shape
    rates, jacobians = np.full((count, n), np.nan), np.full((count, n, n), np.nan)
    for i in range(count):
        if np.isfinite(states[i]).all():
            rates[i], jacobians[i] = rigid_rates(
                wing, odd, phase[i], states[i], air[i], frame, body
            )
    return rates, jacobians


@kernel
def integrate_rigid(
    wing: PrescribedWing,
    odd: OddWing,
    x0: FloatArray,
    step: float,
    air: FloatArray,
    frame: Airframe,
    body: RigidBody,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Classical Runge-Kutta steps over a table at every half step.

    `air` (2 steps + 1, 3) m/s, as for `rigid_rates`. Returns the states (steps + 1, n), their
    rates, and the derivative (n, n) of the last state with respect to the first.
    """
    steps, n = (wing.inverse.shape[0] - 1) // 2, x0.size
    states = np.empty((steps + 1, n))
    rates = np.empty((steps + 1, n))
    states[0] = x0
    x = x0.copy()
    sensitivity = np.eye(n)
    for i in range(steps):
        k, g = 2 * i, air[2 * i + 1]
        k1, j1 = rigid_rates(wing, odd, k, x, air[k], frame, body)
        s1 = j1 @ sensitivity
        k2, j2 = rigid_rates(wing, odd, k + 1, x + 0.5 * step * k1, g, frame, body)
        s2 = j2 @ (sensitivity + 0.5 * step * s1)
        k3, j3 = rigid_rates(wing, odd, k + 1, x + 0.5 * step * k2, g, frame, body)
        s3 = j3 @ (sensitivity + 0.5 * step * s2)
        k4, j4 = rigid_rates(wing, odd, k + 2, x + step * k3, air[k + 2], frame, body)
        s4 = j4 @ (sensitivity + step * s3)
        x = x + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        sensitivity = sensitivity + step / 6.0 * (s1 + 2.0 * s2 + 2.0 * s3 + s4)
        rates[i] = k1
        states[i + 1] = x
    rates[steps], _ = rigid_rates(wing, odd, 2 * steps, x, air[2 * steps], frame, body)
    return states, rates, sensitivity
