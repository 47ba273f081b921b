"""A first guess of the state in which a bird flies: the loads balanced on average over a beat."""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import least_squares

from birdmb._typing import FloatArray
from birdmb.aerodynamics.airframe import Airframe
from birdmb.aerodynamics.prescribed import PrescribedWing, bird_loads
from birdmb.errors import StateError
from birdmb.topology import Bird

_SLOWEST, _FASTEST = 1.0, 60.0  # m/s
_BALANCED = 1e-12  # (m/s2)^2
_IN_PROPORTION = 1e60  # m/s2, and per m/s; its square and sums of it are finite


def mean_trim(bird: Bird, wing: PrescribedWing, frame: Airframe) -> FloatArray:
    """State (4,) u, w, q = 0, theta that balances the mean loads of a body held steady.

    `wing` holds phases at equal distances over a whole beat. Where no state balances them, the one
    that comes closest is returned: the search for the limit cycle has the last word. Raises
    `StateError` where the loads are out of all proportion.
    """
    phases = wing.inverse.shape[0]
    mass, inertia, g = bird.body.mass, bird.body.inertia_yy, bird.gravity

    def mean_loads(u: float, w: float) -> FloatArray:
        total = np.zeros((3, 4))
        for k in range(phases):
            total += bird_loads(wing, k, frame, u, w, 0.0)
        return np.asarray(total / phases)

    def accelerations(y: FloatArray) -> FloatArray:
        u, w, theta = y
        force_x, force_z, moment = mean_loads(u, w)[:, 0]
        return np.array(
            [
                force_x / mass - g * np.sin(theta),
                force_z / mass + g * np.cos(theta),
                # In m/s2 at the tail of the body's radius of gyration, to weigh like the others.
                moment / np.sqrt(mass * inertia),
            ]
        )

    def jacobian(y: Sequence[float] | FloatArray) -> FloatArray:
        u, w, theta = y
        slopes = mean_loads(u, w)[:, 1:3]
        scale = np.array([mass, mass, np.sqrt(mass * inertia)])
        gravity = np.array([-g * np.cos(theta), -g * np.sin(theta), 0.0])
        return np.column_stack([slopes / scale[:, None], gravity])

    trials = []
    for u in (12.0, 20.0, 7.0, 35.0):
        start = [u, -0.05 * u, 0.0]
        at_start = np.concatenate([accelerations(np.array(start)), jacobian(start).ravel()])
        if not (np.abs(at_start) < _IN_PROPORTION).all():
            continue
        found = least_squares(
            accelerations,
            start,
            jac=jacobian,
            bounds=([_SLOWEST, -_FASTEST, -1.5], [_FASTEST, _FASTEST, 1.5]),
            x_scale=[10.0, 2.0, 0.2],
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
