"""The equations of an orbit with a model parameter as one more unknown."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import scipy.sparse as sp

from birdmb._typing import FloatArray
from birdmb.errors import BirdmbError, StateError
from birdmb.orbits.branch_points import BranchPoint
from birdmb.orbits.cycle import LimitCycle, OrbitMethod
from birdmb.orbits.iteration import Iteration
from birdmb.orbits.newton import Equations, Matrix, factorise
from birdmb.orbits.problem import Model

Family = Callable[[float], Model]

# In units of the parameter range; truncation and noise balance as for the states.
_PARAMETER_STEP = 1e-5


@dataclass(frozen=True)
class Solution:
    """An orbit that lies on the plane of its equations, and how it was found."""

    equations: ExtendedEquations
    u: FloatArray
    iterations: tuple[Iteration, ...]


@dataclass(frozen=True)
class ExtendedEquations(ABC):
    """The orbit of family(p), and a plane that the solution lies on (Keller 1977).

    Unknowns: those of the orbit's equations, then p in units of the parameter range. The plane is
    the set of points at `distance` from `anchor` along `direction`, in the inner product in which a
    mean square over the orbit's states, the period and the parameter weigh alike: it does not
    depend on how many states there are.
    """

    family: Family
    parameter_range: tuple[float, float]
    scale: FloatArray
    start: float
    period_unit: float
    anchor: FloatArray
    direction: FloatArray
    distance: float

    @property
    @abstractmethod
    def method(self) -> OrbitMethod:
        """How the orbits are made discrete."""

    @property
    @abstractmethod
    def expensive_jacobian(self) -> bool:
        """As of the orbit's equations."""

    @abstractmethod
    def excess(self, iterations: tuple[Iteration, ...]) -> int:
        """By how much the corrector worked more than after a step of the right length."""

    @abstractmethod
    def orbit(self, parameter: float) -> Equations:
        """Equations of the orbit at a parameter; StateError where there is no model."""

    @abstractmethod
    def unknowns(self, parameter: float, points: FloatArray, period: float) -> FloatArray:
        """Unknowns of an orbit with states `points` (M, n)."""

    @abstractmethod
    def states(self, u: FloatArray) -> FloatArray:
        """States (M, n) of the unknowns, in their own units."""

    @abstractmethod
    def from_point(self, point: BranchPoint) -> tuple[Self, FloatArray, FloatArray]:
        """Equations that suit a step from a point, its unknowns there, and its tangent."""

    @abstractmethod
    def carried(self, vector: FloatArray) -> FloatArray:
        """Unknowns or a tangent of the same kind of equations, as vector of these."""

    @abstractmethod
    def corrected(self, u: FloatArray, tolerance: float, max_iterations: int) -> Solution:
        """The solution from a guess; raises the errors of `solve`."""

    @abstractmethod
    def solution_at(self, u: FloatArray) -> Solution:
        """The solution `u` as it is."""

    @abstractmethod
    def linearised(self, solution: Solution) -> tuple[LimitCycle, Matrix]:
        """The orbit of a solution of these equations, and their Jacobian there."""

    @abstractmethod
    def velocities(self, u: FloatArray) -> FloatArray:
        """Rates (M, n) of the scaled states along an orbit."""

    def on_plane(self, anchor: FloatArray, direction: FloatArray, distance: float = 0.0) -> Self:
        """Return the same equations on another plane."""
        return replace(self, anchor=anchor, direction=direction, distance=distance)

    @property
    def unit(self) -> float:
        """Width of the parameter range."""
        return self.parameter_range[1] - self.parameter_range[0]

    def parameter(self, u: FloatArray) -> float:
        """Parameter of the unknowns."""
        return float(u[-1]) * self.unit

    def inner(self, a: FloatArray, b: FloatArray) -> float:
        """Inner product that does not depend on the number of states."""
        return float(a @ (self._weights(len(a)) * b))

    def model(self, parameter: float) -> Model:
        """Member of the family; StateError where there is none."""
        low, high = self.parameter_range
        margin = 1e-9 * self.unit
        if not low - margin <= parameter <= high + margin:
            raise StateError(f"The parameter {parameter:.8g} is outside {low:.8g} to {high:.8g}.")
        try:
            return self.family(min(max(parameter, low), high))
        except BirdmbError as error:
            raise StateError(f"No model at parameter {parameter:.8g}: {error}") from error

    def start_and_period(self, u: FloatArray) -> tuple[FloatArray, float]:
        """State (n,) at the start and the period."""
        return self.orbit(self.parameter(u)).start_and_period(u[:-1])

    def closure(self, residual: FloatArray) -> float:
        """Largest closure error in the units of the states."""
        return self.orbit(self.parameter(self.anchor)).closure(residual[:-1])

    def residual(self, u: FloatArray) -> FloatArray:
        """Residual of the orbit and distance from the plane."""
        gaps = self.orbit(self.parameter(u)).residual(u[:-1])
        return np.append(gaps, self.inner(self.direction, u - self.anchor) - self.distance)

    def jacobian(self, u: FloatArray) -> Matrix:
        """Derivative of the residual."""
        return self.border(u, self.orbit(self.parameter(u)).jacobian(u[:-1]))

    def border(self, u: FloatArray, matrix: Matrix) -> Matrix:
        """Derivative of the residual from that of the orbit's equations."""
        low, high = self.parameter_range
        p, step = self.parameter(u), _PARAMETER_STEP * self.unit
        above, below = min(p + step, high), max(p - step, low)
        change = self.orbit(above).residual(u[:-1]) - self.orbit(below).residual(u[:-1])
        column = change / (above - below) * self.unit
        row = self._weights(len(u)) * self.direction
        if isinstance(matrix, np.ndarray):
            return np.vstack([np.column_stack([matrix, column]), row])
        wide = sp.hstack([matrix, sp.coo_array(column[:, None])])
        return sp.csc_array(sp.vstack([wide, sp.coo_array(row[None, :])]))

    def cycle_and_tangent(self, solution: Solution) -> tuple[LimitCycle, FloatArray]:
        """The orbit of a solution of these equations, and the unit tangent of the branch there.

        It points to the side of the plane that `direction` points to.
        """
        cycle, matrix = self.linearised(solution)
        solve, _ = factorise(matrix)
        tangent = solve(np.append(np.zeros(len(solution.u) - 1), 1.0))
        return cycle, np.asarray(tangent / np.sqrt(self.inner(tangent, tangent)))

    def _weights(self, size: int) -> FloatArray:
        weights = np.ones(size)
        n = len(self.scale)
        count = (size - 1) // n * n
        weights[:count] = n / count
        return weights
