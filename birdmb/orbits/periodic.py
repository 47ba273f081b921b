"""Eigenvalues of a product of matrices without forming it, so that small ones survive."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack

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
_MOST_SWEEPS = 60
# Of the bases after a sweep, in units of their size and machine precision.
_ROUND_OFF = 4.0
# Subspaces that a sweep moves by less, and no less than the one before, are known to round-off.
_SETTLED = 1e-8
# Logarithm of a ratio of two moduli that one sweep tells apart.
_LOG_WIDEST = float(np.log(1e-9))
# A product that stretches no direction more than this against another keeps 12 digits of each.
_GROUP_CONDITION = 1e4


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
    multiplier that a single factor reduces by 1e-10; the error bounds say so. Neighbouring factors
    are multiplied as long as their product stays well conditioned. Costs up to 120 QR
    factorisations a group of factors.
    """
    units = np.divide.outer(scale, scale)
    every, every_bound = factors / units, errors / units
    groups = _groups(every)
    scaled = np.array([product(every[group]) for group in groups])
    bounds = np.array([product_error(every[group], every_bound[group]) for group in groups])
    n = len(scale)
    if len(groups) == 1:
        forward = backward = np.eye(n)[None]
        borders = [0, n]
    else:
        flag = _flag(scaled)
        forward, borders = flag.bases, flag.borders
        # Reversed, the transposes start at the end of the orbit: put their points in order again.
        backward = np.roll(_flag(np.swapaxes(scaled[::-1], 1, 2)).bases[::-1], 1, axis=0)
    round_off = n * _EPS * np.linalg.norm(scaled, axis=(1, 2))[:, None, None]

    values, value_errors = np.empty(n, complex), np.empty(n)
    left, along = np.empty((n, n), complex), np.empty((len(every), n, n), complex)
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
        along[:, :, inside] = _carry(basis, block, coefficients, values[inside], every, groups)
    return ordered_spectrum(values, value_errors, left, along, scale)


def periodic_eigenvalues(every: FloatArray) -> ComplexArray:
    """Multipliers (n,) alone, from scaled factors (M, n, n), by half of `periodic_multipliers`.

    In the order of the subspaces, which is not quite that of the moduli.
    """
    groups = _groups(every)
    if len(groups) == 1:
        return np.asarray(np.linalg.eigvals(product(every)), complex)
    flag = _flag(np.array([product(every[group]) for group in groups]))
    found = []
    for first, last in itertools.pairwise(flag.borders):
        block = flag.turn[first:last, first:last]
        for triangle in flag.triangles[::-1]:
            block = block @ triangle[first:last, first:last]
        found.append(np.linalg.eigvals(block))
    return np.asarray(np.concatenate(found), complex)


@dataclass(frozen=True)
class _Flag:
    """Nested subspaces of the fastest growing directions along an orbit.

    Attributes:
        bases: orthonormal bases (M, n, n) at the starts of the factors, the fastest first.
        triangles: what the factors are (M, n, n) from one basis to the next.
        turn: the basis that the last one leads to, in coordinates (n, n) of the first.
        borders: of blocks of directions that grow alike.
    """

    bases: FloatArray
    triangles: FloatArray
    turn: FloatArray
    borders: list[int]


def _flag(factors: FloatArray) -> _Flag:
    n = len(factors[0])
    # A start in general position: none of its directions may lie in an invariant subspace.
    start = np.linalg.qr(np.random.default_rng(0).standard_normal((n, n)))[0]
    _, triangles, end = _sweep(factors, start)
    before = np.inf
    for _ in range(_MOST_SWEEPS):
        turn, growth = _turned(triangles, start.T @ end)
        start, borders = end @ turn, _block_borders(growth)
        bases, triangles, end = _sweep(factors, start)
        left = start.T @ end
        moved = max((float(np.abs(left[at:, :at]).max()) for at in borders[1:-1]), default=0.0)
        if moved <= _ROUND_OFF * n * _EPS or (moved <= _SETTLED and moved > _BLOCK_RATIO * before):
            break
        before = moved
    return _Flag(bases, triangles, left, borders)


