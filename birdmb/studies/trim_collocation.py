"""A trimmed limit cycle as one collocation system: the orbit and the targets together.

As `birdmb.studies.trim_equations` does by shooting: where a multiplier passes +1 the cycle at given
parameters folds back, the trimmed flight does not.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Self

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.models.motion import planar_velocity
from birdmb.orbits.collocation import CollocationEquations, LatestJacobians
from birdmb.orbits.enough_nodes import Collocated, collocate
from birdmb.orbits.newton import Linear
from birdmb.orbits.right_hand_side import RightHandSide
from birdmb.orbits.trigonometric import resampled
from birdmb.studies.cycles import KeptModels
from birdmb.studies.trim_equations import ITERATIONS, LEAST_DAMPING

_STEP = 1e-6  # of the distance between the bounds
_MOST_NODES = 129


class CollocatedTrim:
    """Collocation of the orbit, and mean climb rate and speed minus their targets.

    Unknowns (N n + k,): the states at N nodes of the beat in units of the state scale, and the
    parameters as shares of the way between their bounds. Residuals: the mismatch of the slopes as
    in `CollocationEquations`, then (k,) in m/s, the means being those over the nodes.

    Args:
        model_at: the models at parameters (k,).
        low: lower bounds (k,); without any there is only the orbit.
        high: upper bounds (k,).
        targets: "climb_rate" and perhaps "speed", m/s; as many as parameters.
        nodes: number N of nodes, odd.
    """

    expensive_jacobian = True

    def __init__(
        self,
        model_at: KeptModels,
        low: FloatArray,
        high: FloatArray,
        targets: Mapping[str, float],
        nodes: int,
    ) -> None:
        self._model_at, self._low, self._width = model_at, low, high - low
        self._targets, self.nodes = targets, nodes
        self._equations: dict[tuple[float, ...], CollocationEquations] = {}
        self.latest = LatestJacobians()

    def on_nodes(self, nodes: int, u: FloatArray) -> tuple[Self, FloatArray]:
        """The same system and unknowns on other nodes."""
        high = self._low + self._width
        other = type(self)(self._model_at, self._low, high, self._targets, nodes)
        states, _ = self.unpack(u)
        scaled = resampled(states.reshape(self.nodes, -1), nodes)
        return other, np.concatenate([scaled.ravel(), u[states.size :]])

    def pack(self, path: FloatArray, point: FloatArray) -> FloatArray:
        """Unknowns of states (K, n) at K even instants, K odd, and parameters (k,)."""
        scaled = path / self._model_at(point).state_scale
        shares = (point - self._low) / self._width
        return np.concatenate([resampled(scaled, self.nodes).ravel(), shares])

    def unpack(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Scaled states (N n,), and parameters (k,)."""
        size = u.size - self._low.size
        return u[:size], self._low + u[size:] * self._width

    def within_bounds(self, point: FloatArray) -> FloatArray:
        """The parameters (k,) within their bounds that are nearest to some."""
        return np.clip(point, self._low, self._low + self._width)

    def path(self, u: FloatArray) -> FloatArray:
        """States (N, n) at the nodes, in their own units."""
        states, point = self.unpack(u)
        return states.reshape(self.nodes, -1) * self._model_at(point).state_scale

    def orbit(self, point: FloatArray) -> CollocationEquations:
        """The equations of the orbit alone at parameters (k,)."""
        key = tuple(point.tolist())
        if key not in self._equations:
            model = self._model_at(point)
            rhs = RightHandSide(model, model.state_scale)
            self._equations[key] = CollocationEquations(
                rhs, 0.0, model.bird.period, False, self.nodes
            )
        return self._equations[key]

    def residual(self, u: FloatArray) -> FloatArray:
        """Residual (N n + k,); StateError out of bounds, or where the right-hand side fails."""
        shares = u[u.size - self._low.size :]
        if ((shares < 0.0) | (shares > 1.0)).any():
            raise StateError("the parameters left their bounds.")
        states, point = self.unpack(u)
        equations = self.orbit(point)
        mean = planar_velocity(self.path(u)).mean(axis=0)
        reached = {"climb_rate": mean[1], "speed": np.hypot(*mean)}
        missed = [reached[name] - wanted for name, wanted in self._targets.items()]
        return np.concatenate([equations.residual(states), missed])

    def jacobian(self, u: FloatArray) -> FloatArray:
        """Its derivative."""
        self.latest.jacobians = self.rate_jacobians(u)
        return self.assemble(u, self.latest.jacobians)

    def rate_jacobians(self, u: FloatArray) -> FloatArray:
        """Derivatives (N, n, n + k) of the rates by the scaled states, then by the shares.

        By the shares differences of the slopes in a period, which they may change, per period.
        """
        states, point = self.unpack(u)
        equations = self.orbit(point)
        slopes = _slopes(equations, states)
        columns = [equations.rate_jacobians(states)]
        for share, width in zip(np.eye(point.size), self._width, strict=True):
            inwards = point @ share > self._low @ share + 0.5 * width
            step = -_STEP if inwards else _STEP
            shifted = _slopes(self.orbit(point + step * width * share), states)
            columns.append(((shifted - slopes) / (step * equations.period))[:, :, None])
        return np.concatenate(columns, axis=2)

    def assemble(self, u: FloatArray, rate_jacobians: FloatArray) -> FloatArray:
        """Its derivative from those (N, n, n + k) of the rates."""
        states, point = self.unpack(u)
        equations = self.orbit(point)
        n = states.size // self.nodes
        by_share = rate_jacobians[:, :, n:].reshape(states.size, point.size)
        matrix = np.zeros((u.size, u.size))
        matrix[: states.size, : states.size] = equations.assemble(states, rate_jacobians[:, :, :n])
        matrix[: states.size, states.size :] = -equations.period * by_share / np.sqrt(self.nodes)
        if point.size:
            matrix[states.size :, : states.size] = self._means_by_state(u)
        return matrix

    def product(self, u: FloatArray, rate_jacobians: FloatArray) -> Linear:
        """What the derivative makes of a change of the unknowns."""
        return self.assemble(u, rate_jacobians).__matmul__

    def start_and_period(self, u: FloatArray) -> tuple[FloatArray, float]:
        """State (n,) at t = 0, and period."""
        states, point = self.unpack(u)
        return self.orbit(point).start_and_period(states)

    def closure(self, residual: FloatArray) -> float:
        """Largest residual."""
        return float(np.abs(residual).max())

    def round_off(self, u: FloatArray) -> float:
        """Norm that round-off leaves of the residual."""
        states, point = self.unpack(u)
        return self.orbit(point).round_off(states)

    def _means_by_state(self, u: FloatArray) -> FloatArray:
        """Derivatives (k, N n) of the means by the scaled states."""
        x = self.path(u)
        scale = self._model_at(self.unpack(u)[1]).state_scale
        forwards, down, theta = x[:, 0], x[:, 1], x[:, 3]
        c, s = np.cos(theta), np.sin(theta)
        by_state = np.zeros((2, *x.shape))
        by_state[0, :, 0], by_state[0, :, 1], by_state[0, :, 3] = c, s, down * c - forwards * s
        by_state[1, :, 0], by_state[1, :, 1], by_state[1, :, 3] = s, -c, forwards * c + down * s
        forward, climb = (by_state * scale / self.nodes).reshape(2, -1)
        mean = planar_velocity(x).mean(axis=0)
        along, upwards = mean / np.hypot(*mean)
        rows = {"climb_rate": climb, "speed": along * forward + upwards * climb}
        return np.array([rows[name] for name in self._targets])


