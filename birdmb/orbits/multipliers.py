"""Floquet multipliers of a product of segment Jacobians, each with an error bound.

Two interchangeable solvers, both of type `MultiplierSolver`: `product_multipliers` and
`periodic_multipliers` (module `periodic`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol, cast

import numpy as np
import scipy.linalg
from scipy.optimize import linear_sum_assignment

from birdmb._typing import ComplexArray, FloatArray

Stability = Literal["stable", "unstable", "undecided"]

_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Spectrum:
    """Multipliers, largest modulus first, with their modes.

    Attributes:
        multipliers: eigenvalues (n,) of the product.
        errors: bound of the error of each, (n,).
        modes: right eigenvectors in the columns (n, n); largest entry 1 in units of the scale.
        left_modes: left eigenvectors in the columns (n, n), with left^H right = 1.
        modes_along: periodic parts (M, n, n) of the modes at the starts of the segments: what is
            left of a mode after division by exp(exponent * time).
    """

    multipliers: ComplexArray
    errors: FloatArray
    modes: ComplexArray
    left_modes: ComplexArray
    modes_along: ComplexArray


class MultiplierSolver(Protocol):
    """Eigenvalues and modes of a product of matrices.

    `factors` (M, n, n) are the segment Jacobians, the first segment first; `errors` (M, n, n)
    bounds of the errors of their entries; `scale` (n,) the typical sizes of the states, which makes
    states of different units comparable.
    """

    def __call__(self, factors: FloatArray, errors: FloatArray, scale: FloatArray, /) -> Spectrum:
        """Solve."""


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
    n = factors.shape[1]
    after, before = [np.eye(n)], [np.eye(n)]
    for factor in factors[:0:-1]:
        after.append(after[-1] @ factor)
    for factor in factors[:-1]:
        before.append(factor @ before[-1])
    local = errors + n * _EPS * np.abs(factors)
    return np.asarray((np.abs(after[::-1]) @ local @ np.abs(before)).sum(axis=0))


def eigenvalues_with_errors(
    matrix: FloatArray, error: FloatArray
) -> tuple[ComplexArray, FloatArray, ComplexArray, ComplexArray]:
    """Eigenvalues, their error bounds, right and left eigenvectors with left^H right = 1.

    The bound is the first-order perturbation under the entrywise `error` (n, n) of the matrix,
    |y|^T E |x| / |y^H x| with right and left eigenvectors x, y (Golub & Van Loan, section 7.2),
    plus the backward error of the eigenvalue solver. For a nearly defective eigenvalue y^H x
    vanishes and this grows large; it is capped by Henrici's bound for non-normal matrices, which
    grows as a root of the error there.
    """
    n = len(matrix)
    # Below 1e-138 LAPACK returns eigenvalues in another scale, and squares are lost.
    size = float(np.abs(matrix).max()) or 1.0
    with np.errstate(over="ignore"):
        matrix, error = matrix / size, error / size
    solver_error = n * _EPS * float(np.linalg.norm(matrix))
    values, left, right = cast(
        "tuple[ComplexArray, ComplexArray, ComplexArray]",
        scipy.linalg.eig(matrix, left=True, right=True),
    )
    overlap = np.einsum("ik,ik->k", left.conj(), right)
    numerator = np.einsum("ik,ij,jk->k", np.abs(left), error, np.abs(right)) + solver_error
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        first_order = numerator / np.abs(overlap)
        left = left / overlap.conj()
        most = _henrici(matrix, float(np.linalg.norm(error)) + solver_error)
    values = np.asarray(size * values, complex)
    errors: FloatArray = size * np.minimum(first_order, most)
    return values, errors, right.astype(complex), left.astype(complex)


def _henrici(matrix: FloatArray, size: float) -> float:
    triangle = scipy.linalg.schur(matrix, output="complex")[0]
    departure = float(np.linalg.norm(np.triu(triangle, 1)))
    theta = size * float(np.sum(departure ** np.arange(len(matrix))))
    return float(max(theta, theta ** (1 / len(matrix))))


def ordered_spectrum(
    values: ComplexArray,
    errors: FloatArray,
    left: ComplexArray,
    along: ComplexArray,
    scale: FloatArray,
) -> Spectrum:
    """Sort by modulus, normalise the modes and give them the units of the states."""
    order = np.lexsort((-values.imag, -np.abs(values)))
    left, along = left[:, order], along[:, :, order]
    start = along[0]
    peak = start[np.abs(start).argmax(axis=0), np.arange(len(values))]
    # A mode whose multiplier underflows is not known along the orbit.
    with np.errstate(invalid="ignore", over="ignore"):
        along = along / peak * scale[:, None]
        left = left * peak.conj() / scale[:, None]
    return Spectrum(values[order], errors[order], along[0], left, along)


def product_multipliers(factors: FloatArray, errors: FloatArray, scale: FloatArray) -> Spectrum:
    """Multipliers as eigenvalues of the monodromy matrix, the product of the segment Jacobians.

    Method: multiply and take LAPACK's eigenvalues. Precision: an absolute error of about round-off
    times the norm of the product, so that multipliers below 1e-16 of the largest are lost, and
    their error bounds say so. Fast and enough where all multipliers of interest are of similar
    size; otherwise take `periodic_multipliers` with several segments.
    """
    m, n, _ = factors.shape
    units = np.divide.outer(scale, scale)
    scaled = factors / units
    bound = product_error(scaled, errors / units)
    values, value_errors, right, left = eigenvalues_with_errors(product(scaled), bound)
    along = np.empty((m, n, n), complex)
    along[0] = right
    with np.errstate(divide="ignore", invalid="ignore"):
        for k in range(1, m):
            along[k] = scaled[k - 1] @ along[k - 1] / values ** (1 / m)
    return ordered_spectrum(values, value_errors, left, along, scale)


def paired_distances(one: ComplexArray, other: ComplexArray) -> FloatArray:
    """Distances (n,) of a spectrum's multipliers from those of another that they are paired with.

    Paired so that the sum of the relative distances is least: multipliers may differ in size by
    many orders of magnitude.
    """
    distance = np.abs(np.subtract.outer(one, other))
    size = np.maximum(np.abs(one)[:, None], np.abs(other)[None, :])
    with np.errstate(invalid="ignore"):
        relative = np.nan_to_num(distance / size, nan=0.0)
    rows, columns = linear_sum_assignment(relative)
    return np.asarray(distance[rows, columns])


def verdict(multipliers: ComplexArray, errors: FloatArray) -> Stability:
    """Return "stable", "unstable", or "undecided" if the error bars leave it open."""
    modulus = np.abs(multipliers)
    if (modulus - errors > 1).any():
        return "unstable"
    return "stable" if (modulus + errors < 1).all() else "undecided"
