"""Shooting equations with a model parameter as one more unknown."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Literal, Self

import numpy as np

from birdmb._typing import FloatArray
from birdmb.orbits.branch_points import BranchPoint
from birdmb.orbits.cycle import LimitCycle, cycle_type
from birdmb.orbits.extended import ExtendedEquations, Solution
from birdmb.orbits.iteration import Iteration
from birdmb.orbits.linearisation import linearise
from birdmb.orbits.newton import Matrix, solve
from birdmb.orbits.periodic import periodic_multipliers
from birdmb.orbits.segments import JacobianMethod, Segments
from birdmb.orbits.shooting import ShootingEquations

_IDEAL_JACOBIANS = 3


@dataclass(frozen=True)
class ExtendedShooting(ExtendedEquations):
    """Closure of the orbit of family(p) over its segments, on a plane."""

    jacobian_method: JacobianMethod
    executor: Executor | None

    method: Literal["shooting"] = "shooting"

    @property
    def expensive_jacobian(self) -> bool:
        """As of the shooting equations."""
        return self.jacobian_method == "finite-differences"

    def excess(self, iterations: tuple[Iteration, ...]) -> int:
        """By how many Jacobians more than three."""
        return sum(not iteration.jacobian_reused for iteration in iterations[1:]) - _IDEAL_JACOBIANS

    def orbit(self, parameter: float) -> ShootingEquations:
        """Shooting equations of the model at a parameter; StateError where there is none."""
        model = self.model(parameter)
        segments = Segments(model, self.scale, self.start, self.jacobian_method, self.executor)
        return ShootingEquations(segments, model.period or self.period_unit, model.period is None)

    def unknowns(self, parameter: float, points: FloatArray, period: float) -> FloatArray:
        """Unknowns of an orbit with states `points` (M, n) at the starts of its segments."""
        return np.append(self.orbit(parameter).pack(points, period), parameter / self.unit)

    def states(self, u: FloatArray) -> FloatArray:
        """States (M, n) of the unknowns at the starts of the segments, in their own units."""
        return self.orbit(self.parameter(u)).unpack(u[:-1])[0]

    def from_point(self, point: BranchPoint) -> tuple[Self, FloatArray, FloatArray]:
        """These equations, unknowns and tangent of a point.

        Of a collocated one, over one segment from its first node.
        """
        if point.method == "shooting":
            return self, self.unknowns(point.parameter, point.points, point.period), point.tangent
        n = len(self.scale)
        tangent = np.concatenate([point.tangent[:n], point.tangent[point.points.size :]])
        tangent = tangent / np.sqrt(self.inner(tangent, tangent))
        return self, self.unknowns(point.parameter, point.points[:1], point.period), tangent

    def carried(self, vector: FloatArray) -> FloatArray:
        """The vector itself: the number of segments stays."""
        return vector

    def corrected(self, u: FloatArray, tolerance: float, max_iterations: int) -> Solution:
        """The solution from a guess; raises the errors of `solve`."""
        found = solve(
            self, u, damping="line-search", tolerance=tolerance, max_iterations=max_iterations
        )
        return Solution(self, found.u, found.iterations)

    def solution_at(self, u: FloatArray) -> Solution:
        """The solution `u` as it is."""
        return Solution(self, u, ())

    def linearised(self, solution: Solution) -> tuple[LimitCycle, Matrix]:
        """The orbit of a solution, and the Jacobian there."""
        orbit = self.orbit(self.parameter(solution.u))
        points, period = orbit.unpack(solution.u[:-1])
        found = linearise(orbit, points, period, periodic_multipliers)
        matrix = orbit.assemble(points, period, found.segment_jacobians)
        cycle = cycle_type(found.model).of(found, solution.iterations)
        return cycle, self.border(solution.u, matrix)

    def velocities(self, u: FloatArray) -> FloatArray:
        """Rates (M, n) of the scaled states at the starts of the segments."""
        orbit = self.orbit(self.parameter(u))
        points, period = orbit.unpack(u[:-1])
        return np.asarray(orbit.segments.velocities(points, period) / self.scale)
