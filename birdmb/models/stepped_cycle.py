"""A limit cycle of a model that is flown with fixed steps, and what these make of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import block_diag

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.models.wing_model import BirdModel
from birdmb.orbits import LimitCycle, periodic_multipliers
from birdmb.orbits.multipliers import paired_distances
from birdmb.orbits.problem import VariationalModel

# An error that halves when the steps are halved is twice the difference that this makes.
_ERROR_PER_DIFFERENCE = 2.0
# Kinks in a force leave an error that depends on where in a step they fall: at random, not less
# with twice the steps at hand than with others. Several numbers of steps sample it.
_ERROR_PER_SAMPLE = 4.0
_CLOSED = 1e-8
_NEWTON_STEPS = 6
# Left of a closure error: by a Newton step that converges, and by enough of them.
_CONTRACTION, _CONVERGED = 0.7, 0.01
_STEP = 1e-5
# The default numbers of steps can be divided by it.
_PARTS_FLOWN = 6


@dataclass(frozen=True, repr=False)
class SteppedCycle(LimitCycle):
    """Limit cycle of a bird, whose verdict counts the error of the integration.

    A collocated one is not integrated: it has no such error, and flying it is a check.
    """

    model: BirdModel

    @cached_property
    def _finer_model(self) -> BirdModel:
        """The same method with twice the steps: explicit against explicit."""
        return self.model.with_steps(2 * self.model.steps_per_beat)

    @cached_property
    def integration_error(self) -> float:
        """Error of the states by integration, in units of the state scale.

        Of the flow over a beat, against twice the steps; of a collocated cycle, its `state_error`.
        """
        if self.method == "collocation":
            return self.state_error
        end = self.start_time + self.period
        coarse, fine = (
            model.flow(self.x0, self.start_time, end) for model in (self.model, self._finer_model)
        )
        return float(np.abs((coarse - fine) / self.state_scale).max())

    @cached_property
    def flown_closure(self) -> float:
        """Largest closure error in units of the state scale, as the model's flow integrates.

        Of a collocated cycle, flown for a beat in as many parts as share the steps of the
        integration; infinite where the flow fails. It holds the integration's error, not that of
        the cycle alone. Of a shot one, the norm of the closure errors that the search left.
        """
        if self.method == "shooting":
            return self.iterations[-1].residual
        times = self.start_time + self.period * np.arange(_PARTS_FLOWN + 1) / _PARTS_FLOWN
        states = self.trajectory(times).states
        try:
            ends = [
                self.model.flow(*each)
                for each in zip(states[:-1], times[:-1], times[1:], strict=True)
            ]
        except StateError:
            return math.inf
        return float(np.abs((np.array(ends) - states[1:]) / self.state_scale).max())

    @cached_property
    def multiplier_integration_errors(self) -> FloatArray:
        """Errors (n,) of the multipliers by the integration's steps, alike for all of them.

        Twice the largest difference from the multipliers that twice the steps give, of the orbit
        that these have nearby; infinite where they have none. Where forces have kinks, as those of
        springs with two sides, four times the largest difference that several numbers of steps
        make. None of a collocated cycle.
        """
        if self.method == "collocation":
            return np.zeros(len(self.multipliers))
        model, steps = self.model, self.model.steps_per_beat
        others, factor = [self._finer_model], _ERROR_PER_DIFFERENCE
        if model.has_kinks:
            others += [model.with_steps(n) for n in (steps + 1, steps + steps // 6 + 2)]
            factor = _ERROR_PER_SAMPLE
        try:
            error = factor * max(map(self._difference_from, others))
        except StateError:
            error = np.inf
        return np.full(len(self.multipliers), error)

    @property
    def verdict_errors(self) -> FloatArray:
        """Errors (n,) of the multipliers that the verdict counts: also of the integration."""
        return np.asarray(self.multiplier_errors + self.multiplier_integration_errors)

    def _difference_from(self, model: BirdModel) -> float:
        """Largest difference from the multipliers that `model` gives; raises `StateError`."""
        points, times = self._closed_by(model)
        factors = np.array(
            [
                _flow_jacobian(model, *each, self.state_scale)
                for each in zip(points, times[:-1], times[1:], strict=True)
            ]
        )
        if not np.isfinite(factors).all():
            raise StateError("the flow is not finite beside the orbit.")
        none = np.zeros_like(factors)
        found = periodic_multipliers(factors, none, self.state_scale).multipliers
        return float(paired_distances(self.multipliers, found).max())

    def _closed_by(self, model: BirdModel) -> tuple[FloatArray, FloatArray]:
        """Starts (M, n) of the segments of the orbit that `model` has nearby, and times (M + 1,).

        By Newton's method with the Jacobians that are known; raises `StateError`.
        """
        scale, (m, n) = self.state_scale, self.points.shape
        times = np.linspace(self.start_time, self.start_time + self.period, m + 1)
        scaled = self.segment_jacobians / np.divide.outer(scale, scale)
        matrix = block_diag(*scaled) - np.kron(np.roll(np.eye(m), 1, axis=1), np.eye(n))

        def gaps(points: FloatArray) -> FloatArray:
            ends = [model.flow(*each) for each in zip(points, times[:-1], times[1:], strict=True)]
            return np.asarray((np.array(ends) - np.roll(points, -1, axis=0)) / scale)

        points, gap = self.points, gaps(self.points)
        first = last = np.abs(gap).max()
        for _ in range(_NEWTON_STEPS):
            points = points - np.linalg.lstsq(matrix, gap.ravel())[0].reshape(m, n) * scale
            gap = gaps(points)
            left = np.abs(gap).max()
            if left <= max(_CONVERGED * first, _CLOSED):
                return points, times
            if not left <= _CONTRACTION * last:
                break
            last = left
        raise StateError("no orbit nearby.")


def _flow_jacobian(
    model: BirdModel, x: FloatArray, t0: float, t1: float, scale: FloatArray
) -> FloatArray:
    if isinstance(model, VariationalModel):
        return model.flow_jacobian(x, t0, t1)[1]
    columns = [
        (model.flow(x + h, t0, t1) - model.flow(x - h, t0, t1)) / (2.0 * h.sum())
        for h in np.diag(_STEP * scale)
    ]
    return np.column_stack(columns)
