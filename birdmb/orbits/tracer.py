"""Stepping along a branch and locating what happens between two of its points."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import OrbitError, StateError
from birdmb.orbits.bifurcations import Neutral, counts_outside
from birdmb.orbits.branch_points import Bifurcation, BranchPoint
from birdmb.orbits.cycle import LimitCycle
from birdmb.orbits.errors import (
    BIFURCATIONS_FOUND,
    BranchStopped,
    ConvergenceError,
    NotSmoothError,
    StopReason,
)
from birdmb.orbits.extended import ExtendedEquations, Solution
from birdmb.orbits.locating import Chord, locate, outside_after

Observables = Mapping[str, Callable[[LimitCycle], float]]

_CORRECTOR_ITERATIONS = 12
# A sharper turn between two points, or a longer way from the predicted one to the point, is retried
# with a shorter step, so that no fold and no branch is jumped over.
_LEAST_COSINE = 0.9
_LARGEST_CORRECTION = 0.5


class _NotNeighboursError(OrbitError):
    """Two points may not lie next to each other on one branch."""


_Failure = (ConvergenceError, _NotNeighboursError, StateError, np.linalg.LinAlgError)


@checked
@dataclass(frozen=True)
class Steps:
    """Step sizes along a branch, in its arclength: state scales and parameter ranges.

    Attributes:
        first: length of the first step.
        shortest: below it the branch stops.
        longest: never exceeded.
    """

    first: float = 0.02
    shortest: float = 1e-6
    longest: float = 0.1


class Tracer:
    """Follows a branch; afterwards `stopped` tells why it ended before an end of its range."""

    def __init__(
        self,
        equations: ExtendedEquations,
        steps: Steps,
        tolerance: float,
        observables: Observables,
        instead: ExtendedEquations | None = None,
    ) -> None:
        """Take the equations on any plane, how to go, and what to take of orbits too rough."""
        self.stopped: BranchStopped | None = None
        self._equations, self._instead = equations, instead
        self._steps = steps
        self._tolerance = tolerance
        self._observables = observables

    def first_point(
        self, parameter: float, points: FloatArray, period: float, towards: float
    ) -> BranchPoint:
        """The branch's point of an orbit with states `points`; the sign `towards` is the way on."""
        u = self._equations.unknowns(parameter, points, period)
        ahead = np.append(np.zeros(len(u) - 1), np.sign(towards))
        solution = self._equations.on_plane(u, ahead).solution_at(u)
        return self.observed(*self._point(solution, ahead))

    def follow(
        self,
        points: Sequence[BranchPoint],
        bifurcations: Sequence[Bifurcation],
        max_points: int,
        max_bifurcations: int | None = None,
    ) -> Iterator[BranchPoint | Bifurcation]:
        """Yield what follows the points known so far, up to `max_points` in all.

        The bifurcations on the way to a point come before it; `max_bifurcations` counts new ones.
        """
        found, count = 0, len(points)
        point, step = points[-1], points[-1].next_step
        neutral, outside = _known(points, bifurcations)
        while not self._at_end(point):
            if count >= max_points:
                self._stop("the number of points allowed was reached", point)
                return
            # Always from the point as it is kept: a branch that is resumed then takes the same way.
            equations, u, tangent = self._equations.from_point(point)
            try:
                solution = self._ahead(equations, u, tangent, step)
                new, cycle = self._point(solution, tangent)
                equations = solution.equations
                u, tangent = equations.carried(u), equations.carried(tangent)
                self._check_neighbours(equations, u, tangent, solution.u, new.tangent)
            except _Failure as error:
                rough = isinstance(error, NotSmoothError) and step < self._steps.first
                if rough and self._instead is not None:
                    self._equations, self._instead = self._instead, None
                    continue
                step /= 2
                if rough or step < self._steps.shortest:
                    self._stop(self._reason(error, equations, u, tangent), point, str(error))
                    return
                continue
            if point.trivial_index is not None and _turned_over(equations, u, solution.u):
                self._stop("the cycles shrank to an equilibrium", point)
                return
            earlier, neutral = neutral, neutral.still(new)
            chord = _Cycles(self, equations, u, solution.u)
            located = locate(chord.between(point, new), count - 1, outside, neutral, earlier)
            outside = outside_after(outside, located, new, neutral)
            for bifurcation in located:
                yield replace(bifurcation, point=chord.observed(bifurcation.point))
            found += len(located)
            step = min(step * _stretch(solution), self._steps.longest)
            new = replace(self.observed(new, cycle), next_step=step)
            yield new
            if max_bifurcations is not None and found >= max_bifurcations:
                self._stop(BIFURCATIONS_FOUND, new)
                return
            point, count = new, count + 1

    def orbit_on(self, plane: ExtendedEquations, u: FloatArray) -> tuple[BranchPoint, LimitCycle]:
        """The orbit on a plane from a guess, as a point without observables, and as a cycle."""
        return self._point(self._corrected(plane, u), plane.direction)

    def _ahead(
        self, equations: ExtendedEquations, u: FloatArray, tangent: FloatArray, step: float
    ) -> Solution:
        """The solution at most a step ahead."""
        predicted = u + step * tangent
        low, high = (end / equations.unit for end in equations.parameter_range)
        if low < predicted[-1] < high:
            return self._corrected(equations.on_plane(u, tangent, step), predicted)
        # Land on the end of the range: there the plane is that of the parameter.
        end = low if predicted[-1] <= low else high
        predicted = u + tangent * (end - u[-1]) / tangent[-1]
        predicted[-1] = end
        across = np.append(np.zeros(len(u) - 1), 1.0)
        return self._corrected(equations.on_plane(predicted, across), predicted)

    def _corrected(self, plane: ExtendedEquations, u: FloatArray) -> Solution:
        return plane.corrected(u, self._tolerance, _CORRECTOR_ITERATIONS)

    def _point(self, solution: Solution, direction: FloatArray) -> tuple[BranchPoint, LimitCycle]:
        """The orbit of a solution; its tangent points along `direction`."""
        equations, u = solution.equations, solution.u
        plane = equations.on_plane(u, equations.carried(direction))
        cycle, tangent = plane.cycle_and_tangent(solution)
        point = BranchPoint(
            parameter=equations.parameter(u),
            period=cycle.period,
            points=equations.states(u),
            residual=cycle.residual,
            multipliers=cycle.multipliers,
            multiplier_errors=cycle.multiplier_errors,
            trivial_index=cycle.trivial_index,
            stability=cycle.stability,
            tangent=tangent,
            next_step=self._steps.first,
            method=cycle.method,
            state_error=cycle.state_error,
        )
        return point, cycle

    def observed(self, point: BranchPoint, cycle: LimitCycle) -> BranchPoint:
        """The point with its observables."""
        values = {name: float(value(cycle)) for name, value in self._observables.items()}
        return replace(point, observables=values)

    def _at_end(self, point: BranchPoint) -> bool:
        low, high = self._equations.parameter_range
        margin = 1e-12 * self._equations.unit
        outward = point.tangent[-1]
        return bool(
            (point.parameter <= low + margin and outward < 0)
            or (point.parameter >= high - margin and outward > 0)
        )

    def _stop(self, reason: StopReason, point: BranchPoint, detail: str = "") -> None:
        self.stopped = BranchStopped(reason, point.parameter, detail)

    def _check_neighbours(
        self,
        equations: ExtendedEquations,
        u: FloatArray,
        tangent: FloatArray,
        new_u: FloatArray,
        new_tangent: FloatArray,
    ) -> None:
        inner, chord = equations.inner, new_u - u
        along = inner(chord, tangent)
        across = chord - along * tangent
        if (
            inner(new_tangent, tangent) < _LEAST_COSINE
            or inner(across, across) > (_LARGEST_CORRECTION * along) ** 2
        ):
            raise _NotNeighboursError(
                f"from parameter {equations.parameter(u):.8g} to {equations.parameter(new_u):.8g} "
                f"the branch jumps or turns by more than the shortest step can follow."
            )

    def _reason(
        self, error: Exception, equations: ExtendedEquations, u: FloatArray, tangent: FloatArray
    ) -> StopReason:
        """Tell a model that ends here from a corrector that fails."""
        if isinstance(error, NotSmoothError):
            return "the orbits became too rough for collocation"
        if isinstance(error, StateError) or isinstance(error.__cause__, StateError):
            return "the branch left the domain of the model"
        try:
            equations.residual(u + 4 * self._steps.shortest * tangent)
        except StateError:
            return "the branch left the domain of the model"
        return "the step became too small"


