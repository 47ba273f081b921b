"""Compiled equations of motion of the rigid bird in space, their derivatives and integration.

Equations (Etkin & Reid, Dynamics of Flight, 1996, chapter 4), in body axes about the centre of
mass: m (V' + omega x V) = F + m g, I omega' + omega x I omega = M, phi' = p + tan(theta) (q
sin(phi) + r cos(phi)), theta' = q cos(phi) - r sin(phi). Planar flight is their restriction to its
states.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.airframe import AeroConstants
from birdmb.aerodynamics.prescribed import (
    PrescribedWing,
    WakeTable,
    free_loads,
    symmetric_loads,
)
from birdmb.aerodynamics.prescribed_lags import LagTable, lagged_loads

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
def _times(matrix: FloatArray, x: float, y: float, z: float) -> tuple[float, float, float]:
    # Numbers, not arrays: for products as small as these making arrays would take most of the time.
    return (
        matrix[0, 0] * x + matrix[0, 1] * y + matrix[0, 2] * z,
        matrix[1, 0] * x + matrix[1, 1] * y + matrix[1, 2] * z,
        matrix[2, 0] * x + matrix[2, 1] * y + matrix[2, 2] * z,
    )


@kernel
def _turn(phi: float, theta: float, turn: FloatArray) -> None:
    """Write the axes of the heading along those of the body, (3, 3), and their slopes.

    `turn` (3, 3, 3): the axes, their derivatives with respect to phi, and to theta.
    """
    cr, sr, c, s = np.cos(phi), np.sin(phi), np.cos(theta), np.sin(theta)
    turn[0, 0, 0], turn[0, 0, 1], turn[0, 0, 2] = c, 0.0, -s
    turn[0, 1, 0], turn[0, 1, 1], turn[0, 1, 2] = s * sr, cr, c * sr
    turn[0, 2, 0], turn[0, 2, 1], turn[0, 2, 2] = s * cr, -sr, c * cr
    turn[1, 0, 0], turn[1, 0, 1], turn[1, 0, 2] = 0.0, 0.0, 0.0
    turn[1, 1, 0], turn[1, 1, 1], turn[1, 1, 2] = s * cr, -sr, c * cr
    turn[1, 2, 0], turn[1, 2, 1], turn[1, 2, 2] = -s * sr, -cr, -c * sr
    turn[2, 0, 0], turn[2, 0, 1], turn[2, 0, 2] = -s, 0.0, -c
    turn[2, 1, 0], turn[2, 1, 1], turn[2, 1, 2] = c * sr, 0.0, -s * sr
    turn[2, 2, 0], turn[2, 2, 1], turn[2, 2, 2] = c * cr, 0.0, -s * cr


@kernel
def rigid_rates(
    wing: PrescribedWing,
    left: PrescribedWing | None,
    wakes: WakeTable,
    lags: LagTable | None,
    k: int,
    states: FloatArray,
    air: FloatArray,
    aero: AeroConstants,
    body: RigidBody,
    slopes_wanted: bool,
) -> tuple[FloatArray, FloatArray]:
    """Rates (n,) of the states (n,) at the k-th tabulated phase, and their Jacobian (n, n).

    `air` (3,) m/s is the velocity of the air along the heading, to the right of it and down. Of the
    Jacobian the part that the air makes is left out unless `slopes_wanted`. Without a `left` wing
    it is like the other one, and without `lags` the air has no memory: numba then does not compile
    what only these need, and is handed fewer arrays.
    """
    other = wing
    if left is not None:
        other = left
    own = body.states.size
    x, count = np.zeros(_SIZE), states.size - own
    for i in range(own):
        x[body.states[i]] = states[i]
    turn = np.empty((3, 3, 3))
    _turn(x[_PHI], x[_THETA], turn)
    twist = np.empty(6)
    wx, wy, wz = _times(turn[0], air[0], air[1], air[2])
    twist[0], twist[1], twist[2] = x[0] - wx, x[1] - wy, x[2] - wz
    twist[3], twist[4], twist[5] = x[3], x[4], x[5]
    directions = body.directions if slopes_wanted else body.directions[:0]
    lag_rates = np.empty((0, 1))
    if lags is not None:
        found, lag_rates = lagged_loads(
            wing, other, lags, k, aero, twist, directions, states[own:], slopes_wanted
        )
    elif body.directions.size == 6:
        found = free_loads(wing, other, wakes, k, aero, twist, directions)
    else:
        found = symmetric_loads(wing, k, aero, twist, directions)
    wrench, slopes = np.empty(6), _by_state(found, directions, turn, air, count)
    for i in range(6):
        wrench[i] = found[i, 0]
    _add_weight(body, turn, wrench, slopes)
    _take_inertia(body, x, wrench, slopes)

    rates, jacobian = np.zeros(_SIZE + count), np.zeros((_SIZE + count, _SIZE + count))
    if lags is not None:
        _accelerate_with_air(body, lags.inertia[k], x, wrench, slopes, rates, jacobian)
        rates[_SIZE:] = lag_rates[:, 0]
        jacobian[_SIZE:] = _by_state(lag_rates, directions, turn, air, count)
    else:
        _accelerate(body, wrench, slopes, rates, jacobian)
    _write_attitude(x, rates, jacobian)
    size = states.size
    own_rates, own_jacobian = np.empty(size), np.empty((size, size))
    for i in range(size):
        row = body.states[i] if i < own else _SIZE + i - own
        own_rates[i] = rates[row]
        for j in range(size):
            own_jacobian[i, j] = jacobian[row, body.states[j] if j < own else _SIZE + j - own]
    return own_rates, own_jacobian


@kernel
def _by_state(
    found: FloatArray, directions: IntArray, turn: FloatArray, air: FloatArray, count: int
) -> FloatArray:
    """Derivatives (R, 8 + count) by the states in space and the lags.

    Of values `found` (R, 1 + D) with derivatives by `directions` of the twist, then by the lags.
    """
    rows, given = found.shape[0], directions.size + 1
    slopes = np.zeros((rows, _SIZE + count))
    for m in range(directions.size):
        for i in range(rows):
            slopes[i, directions[m]] = found[i, m + 1]
    for a in range(2):
        # As the body turns, the air's velocity turns in its axes.
        wx, wy, wz = _times(turn[a + 1], air[0], air[1], air[2])
        for i in range(rows):
            slopes[i, _PHI + a] = -slopes[i, 0] * wx - slopes[i, 1] * wy - slopes[i, 2] * wz
    for m in range(found.shape[1] - given):
        for i in range(rows):
            slopes[i, _SIZE + m] = found[i, given + m]
    return slopes


@kernel
def _accelerate(
    body: RigidBody, wrench: FloatArray, slopes: FloatArray, rates: FloatArray, jacobian: FloatArray
) -> None:
    """Write what a wrench (6,) changes of the velocities, with its derivatives (6, 8)."""
    for i in range(3):
        rates[i] = wrench[i] / body.mass
    rates[3], rates[4], rates[5] = _times(body.inverse, wrench[3], wrench[4], wrench[5])
    for m in range(slopes.shape[1]):
        for i in range(3):
            jacobian[i, m] = slopes[i, m] / body.mass
        jacobian[3, m], jacobian[4, m], jacobian[5, m] = _times(
            body.inverse, slopes[3, m], slopes[4, m], slopes[5, m]
        )


@kernel
def _accelerate_with_air(
    body: RigidBody,
    air: FloatArray,
    x: FloatArray,
    wrench: FloatArray,
    slopes: FloatArray,
    rates: FloatArray,
    jacobian: FloatArray,
) -> None:
    """As `_accelerate`, of a body that has to accelerate `air` (6, 6) with it.

    Apparent mass resists acceleration in space, of which turning axes hold omega x V.
    """
    u, v, w, p, q, r = x[:6]
    turning, by_state = np.empty(3), np.zeros((3, slopes.shape[1]))
    turning[0], turning[1], turning[2] = q * w - r * v, r * u - p * w, p * v - q * u
    by_state[0, 1], by_state[0, 2], by_state[0, 4], by_state[0, 5] = -r, q, w, -v
    by_state[1, 0], by_state[1, 2], by_state[1, 3], by_state[1, 5] = r, -p, -w, u
    by_state[2, 0], by_state[2, 1], by_state[2, 3], by_state[2, 4] = -q, p, v, -u
    moving = body.directions
    size = moving.size
    mass, right = np.zeros((size, size)), np.empty((size, 1 + slopes.shape[1]))
    for a in range(size):
        i = moving[a]
        right[a, 0], right[a, 1:] = wrench[i], slopes[i]
        for m in range(3):
            right[a, 0] -= air[i, m] * turning[m]
            right[a, 1:] -= air[i, m] * by_state[m]
        for b in range(size):
            j = moving[b]
            mass[a, b] = air[i, j]
            if i >= 3 and j >= 3:
                mass[a, b] += body.inertia[i - 3, j - 3]
        if i < 3:
            mass[a, a] += body.mass
    found = np.full(right.shape, np.nan)
    # The solver refuses what is not finite; a flow that diverges is told by whoever follows it.
    if np.isfinite(np.sum(right)):
        found[:] = np.linalg.solve(mass, right)
    for a in range(size):
        rates[moving[a]], jacobian[moving[a]] = found[a, 0], found[a, 1:]


@kernel
def _add_weight(body: RigidBody, turn: FloatArray, wrench: FloatArray, slopes: FloatArray) -> None:
    """Add the weight to a wrench (6,) and its derivatives (6, 8) with respect to the states."""
    weight = body.mass * body.gravity
    for i in range(3):
        wrench[i] += weight * turn[0, i, 2]
        slopes[i, _PHI] += weight * turn[1, i, 2]
        slopes[i, _THETA] += weight * turn[2, i, 2]


@kernel
def _take_inertia(body: RigidBody, x: FloatArray, wrench: FloatArray, slopes: FloatArray) -> None:
    """Take off what turning axes need at steady components: m omega x V and omega x I omega."""
    u, v, w, p, q, r = x[:6]
    wrench[0] -= body.mass * (q * w - r * v)
    wrench[1] -= body.mass * (r * u - p * w)
    wrench[2] -= body.mass * (p * v - q * u)
    for i, j, spin, velocity in ((0, 1, r, w), (1, 2, p, u), (2, 0, q, v)):
        slopes[i, j] += body.mass * spin
        slopes[j, i] -= body.mass * spin
        slopes[i, 3 + j] -= body.mass * velocity
        slopes[j, 3 + i] += body.mass * velocity
    hx, hy, hz = _times(body.inertia, p, q, r)
    wrench[3] -= q * hz - r * hy
    wrench[4] -= r * hx - p * hz
    wrench[5] -= p * hy - q * hx
    for m in range(3):
        ax, ay, az = body.inertia[0, m], body.inertia[1, m], body.inertia[2, m]
        slopes[3, 3 + m] -= q * az - r * ay
        slopes[4, 3 + m] -= r * ax - p * az
        slopes[5, 3 + m] -= p * ay - q * ax
    for i, j, momentum in ((3, 4, hz), (4, 5, hx), (5, 3, hy)):
        slopes[i, j] -= momentum
        slopes[j, i] += momentum


@kernel
def _write_attitude(x: FloatArray, rates: FloatArray, jacobian: FloatArray) -> None:
    """Write the rates of phi and theta and their derivatives with respect to the states (8,)."""
    p, q, r, phi, theta = x[3:]
    cr, sr, slope = np.cos(phi), np.sin(phi), np.tan(theta)
    yawing = q * sr + r * cr
    rates[_PHI] = p + slope * yawing
    rates[_THETA] = q * cr - r * sr
    jacobian[_PHI, 3], jacobian[_PHI, 4], jacobian[_PHI, 5] = 1.0, slope * sr, slope * cr
    jacobian[_PHI, _PHI] = slope * rates[_THETA]
    jacobian[_PHI, _THETA] = (1.0 + slope * slope) * yawing
    jacobian[_THETA, 4], jacobian[_THETA, 5] = cr, -sr
    jacobian[_THETA, _PHI] = -yawing


@kernel
def rates_along(
    wing: PrescribedWing,
    left: PrescribedWing | None,
    wakes: WakeTable,
    lags: LagTable | None,
    phase: IntArray,
    states: FloatArray,
    air: FloatArray,
    aero: AeroConstants,
    body: RigidBody,
    slopes_wanted: bool,
) -> tuple[FloatArray, FloatArray]:
    """Rates (K, n) of `states` (K, n) at tabulated phases (K,), and their Jacobians (K, n, n).

    `air` (K, 3) m/s and `slopes_wanted` as for `rigid_rates`. NaN where a state is not finite.
    """
    count, n = states.shape
    rates, jacobians = np.full((count, n), np.nan), np.full((count, n, n), np.nan)
    for i in range(count):
        if np.isfinite(states[i]).all():
            rates[i], jacobians[i] = rigid_rates(
                wing, left, wakes, lags, phase[i], states[i], air[i], aero, body, slopes_wanted
            )
    return rates, jacobians


@kernel
def integrate_rigid(
    wing: PrescribedWing,
    left: PrescribedWing | None,
    wakes: WakeTable,
    lags: LagTable | None,
    x0: FloatArray,
    step: float,
    air: FloatArray,
    aero: AeroConstants,
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
    # Not the constants: with each of these numba compiles all that follows anew.
    wanted, unwanted = steps >= 0, steps < 0
    sensitivity = np.eye(n)
    for i in range(steps):
        k, g = 2 * i, air[2 * i + 1]
        k1, j1 = rigid_rates(wing, left, wakes, lags, k, x, air[k], aero, body, wanted)
        s1 = j1 @ sensitivity
        k2, j2 = rigid_rates(
            wing, left, wakes, lags, k + 1, x + 0.5 * step * k1, g, aero, body, wanted
        )
        s2 = j2 @ (sensitivity + 0.5 * step * s1)
        k3, j3 = rigid_rates(
            wing, left, wakes, lags, k + 1, x + 0.5 * step * k2, g, aero, body, wanted
        )
        s3 = j3 @ (sensitivity + 0.5 * step * s2)
        k4, j4 = rigid_rates(
            wing, left, wakes, lags, k + 2, x + step * k3, air[k + 2], aero, body, wanted
        )
        s4 = j4 @ (sensitivity + step * s3)
        x = x + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        sensitivity = sensitivity + step / 6.0 * (s1 + 2.0 * s2 + 2.0 * s3 + s4)
        rates[i] = k1
        states[i + 1] = x
    k = 2 * steps
    rates[steps], _ = rigid_rates(wing, left, wakes, lags, k, x, air[k], aero, body, unwanted)
    return states, rates, sensitivity
