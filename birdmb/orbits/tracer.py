"""Stepping along a branch and locating what happens between two of its points."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import OrbitError, StateError
from birdmb.orbits.bifurcations import Neutral, counts_outside
from birdmb.orbits.branch_points import Bifurcation, BranchPoint
from birdmb.orbits.cycle import LimitCycle
from birdmb.orbits.errors import (
    BIFURCATIONS_FOUND,
    BranchStopped,
    ConvergenceError,
    StopReason,
)
from birdmb.orbits.extended import ExtendedEquations
from birdmb.orbits.linearisation import linearise
from birdmb.orbits.locating import Chord, locate, outside_after
from birdmb.orbits.newton import Iteration, solve
from birdmb.orbits.periodic import periodic_multipliers
from birdmb.orbits.problem import HasLimitCycleType

Observables = Mapping[str, Callable[[LimitCycle], float]]

_CORRECTOR_ITERATIONS = 12
_IDEAL_JACOBIANS = 3
# A sharper turn between two points, or a longer way from the predicted one to the point, is retried
# with a shorter step, so that no fold and no branch is jumped over.
_LEAST_COSINE = 0.9
_LARGEST_CORRECTION = 0.5


class _NotNeighboursError(OrbitError):
    """Two points may not lie next to each other on one branch."""


_Failure = (ConvergenceError, _NotNeighboursError, StateError, np.linalg.LinAlgError)


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
    ) -> None:
        """Take the equations on any plane, and how to go."""
        self.stopped: BranchStopped | None = None
        self._equations = equations
        self._steps = steps
        self._tolerance = tolerance
        self._observables = observables

    def unknowns(self, parameter: float, points: FloatArray, period: float) -> FloatArray:
        """Scaled unknowns of an orbit."""
        shooting = self._equations.shooting(parameter)
        return np.append(shooting.pack(points, period), parameter / self._equations.unit)

    def point_at(
        self, u: FloatArray, direction: FloatArray, iterations: tuple[Iteration, ...] = ()
    ) -> BranchPoint:
        """Linearise the orbit of the solution `u`; its tangent points along `direction`."""
        parameter = self._equations.parameter(u)
        shooting = self._equations.shooting(parameter)
        fields = linearise(shooting, *shooting.unpack(u[:-1]), periodic_multipliers)
        model = shooting.segments.model
        kind = model.limit_cycle_type if isinstance(model, HasLimitCycleType) else LimitCycle
        cycle: LimitCycle = kind(**fields, iterations=iterations)
        plane = self._equations.on_plane(u, direction)
        return BranchPoint(
            parameter=parameter,
            period=cycle.period,
            points=cycle.points,
            residual=cycle.residual,
            multipliers=cycle.multipliers,
            multiplier_errors=cycle.multiplier_errors,
            trivial_index=cycle.trivial_index,
            stability=cycle.stability,
            tangent=plane.tangent(u, cycle.segment_jacobians),
            next_step=self._steps.first,
            observables={name: float(value(cycle)) for name, value in self._observables.items()},
        )

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
            u = self.unknowns(point.parameter, point.points, point.period)
            try:
                new_u, iterations = self._correct(u, point.tangent, step)
                new = self.point_at(new_u, point.tangent, iterations)
                self._check_neighbours(point, u, new, new_u)
            except _Failure as error:
                step /= 2
                if step < self._steps.shortest:
                    self._stop(self._reason(error, u, point), point, str(error))
                    return
                continue
            if self._passed_equilibrium(point, new):
                self._stop("the cycles shrank to an equilibrium", point)
                return
            earlier, neutral = neutral, neutral.still(new)
            chord = self._chord(u, point, new_u, new)
            located = locate(chord, count - 1, outside, neutral, earlier)
            outside = outside_after(outside, located, new, neutral)
            yield from located
            found += len(located)
            jacobians = sum(not iteration.jacobian_reused for iteration in iterations[1:])
            factor = 2 ** ((_IDEAL_JACOBIANS - jacobians) / 2)
            step = min(step * min(max(factor, 0.5), 2.0), self._steps.longest)
            new = replace(new, next_step=step)
            yield new
            if max_bifurcations is not None and found >= max_bifurcations:
                self._stop(BIFURCATIONS_FOUND, new)
                return
            point, count = new, count + 1

    def _correct(
        self, u: FloatArray, tangent: FloatArray, step: float
    ) -> tuple[FloatArray, tuple[Iteration, ...]]:
        equations = self._equations
        predicted = u + step * tangent
        low, high = (end / equations.unit for end in equations.parameter_range)
        if low < predicted[-1] < high:
            plane = equations.on_plane(u, tangent, step)
        else:
            # Land on the end of the range: there the plane is that of the parameter.
            end = low if predicted[-1] <= low else high
            predicted = u + tangent * (end - u[-1]) / tangent[-1]
            predicted[-1] = end
            across = np.zeros(len(u))
            across[-1] = 1.0
            plane = equations.on_plane(predicted, across)
        found, _, iterations = self._solve(plane, predicted)
        return found, iterations

    def _solve(
        self, equations: ExtendedEquations, u: FloatArray
    ) -> tuple[FloatArray, FloatArray, tuple[Iteration, ...]]:
        return solve(
            equations,
            u,
            damping="line-search",
            tolerance=self._tolerance,
            max_iterations=_CORRECTOR_ITERATIONS,
        )

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
        self, point: BranchPoint, u: FloatArray, new: BranchPoint, new_u: FloatArray
    ) -> None:
        inner, chord = self._equations.inner, new_u - u
        along = inner(chord, point.tangent)
        across = chord - along * point.tangent
        if (
            inner(new.tangent, point.tangent) < _LEAST_COSINE
            or inner(across, across) > (_LARGEST_CORRECTION * along) ** 2
        ):
            raise _NotNeighboursError(
                f"from parameter {point.parameter:.8g} to {new.parameter:.8g} the branch jumps or "
                f"turns by more than the shortest step can follow."
            )

    def _reason(self, error: Exception, u: FloatArray, point: BranchPoint) -> StopReason:
        """Tell a model that ends here from a corrector that fails."""
        if isinstance(error, StateError) or isinstance(error.__cause__, StateError):
            return "the branch left the domain of the model"
        try:
            self._equations.residual(u + 4 * self._steps.shortest * point.tangent)
        except StateError:
            return "the branch left the domain of the model"
        return "the step became too small"

    def _passed_equilibrium(self, before: BranchPoint, after: BranchPoint) -> bool:
        # Beyond a Hopf point the same cycles come back with the opposite phase.
        if before.trivial_index is None:
            return False
        velocities = []
        for point in (before, after):
            segments = self._equations.shooting(point.parameter).segments
            velocities.append(segments.velocities(point.points, point.period) / segments.scale)
        return bool(np.sum(velocities[0] * velocities[1]) < 0)

    def _chord(
        self, u: FloatArray, before: BranchPoint, next_u: FloatArray, after: BranchPoint
    ) -> Chord:
        chord = next_u - u
        length = float(np.sqrt(self._equations.inner(chord, chord)))
        direction = chord / length

        def orbit_at(distance: float) -> BranchPoint:
            plane = self._equations.on_plane(u, direction, distance)
            found, _, iterations = self._solve(plane, u + distance * direction)
            return self.point_at(found, direction, iterations)

        return Chord(before, after, length, self._equations.unit, orbit_at)


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
