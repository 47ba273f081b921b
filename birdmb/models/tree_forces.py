"""Compiled loads of air, springs and dampers on Exudyn's tree, with the air's inertia and lags."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.models.air_kernel import (
    AirForces,
    Constants,
    Drivers,
    Motion,
    Shapes,
    air_forces,
)
from birdmb.models.springs import spring_torques
from birdmb.models.tree_coordinates import (
    attitude,
    generalised,
    space_state,
    spin_change,
    twist_per_rate,
    whole,
)


class TreeLoads(NamedTuple):
    """What acts on the n coordinates of the tree at one instant, but gravity and its own inertia.

    The accelerations of prescribed joints act in the forces, so that the inertia is without them.
    """

    forces: FloatArray  # (n,) generalised
    inertia: FloatArray  # (n, n) mass matrix of the air; (0, 0) where it has no memory
    lag_rates: FloatArray  # (L,)


@kernel
def tree_loads(
    constants: Constants,
    shapes: Shapes,
    drivers: Drivers,
    coordinates: IntArray,
    q: FloatArray,
    v: FloatArray,
    lags: FloatArray,
    air: FloatArray,
) -> tuple[TreeLoads, FloatArray]:
    """What acts on Exudyn's tree, and the wings' `clearance` (2,) m.

    At coordinates q and velocities v (n,) of the tree, those of the body being some of
    `tree_coordinates.COORDINATES`, at `lags` (L,) and in air of velocity `air` (3,) m/s forwards,
    to the right and down, seen along the heading. Shapes and drivers are of this instant alone. NaN
    where q or v is not finite.
    """
    body, angles = coordinates.size, drivers.angles.shape[1]
    remembers = q.size if lags.size else 0
    acting = TreeLoads(
        np.full(q.size, np.nan), np.zeros((remembers, remembers)), np.full(lags.size, np.nan)
    )
    forces = acting.forces
    if not (np.isfinite(q).all() and np.isfinite(v).all()):
        return acting, np.zeros(2)
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
        lags.reshape(1, -1),
    )
    found = air_forces(constants, shapes, motion, drivers.accelerations[0], np.zeros(1, np.int64))
    loads = found.forces
    if lags.size:
        acting.lag_rates[:] = found.lag_rates[0]
        _resist(constants, coordinates, place, moves, found, acting.inertia)
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
    return acting, found.clearance


@kernel
def _resist(
    constants: Constants,
    coordinates: IntArray,
    place: FloatArray,
    moves: FloatArray,
    air: AirForces,
    inertia: FloatArray,
) -> None:
    """Write the air's `inertia` (n, n) of the tree's free coordinates, and add to its forces.

    At coordinates `place` and velocities `moves` (6,) of the body. Its spin changes even where yaw,
    pitch and roll do not accelerate; the forces that resist this change are added.
    """
    directions, free = constants.links.directions, np.flatnonzero(~constants.prescribed)
    body, size = directions.size, constants.prescribed.size
    change = np.zeros(6)
    change[3:] = spin_change(place, moves)
    for a in free:
        for b in range(body):
            air.forces[0, a] -= air.inertia[a, b] * change[directions[b]]
    per_rate = twist_per_rate(place)
    copies = int(constants.links.copies)  # of each joint, which stands for those of both wings
    for side in range(copies):
        moved = np.zeros((size, inertia.shape[0]))
        for a in free:
            if a >= body:
                moved[a, a + side * (size - body)] = 1.0
                continue
            for b in range(body):
                moved[a, b] = per_rate[directions[a], coordinates[b]]
        inertia += moved.T @ (air.inertia / copies) @ moved
