"""Equations of motion of which some coordinates follow a given motion, at many instants."""

from __future__ import annotations

import numpy as np

from birdmb._typing import BoolArray, FloatArray


def partitioned(
    mass: FloatArray, left: FloatArray, given: FloatArray, prescribed: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Accelerations (K, c) of all coordinates, and forces (K, c) that hold the prescribed ones.

    Of M a + left = forces, with M (K, c, c) and no forces on free coordinates. `given` (K, c) are
    accelerations, read where `prescribed` (c,) is true.
    """
    free, a = ~prescribed, given.copy()
    by_given = np.einsum("kij,kj->ki", mass[:, free][:, :, prescribed], a[:, prescribed])
    right = -left[:, free] - by_given
    a[:, free] = np.linalg.solve(mass[:, free][:, :, free], right[:, :, None])[:, :, 0]
    forces = np.where(free, 0.0, np.einsum("kij,kj->ki", mass, a) + left)
    return a, forces
