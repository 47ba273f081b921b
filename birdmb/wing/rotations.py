"""Rotations along the joint chain, for real angles and such with infinitesimal imaginary parts."""

from __future__ import annotations

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import Array, FloatArray


@kernel
def cross(a: FloatArray, b: FloatArray, out: FloatArray) -> None:
    """Write the cross product of vectors (3,): for so small ones making arrays takes longest."""
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]


@kernel
def cosine_and_sine(angle: complex) -> tuple[complex, complex]:
    """Cosine and sine of `angle` (rad), to first order in its imaginary part.

    Which is what a complex step carries; functions of any complex number take five times as long.
    """
    c, s, rate = np.cos(angle.real), np.sin(angle.real), angle - angle.real
    return c - s * rate, s + c * rate


@kernel
def rotate_about(R: Array, axis: FloatArray, angle: complex) -> Array:
    """R times the rotation by `angle` (rad) about the unit `axis` (Rodrigues' formula)."""
    x, y, z = axis
    c, s = cosine_and_sine(angle)
    k = 1.0 - c
    xy, xz, yz = x * y * k, x * z * k, y * z * k
    xx, yy, zz = c + x * x * k, c + y * y * k, c + z * z * k
    out = np.empty_like(R)
    for i in range(3):
        a, b, d = R[i, 0], R[i, 1], R[i, 2]
        out[i, 0] = a * xx + b * (xy + z * s) + d * (xz - y * s)
        out[i, 1] = a * (xy - z * s) + b * yy + d * (yz + x * s)
        out[i, 2] = a * (xz + y * s) + b * (yz - x * s) + d * zz
    return out


@kernel
def turned_about(axis: Array, angle: complex, v: Array) -> Array:
    """The vector `v` (3,) turned by `angle` (rad) about the unit `axis` (3,)."""
    c, s = cosine_and_sine(angle)
    along = (1.0 - c) * (axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2])
    out = np.empty_like(v)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        out[i] = c * v[i] + s * (axis[j] * v[k] - axis[k] * v[j]) + along * axis[i]
    return out
