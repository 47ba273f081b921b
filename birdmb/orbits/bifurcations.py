"""Functions of an orbit that change sign at its bifurcations."""

from __future__ import annotations

import itertools

import numpy as np

from birdmb._typing import ComplexArray
from birdmb.orbits.branch import BifurcationKind, BranchPoint

# Of two multipliers whose product is 1 on a circle, an imaginary part less than this is real.
_REAL = 1e-6


def nontrivial(point: BranchPoint) -> ComplexArray:
    """Multipliers without the trivial one."""
    keep = np.arange(len(point.multipliers)) != point.trivial_index
    return np.asarray(point.multipliers[keep])


def fold(point: BranchPoint) -> float:
    """Component of the tangent along the parameter: zero where the branch turns."""
    return float(point.tangent[-1])


def branch_point(point: BranchPoint) -> float:
    """Product of Lambda - 1, each over |Lambda| + 1."""
    values = nontrivial(point)
    return float(np.prod((values - 1) / (np.abs(values) + 1)).real)


def period_doubling(point: BranchPoint) -> float:
    """Product of Lambda + 1, each over |Lambda| + 1."""
    values = nontrivial(point)
    return float(np.prod((values + 1) / (np.abs(values) + 1)).real)


def neimark_sacker(point: BranchPoint) -> float:
    """Product over pairs of Lambda_i Lambda_j - 1, each over |Lambda_i Lambda_j| + 1.

    It vanishes too where two real multipliers have the product 1 (a neutral saddle), which is no
    bifurcation.
    """
    pairs = _pair_products(nontrivial(point))
    return float(np.prod((pairs - 1) / (np.abs(pairs) + 1)).real)


TESTS = {
    "fold": fold,
    "period doubling": period_doubling,
    "Neimark-Sacker": neimark_sacker,
    "branch point": branch_point,
}


def crossings(before: BranchPoint, after: BranchPoint) -> list[BifurcationKind]:
    """Kinds of bifurcations between two neighbouring points of a branch, one of each at most.

    Two of the same kind between two points cancel and are missed: take shorter steps.
    """
    kinds: list[BifurcationKind] = []
    if fold(before) * fold(after) < 0:
        kinds.append("fold")
    elif branch_point(before) * branch_point(after) < 0:
        kinds.append("branch point")
    if period_doubling(before) * period_doubling(after) < 0:
        kinds.append("period doubling")
    if neimark_sacker(before) * neimark_sacker(after) < 0 and not (
        _conservative(before) or _conservative(after)
    ):
        kinds.append("Neimark-Sacker")
    return kinds


def is_neutral_saddle(point: BranchPoint) -> bool:
    """Whether the pair with a product nearest 1 is real."""
    values = nontrivial(point)
    first, second = np.triu_indices(len(values), 1)
    nearest = np.abs(_pair_products(values) - 1).argmin()
    pair = values[[first[nearest], second[nearest]]]
    return bool((np.abs(pair.imag) < _REAL).all())


def critical_modulus(point: BranchPoint, kind: BifurcationKind) -> tuple[float, float]:
    """Distance from the unit circle of the multiplier that crosses, and its error bound."""
    index = np.flatnonzero(np.arange(len(point.multipliers)) != point.trivial_index)
    values, errors = point.multipliers[index], point.multiplier_errors[index]
    if kind == "Neimark-Sacker":
        candidates = np.abs(np.abs(values) - 1) + 10.0 * (np.abs(values.imag) < _REAL)
    else:
        candidates = np.abs(values - (-1 if kind == "period doubling" else 1))
    nearest = int(candidates.argmin())
    return float(np.abs(values[nearest]) - 1), float(errors[nearest])


def _pair_products(values: ComplexArray) -> ComplexArray:
    return np.array([a * b for a, b in itertools.combinations(values, 2)], complex)


def _conservative(point: BranchPoint) -> bool:
    """Whether some pair has the product 1 within its error bounds, as in Hamiltonian systems."""
    index = np.flatnonzero(np.arange(len(point.multipliers)) != point.trivial_index)
    for i, j in itertools.combinations(index, 2):
        a, b = point.multipliers[i], point.multipliers[j]
        error = abs(a) * point.multiplier_errors[j] + abs(b) * point.multiplier_errors[i]
        if abs(a * b - 1) <= error:
            return True
    return False