class _Cycles:
    """The orbits on the chord between two solutions of the same equations."""

    def __init__(
        self, tracer: Tracer, equations: ExtendedEquations, u: FloatArray, next_u: FloatArray
    ) -> None:
        chord = next_u - u
        self._length = float(np.sqrt(equations.inner(chord, chord)))
        self._tracer, self._equations = tracer, equations
        self._u, self._direction = u, chord / self._length
        self._cycles: list[tuple[BranchPoint, LimitCycle]] = []

    def between(self, before: BranchPoint, after: BranchPoint) -> Chord:
        """The chord."""
        return Chord(before, after, self._length, self._equations.unit, self._orbit_at)

    def _orbit_at(self, distance: float) -> BranchPoint:
        plane = self._equations.on_plane(self._u, self._direction, distance)
        self._cycles.append(self._tracer.orbit_on(plane, self._u + distance * self._direction))
        return self._cycles[-1][0]

    def observed(self, point: BranchPoint) -> BranchPoint:
        """One of the points found, with its observables."""
        for seen, cycle in self._cycles:
            if seen is point:
                return self._tracer.observed(point, cycle)
        return point


def _stretch(solution: Solution) -> float:
    """By what to lengthen the step after one that led to a solution."""
    factor = 2.0 ** (-solution.equations.excess(solution.iterations) / 2)
    return min(max(factor, 0.5), 2.0)


def _turned_over(equations: ExtendedEquations, u: FloatArray, next_u: FloatArray) -> bool:
    """Whether cycles passed through an equilibrium: the same ones come back in opposite phase."""
    return bool(np.sum(equations.velocities(u) * equations.velocities(next_u)) < 0)


def _known(
    points: Sequence[BranchPoint], bifurcations: Sequence[Bifurcation]
) -> tuple[Neutral, frozenset[int]]:
    """What stays on the circle along some points, and the numbers outside it at the last.

    Found from the points alone, so that a branch that is resumed knows the same.
    """
    neutral = Neutral.of(points[0])
    outside = counts_outside(points[0], neutral)
    for i, point in enumerate(points[1:]):
        neutral = neutral.still(point)
        between = [bifurcation for bifurcation in bifurcations if bifurcation.after == i]
        outside = outside_after(outside, between, point, neutral)
    return neutral, outside
