"""Shooting equations with a model parameter as one more unknown."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from birdmb._typing import FloatArray
from birdmb.errors import BirdmbError, StateError
from birdmb.orbits.newton import factorise
from birdmb.orbits.problem import Model
from birdmb.orbits.segments import JacobianMethod, Segments
from birdmb.orbits.shooting import ShootingEquations

Family = Callable[[float], Model]

# In units of the parameter range; truncation and noise balance as for the states.
_PARAMETER_STEP = 1e-5


@dataclass(frozen=True)
class ExtendedEquations:
    """Closure of the orbit of family(p), and a plane that the solution lies on (Keller 1977).

    Unknowns: those of `ShootingEquations`, then p in units of the parameter range. The plane is
    the set of points at `distance` from `anchor` along `direction`, in the inner product in which a
    mean square over the segments' states, the period and the parameter weigh alike.
    """

    family: Family
    parameter_range: tuple[float, float]
    scale: FloatArray
    start: float
    period_unit: float
    jacobian_method: JacobianMethod
    executor: Executor | None
    anchor: FloatArray
    direction: FloatArray
    distance: float = 0.0

    def on_plane(
        self, anchor: FloatArray, direction: FloatArray, distance: float = 0.0
    ) -> ExtendedEquations:
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
        """Inner product that does not depend on the number of segments."""
        return float(a @ (self._weights(len(a)) * b))

    def shooting(self, parameter: float) -> ShootingEquations:
        """Shooting equations of the model at a parameter; StateError where there is none."""
        low, high = self.parameter_range
        margin = 1e-9 * self.unit
        if not low - margin <= parameter <= high + margin:
            raise StateError(f"The parameter {parameter:.8g} is outside {low:.8g} to {high:.8g}.")
        try:
            model = self.family(min(max(parameter, low), high))
        except BirdmbError as error:
            raise StateError(f"No model at parameter {parameter:.8g}: {error}") from error
        segments = Segments(model, self.scale, self.start, self.jacobian_method, self.executor)
        autonomous = model.period is None
        return ShootingEquations(segments, model.period or self.period_unit, autonomous)

    @property
    def dear_jacobian(self) -> bool:
        """As of the shooting equations."""
        return self.jacobian_method == "finite-differences"

    def start_and_period(self, u: FloatArray) -> tuple[FloatArray, float]:
        """State (n,) at the start and the period."""
        return self.shooting(self.parameter(u)).start_and_period(u[:-1])

    def closure(self, residual: FloatArray) -> float:
        """Largest closure error in the units of the states."""
        count = (len(residual) - 1) // len(self.scale) * len(self.scale)
        return float(np.abs(residual[:count].reshape(-1, len(self.scale)) * self.scale).max())

    def residual(self, u: FloatArray) -> FloatArray:
        """Closure errors and distance from the plane."""
        gaps = self.shooting(self.parameter(u)).residual(u[:-1])
        return np.append(gaps, self.inner(self.direction, u - self.anchor) - self.distance)

    def jacobian(self, u: FloatArray) -> sp.csc_array:
        """Derivative of the residual."""
        return self._border(u, self.shooting(self.parameter(u)).jacobian(u[:-1]))

    def tangent(self, u: FloatArray, factors: FloatArray) -> FloatArray:
        """Unit tangent of the branch at a solution with segment Jacobians `factors` (M, n, n).

        It points to the side of the plane that `direction` points to.
        """
        shooting = self.shooting(self.parameter(u))
        matrix = self._border(u, shooting.assemble(*shooting.unpack(u[:-1]), factors))
        solve, _ = factorise(matrix)
        tangent = solve(np.append(np.zeros(len(u) - 1), 1.0))
        return np.asarray(tangent / np.sqrt(self.inner(tangent, tangent)))

    def _weights(self, size: int) -> FloatArray:
        weights = np.ones(size)
        n = len(self.scale)
        count = (size - 1) // n * n
        weights[:count] = n / count
        return weights

    def _border(self, u: FloatArray, matrix: sp.csc_array) -> sp.csc_array:
        low, high = self.parameter_range
        p, step = self.parameter(u), _PARAMETER_STEP * self.unit
        above, below = min(p + step, high), max(p - step, low)
        change = self.shooting(above).residual(u[:-1]) - self.shooting(below).residual(u[:-1])
        column = change / (above - below) * self.unit
        row = self._weights(len(u)) * self.direction
        wide = sp.hstack([matrix, sp.coo_array(column[:, None])])
        return sp.csc_array(sp.vstack([wide, sp.coo_array(row[None, :])]))
