"""Floquet multipliers of a product of matrices, each with an error bound."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, cast

import numpy as np
import scipy.linalg

from birdmb._typing import ComplexArray, FloatArray

Stability = Literal["stable", "unstable", "undecided"]

_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Spectrum:
    """Eigenvalues of a monodromy matrix, largest modulus first.

    Attributes:
        monodromy: the product (n, n).
        multipliers: eigenvalues (n,).
        errors: bound of the error of each, (n,).
        modes: right eigenvectors in the columns (n, n), largest scaled entry 1.
        left_modes: left eigenvectors (rows act on states), columns w with w^H v = 1.
    """

    monodromy: FloatArray
    multipliers: ComplexArray
    errors: FloatArray
    modes: ComplexArray
    left_modes: ComplexArray


def product(factors: FloatArray) -> FloatArray:
    """Monodromy matrix: the product of the segment Jacobians (M, n, n), first segment rightmost."""
    total: FloatArray = factors[0]
    for factor in factors[1:]:
        total = factor @ total
    return total


def product_error(factors: FloatArray, errors: FloatArray) -> FloatArray:
    """Bound (n, n), to first order, of the entries' errors of the product of `factors` (M, n, n).

    `errors` (M, n, n) are those of the factors; the round-off of each multiplication is added.
    """
    m, n, _ = factors.shape
    after = [np.eye(n)]
    for factor in factors[:0:-1]:
        after.append(after[-1] @ factor)
    total, before = np.zeros((n, n)), np.eye(n)
    for k in range(m):
        local = errors[k] + n * _EPS * np.abs(factors[k])
        total += np.abs(after[m - 1 - k]) @ local @ np.abs(before)
        before = factors[k] @ before
    return total


def spectrum(monodromy: FloatArray, error: FloatArray, scale: FloatArray) -> Spectrum:
    """Eigenvalues, eigenvectors and error bounds of a monodromy matrix.

    The bound of a multiplier is its first-order perturbation under the entrywise `error` (n, n),
    |y|^T E |x| / |y^H x| with its right and left eigenvectors x, y (Golub & Van Loan, section 7.2),
    plus the backward error of the eigenvalue solver. For a nearly defective multiplier y^H x
    vanishes and this grows large; it is capped by Henrici's bound for non-normal matrices, which
    grows as a root of the error there. `scale` (n,) makes states of different units comparable.
    """
    units = np.divide.outer(scale, scale)
    matrix, bound = monodromy / units, error / units
    n = len(matrix)
    solver_error = n * _EPS * float(np.linalg.norm(matrix))
    values, left, right = cast(
        "tuple[ComplexArray, ComplexArray, ComplexArray]",
        scipy.linalg.eig(matrix, left=True, right=True),
    )
    order = np.lexsort((-values.imag, -np.abs(values)))
    values, left, right = values[order], left[:, order], right[:, order]

    overlap = np.abs(np.einsum("ik,ik->k", left.conj(), right))
    numerator = np.einsum("ik,ij,jk->k", np.abs(left), bound, np.abs(right)) + solver_error
    with np.errstate(divide="ignore"):
        first_order = numerator / overlap
    errors = np.minimum(first_order, _henrici(matrix, float(np.linalg.norm(bound)) + solver_error))

    peak = right[np.abs(right).argmax(axis=0), np.arange(n)]
    right = right / peak
    with np.errstate(divide="ignore", invalid="ignore"):
        left = left / np.einsum("ik,ik->k", left.conj(), right).conj()
    modes, left_modes = right * scale[:, None], left / scale[:, None]
    return Spectrum(monodromy, values.astype(complex), errors, modes, left_modes)


def _henrici(matrix: FloatArray, size: float) -> float:
    triangle = scipy.linalg.schur(matrix, output="complex")[0]
    departure = float(np.linalg.norm(np.triu(triangle, 1)))
    theta = size * float(np.sum(departure ** np.arange(len(matrix))))
    return float(max(theta, theta ** (1 / len(matrix))))


def verdict(multipliers: ComplexArray, errors: FloatArray) -> Stability:
    """Return "stable", "unstable", or "undecided" if the error bars leave it open."""
    modulus = np.abs(multipliers)
    if (modulus - errors > 1).any():
        return "unstable"
    return "stable" if (modulus + errors < 1).all() else "undecided"
