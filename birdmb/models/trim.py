"""A first guess of the state in which a bird flies: the loads balanced on average over a beat."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import least_squares

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.aerodynamics.airframe import AeroConstants
from birdmb.aerodynamics.prescribed import PrescribedWing, symmetric_loads
from birdmb.errors import StateError
from birdmb.topology import Bird

# Bounds of u, w (m/s) and theta (rad).
_LEAST, _MOST = np.array([1.0, -60.0, -1.5]), np.array([60.0, 60.0, 1.5])
_BALANCED = 1e-12  # (m/s2)^2
_IN_PROPORTION = 1e60  # m/s2, and per m/s; its square and sums of it are finite
_NEWTON_STEPS = 20
_SMALLEST_DAMPING = 0.1
_SETTLED = 1e-16  # (m/s2)^2


def mean_trim(bird: Bird, wing: PrescribedWing, aero: AeroConstants) -> FloatArray:
    """State (4,) u, w, q = 0, theta that balances the mean loads of a body held steady.

    `wing` holds phases at equal distances over a whole beat. Where no state balances them, the one
    that comes closest is returned: the search for the limit cycle has the last word. Raises
    `StateError` where the loads are out of all proportion.
    """

    body = bird.assembled.body

    def imbalance(y: FloatArray) -> FloatArray:
        weights = (body.mass, body.inertia_yy, bird.gravity)
        return np.asarray(_imbalance(wing, aero, *weights, y))

    def residual(y: FloatArray) -> FloatArray:
        return imbalance(y)[:, 0]

    def slopes(y: FloatArray) -> FloatArray:
        return imbalance(y)[:, 1:]

    trials = []
    for u in (12.0, 20.0, 7.0, 35.0):
        start = np.array([u, -0.05 * u, 0.0])
        at_start = imbalance(start)
        if not (np.abs(at_start) < _IN_PROPORTION).all():
            continue
        # Newton's method is much cheaper; the search within bounds has better prospects.
        balanced = _newton(imbalance, start, at_start)
        if balanced is not None:
            return np.insert(balanced, 2, 0.0)
        found = least_squares(
            residual, start, jac=slopes, bounds=(_LEAST, _MOST), x_scale=[10.0, 2.0, 0.2]
        )
        trials.append(found)
        if found.cost < _BALANCED:
            break
    if not trials:
        raise StateError(
            f"{bird.name}: the loads are out of all proportion at every speed from 7 to 35 m/s; "
            f"look at the wing's lengths, air.density, gravity, the coefficients of drag, and the "
            f"mass and inertia of the body."
        )
    u, w, theta = min(trials, key=lambda found: float(found.cost)).x
    return np.array([u, w, 0.0, theta])


@kernel
def _imbalance(
    wing: PrescribedWing,
    aero: AeroConstants,
    mass: float,
    inertia: float,
    gravity: float,
    y: FloatArray,
) -> FloatArray:
    """Mean accelerations (3,) m/s2 at u, w, theta, and their derivatives by these; (3, 4).

    The third is the pitching moment's at the tail of the body's radius of gyration, to weigh like
    the others.
    """
    phases = wing.inverse.shape[0]
    twist = np.array([y[0], 0.0, y[1], 0.0, 0.0, 0.0])
    velocities = np.array([0, 2])
    wrench = np.zeros((6, 3))
    for k in range(phases):
        wrench += symmetric_loads(wing, k, aero, twist, velocities)
    total = np.zeros((3, 4))
    total[0, :3] = wrench[0] / (mass * phases)
    total[1, :3] = wrench[2] / (mass * phases)
    total[2, :3] = wrench[4] / (np.sqrt(mass * inertia) * phases)
    s, c = np.sin(y[2]), np.cos(y[2])
    total[0, 0] -= gravity * s
    total[1, 0] += gravity * c
    total[0, 3] = -gravity * c
    total[1, 3] = -gravity * s
    return total


def _newton(
    imbalance: Callable[[FloatArray], FloatArray], start: FloatArray, at_start: FloatArray
) -> FloatArray | None:
    """State u, w, theta that Newton's method leads to, if it is balanced and within bounds."""
    y, found = start, at_start
    size = float(np.sum(found[:, 0] ** 2))
    for _ in range(_NEWTON_STEPS):
        try:
            step = np.linalg.solve(found[:, 1:], -found[:, 0])
        except np.linalg.LinAlgError:
            return None
        before, damping = size, 1.0
        while True:
            ahead = y + damping * step
            if not ((ahead >= _LEAST) & (ahead <= _MOST)).all():
                return None
            found = imbalance(ahead)
            size = float(np.sum(found[:, 0] ** 2))
            if size < before or damping < _SMALLEST_DAMPING:
                break
            damping *= 0.5
        y = ahead
        if size < _SETTLED:
            return y
    return None
