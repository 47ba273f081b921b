"""The orbits of a branch and the bifurcations between them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from birdmb._typing import BoolArray, ComplexArray, FloatArray
from birdmb.orbits.cycle import OrbitMethod
from birdmb.orbits.multipliers import Stability
from birdmb.summary import Fact, Summarised, with_error

BifurcationKind = Literal["fold", "period doubling", "Neimark-Sacker", "branch point", "multiple"]


@dataclass(frozen=True, repr=False)
class BranchPoint(Summarised):
    """One orbit of a branch.

    All of it is had again by `floquet(family(parameter), points, period, segments=len(points))`
    of a shot one, and by `find_limit_cycle(family(parameter), points, period_guess=period,
    nodes=len(points))` of a collocated one, without `period_guess` if the system is forced.

    Attributes:
        parameter: value of the parameter.
        period: period in s.
        points: states (M, n) at the starts of the shooting segments, or at the collocation nodes.
        residual: closure error, or `state_error`, in the units of the states.
        multipliers: (n,), largest modulus first.
        multiplier_errors: bound (n,) of the error of each.
        trivial_index: position of the trivial multiplier, `None` for a forced system.
        stability: verdict of the multipliers.
        tangent: unit tangent of the branch in scaled unknowns, in the direction of travel.
        next_step: length of the step that was to follow, from which a continuation resumes.
        observables: what the caller asked to be recorded of the orbit, by name.
        method: "collocation" or "shooting".
        state_error: largest error of the unknowns of a collocated orbit, the correction on half as
            many nodes again: of the states in units of their scale, of the period in periods, of
            the parameter in parameter ranges; 0 of a shot one.
    """

    parameter: float
    period: float
    points: FloatArray
    residual: float
    multipliers: ComplexArray
    multiplier_errors: FloatArray
    trivial_index: int | None
    stability: Stability
    tangent: FloatArray
    next_step: float
    observables: dict[str, float] = field(default_factory=dict)
    method: OrbitMethod = "shooting"
    state_error: float = 0.0

    def _summary(self) -> Iterator[Fact]:
        yield Fact("parameter", f"{self.parameter:.6g}")
        yield Fact("verdict", self.stability)
        yield Fact("period", f"{self.period:.6g}", "s")
        yield Fact("method", self.method)
        for name, value in self.observables.items():
            yield Fact(name, f"{value:.6g}")

    @property
    def nodes(self) -> int | None:
        """Number of collocation nodes; `None` of a shot orbit."""
        return len(self.points) if self.method == "collocation" else None


@dataclass(frozen=True, repr=False)
class Bifurcation(Summarised):
    """A located crossing of the unit circle by one or more multipliers.

    Attributes:
        kind: "fold" (the branch turns, multiplier 1), "period doubling" (multiplier -1),
            "Neimark-Sacker" (complex pair on the unit circle), "branch point" (multiplier 1, the
            branch does not turn) or "multiple": more multipliers cross at once than these kinds
            have, as in several copies of one system, in symmetric systems, and where a pair crosses
            at 1 or -1 (the strong resonances 1:1 and 1:2). `multipliers` says which.
        point: the orbit there.
        parameter_error: bound of the error of the parameter that comes from the location, from the
            error bounds of the multipliers and from the nodes of collocation.
        after: index of the branch point before it.
        crossing: mask (n,) of the multipliers that cross.
        outside: numbers of multipliers outside the unit circle before and after, in the direction
            of travel; those that stay on the circle all along the branch are not counted.
    """

    kind: BifurcationKind
    point: BranchPoint
    parameter_error: float
    after: int
    crossing: BoolArray
    outside: tuple[int, int]

    def _summary(self) -> Iterator[Fact]:
        yield Fact("kind", self.kind)
        yield Fact("parameter", with_error(self.parameter, self.parameter_error))
        yield Fact("multipliers that cross", str(int(self.crossing.sum())))

    @property
    def parameter(self) -> float:
        """Value of the parameter."""
        return self.point.parameter

    @property
    def multipliers(self) -> ComplexArray:
        """Multipliers (k,) that cross the unit circle."""
        return np.asarray(self.point.multipliers[self.crossing])

    @property
    def changes_stability(self) -> bool:
        """Whether orbits are stable, or not known to be unstable, on one of its two sides alone."""
        return (self.outside[0] == 0) != (self.outside[1] == 0)