def _slopes(equations: CollocationEquations, states: FloatArray) -> FloatArray:
    """Scaled rates per period (N, n) at the nodes."""
    return equations.period * equations.rates(*equations.unpack(states))


def solve_collocated(
    equations: CollocatedTrim,
    path: FloatArray,
    point: FloatArray,
    *,
    tolerance: float,
    accuracy: float,
) -> tuple[FloatArray, Collocated[CollocationEquations]]:
    """Parameters (k,) and orbit of a trimmed cycle, by Newton's method on as many nodes as needed.

    Args:
        equations: on the number of nodes to begin with.
        path: states (K, n) at K even instants, K odd, to start from.
        point: parameters (k,) to start from.
        tolerance: norm of the residual accepted.
        accuracy: largest error of the states of the trimmed flight, in units of their scale.

    Returns:
        The parameters, and the orbit. Its error and what a finer solution makes of it are those of
        the trimmed flight, whose parameters follow; at fixed ones the orbit may be ill-conditioned,
        as it is beside a fold.

    Raises:
        OrbitError: it was not found; `NotSmoothError` where the orbit is too rough.
        StateError: the right-hand side fails at the start.
    """
    trimmed = collocate(
        equations,
        equations.pack(path, point),
        damping="line-search",
        tolerance=tolerance,
        accuracy=accuracy,
        max_iterations=ITERATIONS,
        most_nodes=_MOST_NODES,
        shortest_damping=LEAST_DAMPING,
    )
    states, point = trimmed.equations.unpack(trimmed.u)
    finer_states, finer_point = trimmed.finer.unpack(trimmed.finer_u)
    return point, Collocated(
        equations=trimmed.equations.orbit(point),
        u=states,
        residual=trimmed.residual[: states.size],
        finer=trimmed.finer.orbit(trimmed.finer.within_bounds(finer_point)),
        finer_u=finer_states,
        state_error=trimmed.state_error,
        iterations=trimmed.iterations,
    )
