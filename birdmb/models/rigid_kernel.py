"""Compiled integration of the rigid four-state bird and of its variational equations."""

import numpy as np
from numba import njit

from birdmb._typing import FloatArray
from birdmb.aerodynamics.prescribed import PrescribedWing, at_phase, resultant_and_derivatives


@njit(cache=True)
def rigid_rates(
    wing: PrescribedWing,
    k: int,
    x: FloatArray,
    mass: float,
    inertia: float,
    gravity: float,
    density: float,
) -> tuple[FloatArray, FloatArray]:
    """Rates (4,) of u, w, q, theta at the k-th tabulated phase, and their Jacobian (4, 4)."""
    u, w, q, theta = x
    loads = resultant_and_derivatives(at_phase(wing.elements, k), wing.inverse[k], density, u, w, q)
    s, c = np.sin(theta), np.cos(theta)
    rates = np.empty(4)
    rates[0] = -q * w - gravity * s + loads[0, 0] / mass
    rates[1] = q * u + gravity * c + loads[1, 0] / mass
    rates[2] = loads[2, 0] / inertia
    rates[3] = q
    jacobian = np.zeros((4, 4))
    jacobian[0, :3] = loads[0, 1:] / mass
    jacobian[1, :3] = loads[1, 1:] / mass
    jacobian[2, :3] = loads[2, 1:] / inertia
    jacobian[0, 1] -= q
    jacobian[0, 2] -= w
    jacobian[0, 3] = -gravity * c
    jacobian[1, 0] += q
    jacobian[1, 2] += u
    jacobian[1, 3] = -gravity * s
    jacobian[3, 2] = 1.0
    return rates, jacobian


@njit(cache=True)
def integrate_rigid(
    wing: PrescribedWing,
    x0: FloatArray,
    step: float,
    mass: float,
    inertia: float,
    gravity: float,
    density: float,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Classical Runge-Kutta steps over a table at every half step.

    Returns the states (steps + 1, 4), their rates, and the derivative (4, 4) of the last state by
    the first.
    """
    steps = (wing.inverse.shape[0] - 1) // 2
    states = np.empty((steps + 1, 4))
    rates = np.empty((steps + 1, 4))
    states[0] = x0
    x = x0.copy()
    sensitivity = np.eye(4)
    for i in range(steps):
        k1, j1 = rigid_rates(wing, 2 * i, x, mass, inertia, gravity, density)
        s1 = j1 @ sensitivity
        k2, j2 = rigid_rates(wing, 2 * i + 1, x + 0.5 * step * k1, mass, inertia, gravity, density)
        s2 = j2 @ (sensitivity + 0.5 * step * s1)
        k3, j3 = rigid_rates(wing, 2 * i + 1, x + 0.5 * step * k2, mass, inertia, gravity, density)
        s3 = j3 @ (sensitivity + 0.5 * step * s2)
        k4, j4 = rigid_rates(wing, 2 * i + 2, x + step * k3, mass, inertia, gravity, density)
        s4 = j4 @ (sensitivity + step * s3)
        x = x + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        sensitivity = sensitivity + step / 6.0 * (s1 + 2.0 * s2 + 2.0 * s3 + s4)
        rates[i] = k1
        states[i + 1] = x
    rates[steps], _ = rigid_rates(wing, 2 * steps, x, mass, inertia, gravity, density)
    return states, rates, sensitivity
