"""Flows and flow Jacobians over the segments of an orbit, spread over an executor.

Every flow is a pure function of its arguments and results keep their order, so that what comes out
is bitwise the same with and without an executor.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import Literal, TypeVar, cast

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError, StateError
from birdmb.orbits.problem import (
    HasCoarser,
    HasRhs,
    HasTrajectory,
    Model,
    Scalable,
    VariationalModel,
    flow_accuracy,
)

JacobianMethod = Literal["variational", "finite-differences"]
Result = TypeVar("Result")

# In units of the state scale: truncation 4e-10 balances a flow's noise of 1e-14 over 2e-5.
_STATE_STEP = 2e-5
_TIME_STEP = 1e-5
# Displacement over which the change of the Jacobians is observed, in units of the state scale.
_PROBE = 1e-5
# Round-off is no more in a coarser version: the distance of two may happen to be small.
_COARSER = 3.0
# By how much the two estimates of a difference are further apart than the first is off.
_OVERSTATED = 3.0


def choose_jacobian(
    model: Model, wanted: Literal["auto", "variational", "finite-differences"]
) -> JacobianMethod:
    """Resolve "auto": variational where the model can, else finite differences."""
    if wanted not in {"auto", "variational", "finite-differences"}:
        raise ArgumentError(
            f'jacobian must be "auto", "variational" or "finite-differences", not "{wanted}".'
        )
    able = isinstance(model, VariationalModel)
    if wanted == "variational" and not able:
        raise ArgumentError('jacobian="variational" needs a model with flow_jacobian.')
    return "variational" if able and wanted != "finite-differences" else "finite-differences"


def sample(model: Model, x0: FloatArray, t0: float, times: FloatArray, until: float) -> FloatArray:
    """States (k, n) at ascending `times` in [t0, until] of the solution through x0 at t0."""
    if isinstance(model, HasTrajectory):
        return np.asarray(model.trajectory(x0, t0, until, times).states, float)
    states, x, t = [], x0, t0
    for time in times:
        if time > t:
            x, t = _flow(model, x, t, float(time)), float(time)
        states.append(x)
    return np.array(states)


def _flow(model: Model, x0: FloatArray, t0: float, t1: float) -> FloatArray:
    end = np.asarray(model.flow(x0, t0, t1), float)
    if not np.isfinite(end).all():
        raise StateError(_not_finite("flow", x0, t0, t1))
    return end


def _flow_jacobian(model: VariationalModel, x0: FloatArray, t0: float, t1: float) -> FloatArray:
    factor = np.asarray(model.flow_jacobian(x0, t0, t1)[1], float)
    if not np.isfinite(factor).all():
        raise StateError(_not_finite("flow Jacobian", x0, t0, t1))
    return factor


def _not_finite(what: str, x0: FloatArray, t0: float, t1: float) -> str:
    state = np.array2string(x0, precision=6, max_line_width=1000)
    return f"The {what} from {state} at t = {t0:.6g} to {t1:.6g} is not finite."


@dataclass(frozen=True)
class Correction:
    """The way from a nearly closed orbit to where it closes, by the linearised flow.

    Attributes:
        length: in units of the state scale.
        displaced: points (M, n) and period at any distance along that way, in the same units.
    """

    length: float
    displaced: Callable[[float], tuple[FloatArray, float]]


@dataclass(frozen=True)
class Segments:
    """The work on the segments of one model: ends, velocities and Jacobians.

    `points` (M, n) are the states at the starts of M equal segments of [start, start + period].
    The model is taken on the scale, if it can be.
    """

    model: Model
    scale: FloatArray
    start: float
    jacobian_method: JacobianMethod
    executor: Executor | None = None

    def __post_init__(self) -> None:
        """Tell the model the scale."""
        if isinstance(self.model, Scalable):
            object.__setattr__(self, "model", self.model.scaled_to(self.scale))

    def ends(self, points: FloatArray, period: float) -> FloatArray:
        """States (M, n) at the ends of the segments; StateError where the flow fails."""
        t = self._times(points, period)
        return np.array(self._map(_flow, points, t[:-1], t[1:]))

    def velocities(self, points: FloatArray, period: float) -> FloatArray:
        """Time derivatives (M, n) at `points`: right-hand side, else differences of the flow."""
        t = self._times(points, period)[:-1]
        if isinstance(self.model, HasRhs):
            return np.array([self.model.rhs(*at) for at in zip(t, points, strict=True)], float)
        # One-sided, of second order: a flow need not run backwards.
        h = _TIME_STEP * period
        near = np.array(self._map(_flow, points, t, t + h))
        far = np.array(self._map(_flow, points, t, t + 2 * h))
        return np.asarray((4 * near - far - 3 * points) / (2 * h))

    def jacobians(self, points: FloatArray, period: float) -> FloatArray:
        """Segment flow Jacobians (M, n, n), in the units of the states."""
        if self.jacobian_method == "variational":
            t = self._times(points, period)
            return np.array(self._map(_flow_jacobian, points, t[:-1], t[1:]))
        plus, minus, taken = self.both_sides(points, period, _STATE_STEP)
        return np.swapaxes((plus - minus) / taken[:, :, None], 1, 2)

    def jacobians_and_curvatures(
        self, points: FloatArray, period: float, ends: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Segment flow Jacobians (M, n, n), and what `refined` needs besides them.

        `ends` (M, n) are the ends of the segments. By differences, the second of the two is the
        second derivative of the ends by each start state times the step taken, in the units of the
        Jacobians; else it is zero.
        """
        if self.jacobian_method == "variational":
            factors = self.jacobians(points, period)
            return factors, np.zeros_like(factors)
        plus, minus, taken = self.both_sides(points, period, _STATE_STEP)
        factors = (plus - minus) / taken[:, :, None]
        curvatures = 2 * (plus + minus - 2 * ends[:, None, :]) / taken[:, :, None]
        return np.swapaxes(factors, 1, 2), np.swapaxes(curvatures, 1, 2)

    def refined(
        self,
        points: FloatArray,
        period: float,
        factors: FloatArray,
        curvatures: FloatArray,
        correction: Correction,
    ) -> tuple[FloatArray, FloatArray]:
        """Better `factors` (M, n, n), and bounds (M, n, n) of the errors of their entries.

        The bounds hold the error of an orbit that is not quite closed: `correction` leads to where
        it closes, as far as the linearised flow tells.

        Variational: the factors as they are, with the accuracy that the model declares
        (`flow_accuracy`), else round-off, plus three times their distance from those of its coarser
        version if it has one, plus the change of the Jacobians over a displacement along the
        correction, in proportion.

        Differences: a second estimate by another formula at another place, one-sided differences
        over twice the step less the curvatures, as far as three times the correction on the far
        side. It is apart from the first one by three times the error that this has of its finite
        step h (h^2/6 times a third derivative) less three times the change of the Jacobians up to
        the closed orbit, and by the noise of the flow. A third of the distance is taken off the
        first estimate, which leaves the Jacobians of the closed orbit to third order in h. The
        bound is the whole distance, at least its rms over the (scaled) column, plus the round-off
        of the flow over h. It costs n + 1 flows a segment.
        """
        eps = float(np.finfo(float).eps)
        length = correction.length
        declared = flow_accuracy(self.model) * self._column_sizes(factors)
        if self.jacobian_method == "variational":
            bound = declared
            if isinstance(self.model, HasCoarser):
                coarser = replace(self, model=cast("Model", self.model.coarser()))
                apart = self._column_sizes(coarser.jacobians(points, period) - factors)
                bound = bound + _COARSER * apart
            if length > 0:
                moved = self.jacobians(*correction.displaced(_PROBE))
                bound = bound + np.abs(moved - factors) * (length / _PROBE)
            return factors, bound
        # An orbit that is far from closed is not left further behind, but seen in proportion.
        reach = min(_OVERSTATED * length, _PROBE)
        there, there_period = correction.displaced(-reach) if length > 0 else (points, period)
        ahead, taken = self._ahead(there, there_period, 2 * _STATE_STEP)
        second = (ahead - self.ends(there, there_period)[:, None, :]) / taken[:, :, None]
        apart = np.swapaxes(second, 1, 2) - curvatures - factors
        if reach < _PROBE:
            factors = factors - apart / _OVERSTATED
        else:
            apart = apart * (length / _PROBE)
        round_off = eps / _STATE_STEP * np.divide.outer(self.scale, self.scale)
        noise = np.maximum(np.abs(apart), self._column_sizes(apart)) + round_off
        return factors, noise + declared

    def _column_sizes(self, factors: FloatArray) -> FloatArray:
        # rms over each column in scaled states, given back in the units of each entry
        units = np.divide.outer(self.scale, self.scale)
        rms = np.sqrt(np.mean((factors / units) ** 2, axis=1, keepdims=True))
        return np.asarray(rms * units)

    def both_sides(
        self, points: FloatArray, period: float, step: float
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Ends (M, n, n) with start state j ahead and behind in row j, and their distances (M, n).

        `step` is in units of the state scale.
        """
        shifts = np.diag(step * self.scale)
        ahead, behind = points[:, None, :] + shifts, points[:, None, :] - shifts
        plus, minus = self.ends_from(np.array([ahead, behind]), period)
        # The steps as represented, not as wanted: x + h - x is not h.
        return plus, minus, np.einsum("kjj->kj", ahead - behind)

    def _ahead(
        self, points: FloatArray, period: float, step: float
    ) -> tuple[FloatArray, FloatArray]:
        """Ends (M, n, n) with start state j ahead in row j, and by how much (M, n)."""
        ahead = points[:, None, :] + np.diag(step * self.scale)
        taken = np.einsum("kjj->kj", ahead - points[:, None, :])
        return self.ends_from(ahead[None], period)[0], taken

    def ends_from(self, starts: FloatArray, period: float) -> FloatArray:
        """Ends of the segments from starts (..., M, k, n), k of them for each segment."""
        sides, _, count, n = starts.shape
        t = self._times(starts[0], period)
        t0, t1 = (np.tile(np.repeat(side, count), sides) for side in (t[:-1], t[1:]))
        return np.array(self._map(_flow, starts.reshape(-1, n), t0, t1)).reshape(starts.shape)

    def _times(self, points: FloatArray, period: float) -> FloatArray:
        return np.linspace(self.start, self.start + period, len(points) + 1)

    def _map(
        self, function: Callable[..., Result], states: FloatArray, t0: FloatArray, t1: FloatArray
    ) -> list[Result]:
        arguments: tuple[Iterable[object], ...] = (
            [self.model] * len(states),
            states,
            t0.tolist(),
            t1.tolist(),
        )
        mapper = map if self.executor is None else self.executor.map
        return list(mapper(function, *arguments))
