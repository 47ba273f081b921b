"""Compiled accelerations of the multibody bird at many instants."""

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import BoolArray, FloatArray, IntArray
from birdmb.aerodynamics.airframe import Airframe
from birdmb.models.multibody_kernel import air_forces
from birdmb.models.springs import Springs, spring_torques
from birdmb.wing.arrays import WingArrays
from birdmb.wing.stacked import StackedShapes, shape_at

_BODY = 3


@kernel
def free_accelerations(
    wing: WingArrays,
    shapes: StackedShapes,
    shape_of: IntArray,
    turning: int,
    frame: Airframe,
    springs: Springs,
    prescribed: BoolArray,
    q: FloatArray,
    v: FloatArray,
    driver_angles: FloatArray,
    driver_rates: FloatArray,
    given: FloatArray,
    air: FloatArray,
    mass: FloatArray,
    bias: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Accelerations (K, F) of the free coordinates of body and right wing, by exact partition.

    At K instants: coordinates `q` and velocities `v` (K, c) of the tree, angles and rates (K, A) of
    the drivers, accelerations `given` (K, c) of the `prescribed` (c,) coordinates, velocity `air`
    (K, 2) m/s of the air in the world, mass matrices (K, c, c), and `bias` (K, c), what inertia and
    gravity leave on the left-hand side. `shape_of` (K,) tells which of the stacked `shapes` belongs
    to an instant, with the first `turning` joints at zero. Both wings move alike: each free joint
    of the right wing stands for the pair. The second result is the clearance (K,) m of the wings
    (`birdmb.aerodynamics.elements.clearance`).
    """
    count, size = q.shape
    joints = (size - _BODY) // 2
    free = np.flatnonzero(~prescribed[: _BODY + joints])
    found, clearance = np.empty((count, free.size)), np.empty(count)
    load = np.empty(size)
    for k in range(count):
        angles, rates = q[k, _BODY : _BODY + joints].copy(), v[k, _BODY : _BODY + joints].copy()
        body, torques, clearance[k] = air_forces(
            wing,
            shape_at(shapes, shape_of[k]),
            turning,
            angles,
            rates,
            frame,
            q[k, 2],
            v[k, 0] - air[k, 0],
            v[k, 1] - air[k, 1],
            v[k, 2],
        )
        torques += spring_torques(springs, angles - driver_angles[k], rates - driver_rates[k])
        load[:_BODY] = body
        load[_BODY : _BODY + joints] = torques
        load[_BODY + joints :] = torques
        load -= bias[k]
        for j in range(size):
            if prescribed[j]:
                for i in range(size):
                    load[i] -= mass[k, i, j] * given[k, j]
        matrix = np.empty((free.size, free.size))
        right = np.empty(free.size)
        for a in range(free.size):
            i = free[a]
            right[a] = load[i] + (load[i + joints] if i >= _BODY else 0.0)
            for b in range(free.size):
                j = free[b]
                total = mass[k, i, j]
                if i >= _BODY:
                    total += mass[k, i + joints, j]
                if j >= _BODY:
                    total += mass[k, i, j + joints]
                    if i >= _BODY:
                        total += mass[k, i + joints, j + joints]
                matrix[a, b] = total
        found[k] = np.linalg.solve(matrix, right)
    return found, clearance
