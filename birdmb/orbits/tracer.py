"""Stepping along a branch and locating what happens between two of its points."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from birdmb._typing import FloatArray
from birdmb.errors import OrbitError, StateError
from birdmb.orbits.bifurcations import TESTS, critical_modulus, crossings, is_neutral_saddle
from birdmb.orbits.branch import Bifurcation, BifurcationKind, BranchPoint
from birdmb.orbits.cycle import LimitCycle
from birdmb.orbits.errors import BranchStopped, ConvergenceError, StopReason
from birdmb.orbits.extended import ExtendedEquations
from birdmb.orbits.linearisation import linearise
from birdmb.orbits.newton import Iteration, solve
from birdmb.orbits.periodic import periodic_multipliers
from birdmb.orbits.problem import HasLimitCycleType

Observables = Mapping[str, Callable[[LimitCycle], float]]

_CORRECTOR_ITERATIONS = 12
_IDEAL_JACOBIANS = 3
# A sharper turn between two points, or a longer way from the predicted one to the point, is retried
# with a shorter step, lest a fold or a branch be jumped over.
_LEAST_COSINE = 0.9
_LARGEST_CORRECTION = 0.5
_LOCATION_TOLERANCE = 1e-7  # in arclength


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
        start: BranchPoint,
        max_points: int,
        max_bifurcations: int | None = None,
        count: int = 1,
    ) -> Iterator[BranchPoint | Bifurcation]:
        """Yield the points that follow `start`, the `count`-th of up to `max_points`.

        The bifurcations on the way to a point come before it.
        """
        bifurcations = 0
        point, step = start, start.next_step
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
            located = [
                self._locate(kind, u, point, new_u, new, count - 1)
                for kind in crossings(point, new)
            ]
            for bifurcation in filter(None, located):
                yield bifurcation
                bifurcations += 1
            jacobians = sum(not iteration.jacobian_reused for iteration in iterations[1:])
            factor = 2 ** ((_IDEAL_JACOBIANS - jacobians) / 2)
            step = min(step * min(max(factor, 0.5), 2.0), self._steps.longest)
            new = replace(new, next_step=step)
            yield new
            if max_bifurcations is not None and bifurcations >= max_bifurcations:
                self._stop("the number of bifurcations asked for was reached", new)
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
            method="newton",
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

    def _locate(
        self,
        kind: BifurcationKind,
        u: FloatArray,
        before: BranchPoint,
        next_u: FloatArray,
        after: BranchPoint,
        index: int,
    ) -> Bifurcation | None:
        chord = next_u - u
        length = float(np.sqrt(self._equations.inner(chord, chord)))
        direction = chord / length
        seen = {0.0: before, length: after}

        def test(distance: float) -> float:
            if distance not in seen:
                plane = self._equations.on_plane(u, direction, distance)
                found, _, iterations = self._solve(plane, u + distance * direction)
                seen[distance] = self.point_at(found, direction, iterations)
            return TESTS[kind](seen[distance])

        try:
            point = seen[brentq(test, 0.0, length, xtol=_LOCATION_TOLERANCE)]
        except _Failure:
            # Still a bifurcation, between the nearest points seen on its two sides.
            left = seen[max(s for s in seen if test(s) * test(0.0) > 0)]
            right = seen[min(s for s in seen if test(s) * test(0.0) <= 0)]
            return Bifurcation(kind, left, abs(right.parameter - left.parameter), index)
        if kind == "Neimark-Sacker" and is_neutral_saddle(point):
            return None
        error = _LOCATION_TOLERANCE * self._equations.unit
        if kind != "fold":
            change = critical_modulus(after, kind)[0] - critical_modulus(before, kind)[0]
            slope = abs(change / (after.parameter - before.parameter))
            error += critical_modulus(point, kind)[1] / slope
        return Bifurcation(kind, point, error, index)