def _sweep(factors: FloatArray, basis: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Bases (M, n, n) from `basis` (n, n) on, triangles (M, n, n) between them, and the last."""
    bases, triangles = np.empty_like(factors), np.empty_like(factors)
    for k, factor in enumerate(factors):
        bases[k] = basis
        # numpy's own door to the same two routines costs more than they do.
        triangles[k], tau, _, _ = lapack.dgeqrf(factor @ basis)
        basis = lapack.dorgqr(triangles[k], tau)[0]
    return bases, np.triu(triangles), basis


def _turned(triangles: FloatArray, turn: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Where more sweeps would turn the basis at the end of one to, within its own coordinates.

    And the logarithms (n,) of what a sweep stretches its directions by, in the mean.

    They would see the product of its `triangles` (M, n, n) after `turn` (n, n), from the basis at
    the end to that at the start. Its rows are kept in units of what they are stretched by, so that
    small ones keep their digits; of a gap between two of these only so much counts as a sweep
    needs to leave nothing of one in the other.
    """
    sizes, rows = np.zeros(len(turn)), turn
    for triangle in triangles:
        largest = np.maximum.accumulate(sizes[::-1])[::-1]
        rows = (triangle * np.exp(np.minimum(sizes - largest[:, None], 0.0))) @ rows
        norms = np.maximum(np.abs(rows).max(axis=1), np.finfo(float).tiny)
        rows, sizes = rows / norms[:, None], largest + np.log(norms)
    gaps = np.clip(np.diff(sizes), _LOG_WIDEST, -_LOG_WIDEST)
    whole = np.exp(np.append(0.0, np.cumsum(gaps)))[:, None] * rows
    basis, growth = np.eye(len(turn)), np.zeros(len(turn))
    for _ in range(_MOST_SWEEPS):
        packed, tau, _, _ = lapack.dgeqrf(whole @ basis)
        growth += np.log(np.maximum(np.abs(np.diag(packed)), np.finfo(float).tiny))
        basis = lapack.dorgqr(packed, tau)[0]
    return basis, growth / _MOST_SWEEPS


def _block_borders(growth: FloatArray) -> list[int]:
    gaps = np.diff(growth) < np.log(_BLOCK_RATIO)
    return [0, *(np.flatnonzero(gaps) + 1).tolist(), len(growth)]


def _intersections(one: FloatArray, other: FloatArray, first: int, last: int) -> FloatArray:
    """Orthonormal bases of span(one[:, :last]) orthogonal to other[:, :first], at every point."""
    span = one[:, :, :last]
    if first == 0:
        return span
    overlap = np.swapaxes(other[:, :, :first], 1, 2) @ span
    # The directions that a complete factorisation adds are those that the overlap takes to zero.
    directions = np.linalg.qr(np.swapaxes(overlap, 1, 2), mode="complete")[0]
    return np.asarray(span @ directions[:, :, first:])


def _carry(
    basis: FloatArray,
    block: FloatArray,
    coefficients: ComplexArray,
    values: ComplexArray,
    every: FloatArray,
    groups: list[slice],
) -> ComplexArray:
    """Periodic parts (N, n, k) of modes at the starts of all N factors.

    At the start of each group within the invariant subspace, inside it by the factors.
    """
    states = []
    with np.errstate(divide="ignore", invalid="ignore"):
        decay = values ** (1 / len(every))
        for vectors, factor, group in zip(basis, block, groups, strict=True):
            states.append(vectors @ coefficients)
            for single in every[group][:-1]:
                states.append(single @ states[-1] / decay)
            coefficients = factor @ coefficients / decay ** (group.stop - group.start)
    return np.array(states)


def _groups(factors: FloatArray) -> list[slice]:
    """Runs of neighbouring factors whose product stretches directions not too differently."""
    try:
        inverses = np.linalg.inv(factors)
    except np.linalg.LinAlgError:
        inverses = np.full_like(factors, np.inf)
    if _all_in_one(factors, np.asarray(inverses, float)):
        return [slice(0, len(factors))]
    groups, first = [], 0
    running = backward = np.eye(factors.shape[1])
    with np.errstate(over="ignore", invalid="ignore"):
        for k, (factor, inverse) in enumerate(zip(factors, inverses, strict=True)):
            longer, back = factor @ running, backward @ inverse
            if k > first and not np.linalg.norm(longer) * np.linalg.norm(back) <= _GROUP_CONDITION:
                groups.append(slice(first, k))
                first, longer, back = k, factor, inverse
            running, backward = longer, back
    return [*groups, slice(first, len(factors))]


def _all_in_one(factors: FloatArray, inverses: FloatArray) -> bool:
    """Whether products of all factors, of runs that double in length, are well conditioned."""
    with np.errstate(over="ignore", invalid="ignore"):
        while len(factors) > 1:
            even = len(factors) // 2 * 2
            rest = factors[even:], inverses[even:]
            factors = np.concatenate([factors[1:even:2] @ factors[:even:2], rest[0]])
            inverses = np.concatenate([inverses[:even:2] @ inverses[1:even:2], rest[1]])
            sizes = [np.sqrt((each * each).sum(axis=(1, 2))) for each in (factors, inverses)]
            if not (sizes[0] * sizes[1] <= _GROUP_CONDITION).all():
                return False
    return True
