"""Compiled accelerations of the multibody bird at many instants.

Most of the work depends on the joints' angles alone, and differences of the rates by the states
leave these as they are more often than not: states of a time with the same angles share it.
"""

from __future__ import annotations

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.models.air_kernel import Constants, Drivers, Motion, Shapes, air_forces
from birdmb.models.row_groups import groups_of
from birdmb.models.springs import spring_torques
from birdmb.models.tree_kernel import bias_forces, mass_matrix, placed_links


@kernel
def free_accelerations(
    constants: Constants, shapes: Shapes, time_of: IntArray, drivers: Drivers, motion: Motion
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Accelerations (K, F) of the free coordinates of body and wings, by exact partition.

    `time_of` (K,) tells which of the drivers' times a row has. The body's accelerations are those
    in space, in body axes. The second result are the rates (K, L) of the lags, the third is the
    clearance (K, 2) m of right and left wing (`birdmb.aerodynamics.elements.clearance`); where one
    is negative there are no accelerations.
    """
    links, prescribed = constants.links, constants.prescribed
    count, size, body = time_of.size, prescribed.size, links.directions.size
    free = np.flatnonzero(~prescribed)
    found, distance = np.full((count, free.size), np.nan), np.empty((count, 2))
    lag_rates = np.full(motion.lags.shape, np.nan)
    groups = groups_of(time_of, motion.angles)
    for g in range(groups.first.size):
        rows = groups.members[groups.start[g] : groups.start[g + 1]]
        angles, t = motion.angles[rows[0]], time_of[rows[0]]
        loads = air_forces(constants, shapes, motion, drivers.accelerations[t], rows)
        distance[rows], lag_rates[rows] = loads.clearance, loads.lag_rates
        if not (loads.clearance >= 0.0).all() or free.size == 0:
            continue
        placed = placed_links(links, angles)
        mass = mass_matrix(links, placed)
        matrix, right = np.empty((free.size, free.size)), np.empty((free.size, rows.size))
        driven = np.zeros(free.size)
        for a in range(free.size):
            for b in range(free.size):
                matrix[a, b] = mass[free[a], free[b]] + loads.inertia[free[a], free[b]]
            for j in range(body, size):
                if prescribed[j]:
                    driven[a] += mass[free[a], j] * drivers.accelerations[t, j - body]
        for r in range(rows.size):
            k = rows[r]
            rates = motion.rates[k]
            left = bias_forces(links, placed, rates, motion.twist[k, 3:], motion.gravity[k])
            torques = spring_torques(
                constants.springs, angles - drivers.angles[t], rates - drivers.rates[t]
            )
            for a in range(free.size):
                j = free[a]
                right[a, r] = loads.forces[r, j] - left[j] - driven[a]
                if j >= body:
                    right[a, r] += links.copies * torques[j - body]
        solved = np.linalg.solve(matrix, right)
        for r in range(rows.size):
            found[rows[r]] = solved[:, r]
    return found, lag_rates, distance
