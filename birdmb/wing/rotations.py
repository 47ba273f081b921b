"""Rotations along the joint chain, for real and complex angles."""

import numpy as np
from numba import njit

from birdmb._typing import Array, FloatArray


@njit(cache=True)
def rotate_about(R: Array, axis: FloatArray, angle: complex) -> Array:
    """R times the rotation by `angle` (rad) about the unit `axis` (Rodrigues' formula)."""
    x, y, z = axis
    c = np.cos(angle)
    s = np.sin(angle)
    k = 1.0 - c
    Q = np.empty_like(R)
    Q[0, 0] = c + x * x * k
    Q[0, 1] = x * y * k - z * s
    Q[0, 2] = x * z * k + y * s
    Q[1, 0] = x * y * k + z * s
    Q[1, 1] = c + y * y * k
    Q[1, 2] = y * z * k - x * s
    Q[2, 0] = x * z * k - y * s
    Q[2, 1] = y * z * k + x * s
    Q[2, 2] = c + z * z * k
    out = np.zeros_like(R)
    for i in range(3):
        for j in range(3):
            for m in range(3):
                out[i, j] += R[i, m] * Q[m, j]
    return out
