"""Collocation equations with a model parameter as one more unknown."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal, Self, cast

import numpy as np

from birdmb._typing import FloatArray
from birdmb.orbits.branch_points import BranchPoint
from birdmb.orbits.collocated import linearise_collocated
from birdmb.orbits.collocation import CollocationEquations, LatestJacobians
from birdmb.orbits.cycle import LimitCycle, cycle_type
from birdmb.orbits.enough_nodes import FIRST_NODES, Collocated, collocate, fewer_nodes
from birdmb.orbits.extended import ExtendedEquations, Solution
from birdmb.orbits.iteration import Iteration
from birdmb.orbits.newton import Linear, Matrix
from birdmb.orbits.right_hand_side import RightHandSide
from birdmb.orbits.trigonometric import resampled

# Fewer nodes are taken only where they leave this part of the error allowed, so that the number
# does not go up and down from point to point.
_CLEARLY = 0.1
_IDEAL_STEPS = 5


@dataclass(frozen=True)
class CollocatedSolution(Solution):
    """A solution with what finer equations make of it."""

    found: Collocated[ExtendedCollocation]


@dataclass(frozen=True)
class ExtendedCollocation(ExtendedEquations):
    """Slopes of the orbit of family(p) at N nodes, on a plane.

    Attributes:
        nodes: number N of nodes.
        accuracy: largest error of the states accepted, in units of their scale.
        most_nodes: number beyond which an orbit is refused as too rough.
        by_differences: whether derivatives come from differences though the model has its own.
    """

    nodes: int
    accuracy: float
    most_nodes: int
    by_differences: bool = False
    latest: LatestJacobians = field(default_factory=LatestJacobians, repr=False, compare=False)

    method: Literal["collocation"] = "collocation"
    expensive_jacobian = True

    def excess(self, iterations: tuple[Iteration, ...]) -> int:
        """By how many steps more than five, most of which take the Jacobian of the first."""
        return len(iterations) - 1 - _IDEAL_STEPS

    def orbit(self, parameter: float) -> CollocationEquations:
        """Collocation equations of the model at a parameter; StateError where there is none."""
        model = self.model(parameter)
        rhs = RightHandSide(model, self.scale, self.by_differences)
        period = model.period or self.period_unit
        return CollocationEquations(rhs, self.start, period, model.period is None, self.nodes)

    def unknowns(self, parameter: float, points: FloatArray, period: float) -> FloatArray:
        """Unknowns of an orbit with states `points` (N, n) at the nodes."""
        orbit = self.orbit(parameter)
        return np.append(orbit.pack(points / self.scale, period), parameter / self.unit)

    def states(self, u: FloatArray) -> FloatArray:
        """States (N, n) of the unknowns at the nodes, in their own units."""
        points, _ = self.orbit(self.parameter(u)).unpack(u[:-1])
        return points * self.scale

    def with_sound_derivatives(self, u: FloatArray) -> Self:
        """The same equations, by differences if these contradict the model's derivatives at `u`."""
        gap = self.orbit(self.parameter(u)).derivative_gap(u[:-1])
        return replace(self, by_differences=gap > 0)

    def from_point(self, point: BranchPoint) -> tuple[Self, FloatArray, FloatArray]:
        """Equations on the nodes of a point, or on fewer where its states hardly need as many."""
        here = replace(self, nodes=len(point.points), latest=LatestJacobians())
        u = here.unknowns(point.parameter, point.points, point.period)
        fewer = fewer_nodes(here.nodes)
        scaled = point.points / self.scale
        lost = resampled(resampled(scaled, fewer), here.nodes) - scaled
        if fewer < FIRST_NODES or np.abs(lost).max() > _CLEARLY * self.accuracy:
            return here, u, point.tangent
        coarser = replace(here, nodes=fewer, latest=LatestJacobians())
        tangent = coarser.carried(point.tangent)
        return coarser, coarser.carried(u), tangent / np.sqrt(self.inner(tangent, tangent))

    def carried(self, vector: FloatArray) -> FloatArray:
        """Unknowns or a tangent on any nodes, on these."""
        n = len(self.scale)
        count = (len(vector) - 1) // n * n
        states = resampled(vector[:count].reshape(-1, n), self.nodes)
        return np.concatenate([states.ravel(), vector[count:]])

    def on_nodes(self, nodes: int, u: FloatArray) -> tuple[Self, FloatArray]:
        """The same equations and unknowns on other nodes."""
        other = replace(self, nodes=nodes, latest=LatestJacobians())
        plane = other.carried(self.anchor), other.carried(self.direction)
        return other.on_plane(*plane, self.distance), other.carried(u)

    def jacobian(self, u: FloatArray) -> Matrix:
        """Derivative of the residual."""
        self.latest.jacobians = self.rate_jacobians(u)
        return self.assemble(u, self.latest.jacobians)

    def rate_jacobians(self, u: FloatArray) -> FloatArray:
        """Derivatives (N, n, n) of the rates by the scaled states."""
        return self.orbit(self.parameter(u)).rate_jacobians(u[:-1])

    def assemble(self, u: FloatArray, rate_jacobians: FloatArray) -> FloatArray:
        """Derivative of the residual from the derivatives (N, n, n) of the rates."""
        matrix = self.orbit(self.parameter(u)).assemble(u[:-1], rate_jacobians)
        return cast("FloatArray", self.border(u, matrix))

    def product(self, u: FloatArray, rate_jacobians: FloatArray) -> Linear:
        """What the derivative makes of a change of the unknowns."""
        return self.assemble(u, rate_jacobians).__matmul__

    def round_off(self, u: FloatArray) -> float:
        """Norm that round-off leaves of the residual."""
        return self.orbit(self.parameter(u)).round_off(u[:-1])

    def corrected(self, u: FloatArray, tolerance: float, max_iterations: int) -> CollocatedSolution:
        """The solution from a guess, on as many nodes as it needs; raises as `collocate`."""
        return self._collocated(u, tolerance, max_iterations, fixed=False)

    def solution_at(self, u: FloatArray) -> CollocatedSolution:
        """The solution `u` as it is."""
        return self._collocated(u, np.inf, 1, fixed=True)

    def _collocated(
        self, u: FloatArray, tolerance: float, max_iterations: int, *, fixed: bool
    ) -> CollocatedSolution:
        found = collocate(
            self,
            u,
            damping="line-search",
            tolerance=tolerance,
            accuracy=self.accuracy,
            max_iterations=max_iterations,
            most_nodes=self.most_nodes,
            fixed=fixed,
        )
        return CollocatedSolution(found.equations, found.u, found.iterations, found)

    def linearised(self, solution: Solution) -> tuple[LimitCycle, Matrix]:
        """The orbit of a solution, and the Jacobian there."""
        found = cast("CollocatedSolution", solution).found
        orbit = self.orbit(self.parameter(found.u))
        low, high = self.parameter_range
        there = float(np.clip(found.finer.parameter(found.finer_u), low, high))
        finer = found.finer.orbit(there)
        gap = orbit.derivative_gap(found.u[:-1])
        if gap > 0:
            orbit, finer = orbit.by_differences(), finer.by_differences()
        rate_jacobians = orbit.rate_jacobians(found.u[:-1])
        linearised = linearise_collocated(
            Collocated(
                orbit,
                found.u[:-1],
                found.residual[:-1],
                finer,
                found.finer_u[:-1],
                found.state_error,
                found.iterations,
            ),
            accuracy=self.accuracy,
            derivative_gap=gap,
            rate_jacobians=rate_jacobians,
        )
        cycle = cycle_type(linearised.model).of(
            linearised,
            solution.iterations,
            nodes=orbit.nodes,
            state_error=found.state_error,
        )
        return cycle, self.border(found.u, orbit.assemble(found.u[:-1], rate_jacobians))

    def velocities(self, u: FloatArray) -> FloatArray:
        """Rates (N, n) of the scaled states at the nodes."""
        orbit = self.orbit(self.parameter(u))
        return orbit.rates(*orbit.unpack(u[:-1]))
