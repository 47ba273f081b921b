"""What the multipliers of two neighbouring orbits tell of the bifurcations between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from birdmb._typing import ComplexArray, FloatArray
from birdmb.orbits.branch_points import BifurcationKind, BranchPoint


@dataclass(frozen=True)
class Neutral:
    """Numbers of multipliers at a place within their error bounds, the trivial one not counted.

    Those that stay there along a branch, as conserved quantities and conservative pairs do, change
    sides by their errors alone and must not be taken for bifurcations.

    Attributes:
        circle: on the unit circle.
        one: at 1.
        minus_one: at -1.
    """

    circle: int
    one: int
    minus_one: int

    @classmethod
    def of(cls, point: BranchPoint) -> Neutral:
        """The numbers at one point."""
        values, errors = nontrivial(point)
        return cls(
            int((np.abs(np.abs(values) - 1) <= errors).sum()),
            int((np.abs(values - 1) <= errors).sum()),
            int((np.abs(values + 1) <= errors).sum()),
        )

    def still(self, point: BranchPoint) -> Neutral:
        """The numbers of those that are there at a further point, too."""
        other = Neutral.of(point)
        return Neutral(
            min(self.circle, other.circle),
            min(self.one, other.one),
            min(self.minus_one, other.minus_one),
        )


def nontrivial(point: BranchPoint) -> tuple[ComplexArray, FloatArray]:
    """Multipliers without the trivial one, and their error bounds."""
    keep = np.arange(len(point.multipliers)) != point.trivial_index
    return np.asarray(point.multipliers[keep]), np.asarray(point.multiplier_errors[keep])


def fold(point: BranchPoint, _neutral: Neutral) -> float:
    """Component of the tangent along the parameter: zero where the branch turns."""
    return float(point.tangent[-1])


def branch_point(point: BranchPoint, neutral: Neutral) -> float:
    """Product of Lambda - 1, each over |Lambda| + 1, without those that stay at 1."""
    return _product_about(1.0, point, neutral.one)


def period_doubling(point: BranchPoint, neutral: Neutral) -> float:
    """Product of Lambda + 1, each over |Lambda| + 1, without those that stay at -1."""
    return _product_about(-1.0, point, neutral.minus_one)


TESTS = {"fold": fold, "branch point": branch_point, "period doubling": period_doubling}


def sign_changes(
    before: BranchPoint, after: BranchPoint, neutral: Neutral
) -> list[BifurcationKind]:
    """Kinds whose test function changes its sign between two neighbouring points of a branch.

    An even number of one kind does not show; `counts_outside` shows it, unless they cancel.
    """

    def changes(kind: BifurcationKind) -> bool:
        return TESTS[kind](before, neutral) * TESTS[kind](after, neutral) < 0

    kinds: list[BifurcationKind] = []
    if changes("fold"):
        kinds.append("fold")
    elif changes("branch point"):
        kinds.append("branch point")
    if changes("period doubling"):
        kinds.append("period doubling")
    return kinds


def counts_outside(point: BranchPoint, neutral: Neutral) -> frozenset[int]:
    """How many multipliers may lie outside the unit circle, as far as their error bounds tell.

    The trivial one and those that stay on the circle are not counted.
    """
    values, errors = nontrivial(point)
    excess = np.abs(values) - 1
    return numbers_outside(excess, errors, neutral)


def numbers_outside(excess: FloatArray, errors: FloatArray, neutral: Neutral) -> frozenset[int]:
    """The same of moduli less 1, with their error bounds."""
    surely = int((excess > errors).sum())
    undecided = int((np.abs(excess) <= errors).sum())
    return frozenset(range(surely, surely + max(undecided - neutral.circle, 0) + 1))


def sorted_excess(point: BranchPoint, neutral: Neutral) -> tuple[FloatArray, FloatArray]:
    """Moduli less 1, the largest first, with error bounds; without those that stay on the circle.

    Each place in this order is a continuous function along a branch.
    """
    values, errors = nontrivial(point)
    excess = np.abs(values) - 1
    moving = np.sort(np.argsort(np.abs(excess), kind="stable")[neutral.circle :])
    order = moving[np.argsort(-excess[moving], kind="stable")]
    return excess[order], errors[order]


def _product_about(centre: float, point: BranchPoint, staying: int) -> float:
    values, _ = nontrivial(point)
    values = values[np.argsort(np.abs(values - centre), kind="stable")[staying:]]
    return float(np.prod((values - centre) / (np.abs(values) + 1)).real)
