"""Compiled generalised forces of air, springs and dampers on Exudyn's tree."""

from __future__ import annotations

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.models.air_kernel import Constants, Drivers, Motion, Shapes, air_forces
from birdmb.models.springs import spring_torques
from birdmb.models.tree_coordinates import attitude, generalised, space_state, whole


@kernel
def tree_forces(
    constants: Constants,
    shapes: Shapes,
    drivers: Drivers,
    coordinates: IntArray,
    q: FloatArray,
    v: FloatArray,
    air: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Generalised forces (n,) on the tree, and the `clearance` (2,) m of right and left wing.

    At coordinates q and velocities v (n,) of the tree, those of the body being some of
    `tree_coordinates.COORDINATES`, and velocity `air` (3,) m/s of the air forwards, to the right
    and down, seen along the heading. Shapes and drivers are of this instant alone. NaN where q or v
    is not finite.
    """
    body, angles = coordinates.size, drivers.angles.shape[1]
    forces = np.full(q.size, np.nan)
    if not (np.isfinite(q).all() and np.isfinite(v).all()):
        return forces, np.zeros(2)
    place, moves = whole(q[:body], coordinates), whole(v[:body], coordinates)
    twist = space_state(place, moves)[:6].copy()
    seen = place.copy()
    seen[3] = 0.0
    twist[:3] -= attitude(seen).T @ air
    joints = slice(body, body + angles)
    motion = Motion(
        twist.reshape(1, 6),
        np.zeros((1, 3)),
        q[joints].reshape(1, -1),
        v[joints].reshape(1, -1),
        np.empty((1, 0)),
    )
    found = air_forces(constants, shapes, motion, drivers.accelerations[0], np.zeros(1, np.int64))
    loads = found.forces
    wrench = np.zeros(6)
    for b in range(body):
        wrench[constants.links.directions[b]] = loads[0, b]
    on_body = generalised(place, wrench)
    for b in range(body):
        forces[b] = on_body[coordinates[b]]
    torques = loads[0, body:] / constants.links.copies
    torques += spring_torques(
        constants.springs, q[joints] - drivers.angles[0], v[joints] - drivers.rates[0]
    )
    forces[joints] = torques
    if constants.is_mirrored:
        forces[body + angles :] = torques
    return forces, found.clearance
