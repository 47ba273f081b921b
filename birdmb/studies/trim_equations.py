"""A trimmed limit cycle as one system of equations: closure and targets together.

Where a multiplier passes +1 a limit cycle at given parameters is ill defined, for a slight change
of them moves it far. The trimmed flight is not: the parameters move with it.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import scipy.sparse as sp

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.models.motion import planar_velocity
from birdmb.models.wing_model import BirdModel
from birdmb.orbits.newton import solve
from birdmb.studies.cycles import KeptModels

_TOLERANCE = 1e-10  # below what cycles are searched to, so that theirs is met at once
ITERATIONS = 12
LEAST_DAMPING = 1 / 16  # a search that creeps seldom arrives, and takes long
_STEP = 1e-6  # of the state scale and of the distance between the bounds


class TrimEquations:
    """Closure of the orbit, and mean climb rate and speed minus their targets.

    Unknowns (n + k,): the state at t = 0 in units of the state scale, and the parameters as shares
    of the way between their bounds. Residuals in units of the state scale and in m/s.

    Args:
        model_at: the models at parameters (k,).
        low: lower bounds (k,).
        high: upper bounds (k,).
        targets: "climb_rate" and perhaps "speed", m/s.
    """

    expensive_jacobian = True

    def __init__(
        self,
        model_at: KeptModels,
        low: FloatArray,
        high: FloatArray,
        targets: Mapping[str, float],
    ) -> None:
        self._model_at, self._low, self._width = model_at, low, high - low
        self._targets = targets

    def solve(self, point: FloatArray, x0: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Parameters (k,) and state (n,) of a trimmed cycle near these, by Newton's method.

        Raises:
            OrbitError: it was not found.
            StateError: there is no flight to start from.
        """
        scale = self._model_at(point).state_scale
        found = solve(
            self,
            np.concatenate([x0 / scale, (point - self._low) / self._width]),
            damping="line-search",
            tolerance=_TOLERANCE,
            max_iterations=ITERATIONS,
            shortest_damping=LEAST_DAMPING,
        )
        point, x0, _ = self._unpacked(found.u)
        return point, x0

    def residual(self, u: FloatArray) -> FloatArray:
        """Residual (n + k,); StateError out of bounds, or where there is no flight."""
        _, x0, model = self._unpacked(u)
        period = model.bird.period
        flight = model.trajectory(x0, 0.0, period)
        gap = (flight.states[-1] - x0) / model.state_scale
        velocity = planar_velocity(flight.states)
        mean = 0.5 * (velocity[:-1] + velocity[1:]).mean(axis=0)
        reached = {"climb_rate": float(mean[1]), "speed": float(np.hypot(*mean))}
        missed = [reached[name] - wanted for name, wanted in self._targets.items()]
        return np.concatenate([gap, missed])

    def jacobian(self, u: FloatArray) -> sp.csc_array:
        """Its derivative (n + k, n + k), by forward differences: it only has to lead Newton."""
        here = self.residual(u)
        columns = []
        for i in range(u.size):
            shifted = u.copy()
            shares = u[u.size - self._low.size :]
            inwards = i >= u.size - shares.size and u[i] > 0.5
            shifted[i] += -_STEP if inwards else _STEP
            columns.append((self.residual(shifted) - here) / (shifted[i] - u[i]))
        return sp.csc_array(np.column_stack(columns))

    def start_and_period(self, u: FloatArray) -> tuple[FloatArray, float]:
        """State (n,) at t = 0 and period."""
        _, x0, model = self._unpacked(u)
        return x0, model.bird.period

    def closure(self, residual: FloatArray) -> float:
        """Largest residual."""
        return float(np.abs(residual).max())

    def _unpacked(self, u: FloatArray) -> tuple[FloatArray, FloatArray, BirdModel]:
        n = u.size - self._low.size
        if ((u[n:] < 0.0) | (u[n:] > 1.0)).any():
            raise StateError("the parameters left their bounds.")
        point = self._low + u[n:] * self._width
        model = self._model_at(point)
        return point, u[:n] * model.state_scale, model
