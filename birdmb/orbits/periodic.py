"""Eigenvalues of a product of matrices without forming it, so that small ones survive."""

from __future__ import annotations

import itertools

import numpy as np

from birdmb._typing import ComplexArray, FloatArray
from birdmb.orbits.multipliers import (
    Spectrum,
    eigenvalues_with_errors,
    ordered_spectrum,
    product,
    product_error,
)

_EPS = float(np.finfo(float).eps)
# Moduli nearer than this stay in one block: a sweep shrinks what couples two blocks by this ratio,
# and the product of a block loses no more digits than its moduli differ by.
_BLOCK_RATIO = 0.5
_SWEEPS = 60


def periodic_multipliers(factors: FloatArray, errors: FloatArray, scale: FloatArray) -> Spectrum:
    """Multipliers and modes from the segment Jacobians without multiplying them.

    Method: QR sweeps over the factors, forwards, and backwards with the transposes, give at every
    point the nested subspaces of the fastest growing right and left directions (orthogonal
    iteration on the factors, the unshifted periodic QR algorithm: Bojanczyk, Golub & Van Dooren
    1992; Lust 2001). Their intersections are the invariant subspaces along the orbit, one for each
    group of multipliers of similar modulus (Wolfe & Samelson 2007). Each group is a small product
    of its own.

    Precision: each multiplier relative to itself, however small beside the others, as long as no
    factor alone spans more than round-off (1e-16) can resolve; with one segment no better than
    `product_multipliers`, so take as many segments as -log10 of the smallest multiplier over 5.
    An accuracy of the Jacobians themselves of 1e-10, say, still bounds what is left of a
    multiplier that a single factor reduces by 1e-10; the error bounds say so. Costs 120 QR
    factorisations a segment, little beside the flows.
    """
    m, n, _ = factors.shape
    units = np.divide.outer(scale, scale)
    scaled, bounds = factors / units, errors / units
    forward, growth = _sweep(scaled)
    # Reversed, the transposes start at the end of the orbit: put their points in order again.
    backward = np.roll(_sweep(np.swapaxes(scaled[::-1], 1, 2))[0][::-1], 1, axis=0)
    borders = _block_borders(growth)
    round_off = n * _EPS * np.linalg.norm(scaled, axis=(1, 2))[:, None, None]

    values, value_errors = np.empty(n, complex), np.empty(n)
    left, along = np.empty((n, n), complex), np.empty((m, n, n), complex)
    for first, last in itertools.pairwise(borders):
        inside = slice(first, last)
        basis = _intersections(forward, backward, first, last)
        dual = _intersections(backward, forward, first, last)
        dual = dual @ np.linalg.inv(np.swapaxes(basis, 1, 2) @ dual)
        following = np.roll(basis, -1, axis=0)
        image = scaled @ basis
        block = np.swapaxes(np.roll(dual, -1, axis=0), 1, 2) @ image
        # What the subspaces miss of invariance is an error of the factors like any other.
        missed = np.abs(image - following @ block) @ np.swapaxes(np.abs(basis), 1, 2)
        total = bounds + missed + round_off
        local = np.swapaxes(np.abs(np.roll(dual, -1, axis=0)), 1, 2) @ total @ np.abs(basis)
        values[inside], value_errors[inside], coefficients, left_coefficients = (
            eigenvalues_with_errors(product(block), product_error(block, local))
        )
        left[:, inside] = dual[0] @ left_coefficients
        along[:, :, inside] = _carry(basis, block, coefficients, values[inside])
    return ordered_spectrum(values, value_errors, left, along, scale)


def _sweep(factors: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Orthonormal bases (M, n, n) of the dominant directions, and log growth rates (n,)."""
    m, n, _ = factors.shape
    # A start in general position: none of its directions may lie in an invariant subspace.
    basis = np.linalg.qr(np.random.default_rng(0).standard_normal((n, n)))[0]
    bases, growth = np.empty((m, n, n)), np.zeros(n)
    for _ in range(_SWEEPS):
        for k in range(m):
            bases[k] = basis
            basis, triangle = np.linalg.qr(factors[k] @ basis)
            growth += np.log(np.maximum(np.abs(np.diag(triangle)), np.finfo(float).tiny))
    return bases, growth / _SWEEPS


def _block_borders(growth: FloatArray) -> list[int]:
    gaps = np.diff(growth) < np.log(_BLOCK_RATIO)
    return [0, *(np.flatnonzero(gaps) + 1).tolist(), len(growth)]


def _intersections(one: FloatArray, other: FloatArray, first: int, last: int) -> FloatArray:
    """Orthonormal bases of span(one[:, :last]) orthogonal to other[:, :first], at every point."""
    span = one[:, :, :last]
    if first == 0:
        return span
    overlap = np.swapaxes(other[:, :, :first], 1, 2) @ span
    return np.asarray(span @ np.swapaxes(np.linalg.svd(overlap)[2][:, first:, :], 1, 2))


def _carry(
    basis: FloatArray, block: FloatArray, coefficients: ComplexArray, values: ComplexArray
) -> ComplexArray:
    states = []
    for vectors, factor in zip(basis, block, strict=True):
        states.append(vectors @ coefficients)
        with np.errstate(divide="ignore", invalid="ignore"):
            coefficients = factor @ coefficients / values ** (1 / len(block))
    return np.array(states)
