"""The right-hand side of a model and its derivative at many instants, in units of the scale."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.orbits.problem import (
    HasCoarser,
    HasJacobian,
    HasRateJacobians,
    HasRates,
    HasRhs,
    Scalable,
)

_EPS = float(np.finfo(float).eps)
# Where truncation and round-off of a central difference balance, in units of the state scale.
_STEP = _EPS ** (1 / 3)
# By how much a derivative must be off differences beyond what these are known to.
_MARGIN = 10.0
# Round-off is no more over twice the steps: the distance may happen to be small.
_COARSER = 3.0
# Of a derivative that a model gives, in units of machine precision times its largest entry.
_ROUND_OFF = 10.0
_CHECKING_STEPS = (1e-3, 3e-5, 1e-6)
_INSTANTS_CHECKED = 8
# Differences that are known to no more than this part of themselves do not decide.
_SHARP = 1e-3


Batched = Callable[[FloatArray, FloatArray], FloatArray]


# Protocols are slow to check, and one class of models has right-hand sides by the thousand.
@lru_cache
def _class_has(kind: type, protocol: Any) -> bool:
    return issubclass(kind, protocol)


def _has(model: object, protocol: Any) -> bool:
    """Whether a model has the methods of a protocol, by its class or by itself."""
    kind: Any = type(model)
    return _class_has(kind, protocol) or isinstance(model, protocol)


def batched_rates(model: HasRates | HasRhs) -> Batched:
    """Function of times (K,) and states (K, n) that returns the model's rates (K, n)."""
    either: Any = model
    if _has(model, HasRates):
        rates: Batched = either.rates
        return rates
    rhs = either.rhs
    return lambda times, x: np.array(
        [rhs(*at) for at in zip(times.tolist(), x, strict=True)], float
    )


@dataclass(frozen=True)
class RightHandSide:
    """Scaled rates f(t, y) of a model, with y = x / scale, at K instants in one call.

    Attributes:
        model: a `Model` with `rates` or `rhs`; it is taken on the scale, if it can be.
        scale: typical sizes (n,) of its states.
        by_differences: whether derivatives come from differences though the model has its own.
    """

    model: Any
    scale: FloatArray
    by_differences: bool = False

    def __post_init__(self) -> None:
        """Tell the model the scale."""
        if hasattr(self.model, "scaled_to") and isinstance(self.model, Scalable):
            object.__setattr__(self, "model", self.model.scaled_to(self.scale))

    @cached_property
    def has_derivative(self) -> bool:
        """Whether derivatives are the model's own."""
        able = _has(self.model, HasRateJacobians) or _has(self.model, HasJacobian)
        return able and not self.by_differences

    @cached_property
    def _rates(self) -> Batched:
        return batched_rates(self.model)

    @cached_property
    def _jacobians(self) -> Batched:
        model = self.model
        if _has(model, HasRateJacobians):
            return model.rate_jacobians
        assert isinstance(model, HasJacobian)
        jacobian = model.jacobian
        return lambda times, x: np.array(
            [jacobian(*at) for at in zip(times.tolist(), x, strict=True)], float
        )

    def rates(self, times: FloatArray, states: FloatArray) -> FloatArray:
        """Rates (K, n) per second at `times` (K,) in scaled `states` (K, n).

        Raises:
            StateError: the right-hand side fails or is not finite.
        """
        with np.errstate(all="ignore"):
            found = np.asarray(self._rates(times, states * self.scale), float) / self.scale
        if not np.isfinite(found).all():
            k = int(np.argmin(np.isfinite(found).all(axis=1)))
            raise StateError(f"The right-hand side at t = {times[k]:.6g} is not finite.")
        return found

    def jacobians(self, times: FloatArray, states: FloatArray) -> FloatArray:
        """Derivatives (K, n, n) of the rates by the scaled states; raises `StateError`."""
        if not self.has_derivative:
            return self._differences(times, states)
        units = np.divide.outer(self.scale, self.scale)
        with np.errstate(all="ignore"):
            found = np.asarray(self._jacobians(times, states * self.scale), float)
        if not np.isfinite(found).all():
            raise StateError("The derivative of the right-hand side is not finite.")
        return np.asarray(found / units)

    def _differences(self, times: FloatArray, states: FloatArray) -> FloatArray:
        n = states.shape[1]
        middle, shifts = states[:, None, :], _STEP * np.eye(n)
        rows = np.stack([middle + shifts, middle - shifts], axis=1)
        taken = np.einsum("kjj->kj", rows[:, 0] - rows[:, 1])
        ends = self.rates(np.repeat(times, 2 * n), rows.reshape(-1, n)).reshape(rows.shape)
        return np.swapaxes((ends[:, 0] - ends[:, 1]) / taken[:, :, None], 1, 2)

    def jacobian_errors(
        self, times: FloatArray, states: FloatArray, jacobians: FloatArray
    ) -> FloatArray:
        """Errors (K, n, n) of `jacobians` (K, n, n), as far as one difference a row shows them.

        Along one direction in general position, over twice the step: what the derivative and the
        difference are apart, of each rate, is laid to each of its derivatives.
        """
        if self.has_derivative:
            size = np.abs(jacobians).max(axis=(1, 2), keepdims=True)
            own = np.broadcast_to(_ROUND_OFF * _EPS * size, jacobians.shape)
            if not isinstance(self.model, HasCoarser):
                return own
            # One that the model makes by differences: those over twice its steps tell.
            coarser = replace(self, model=self.model.coarser())
            apart = np.abs(coarser.jacobians(times, states) - jacobians)
            return np.asarray(own + _COARSER * apart.max(axis=2, keepdims=True))
        direction = _direction(states.shape)
        # A step grows fourfold in truncation when it doubles, so that what differences of the
        # single step are off by is a third of what is seen.
        (seen,) = self._along(times, states, direction, (2 * _STEP,))
        gap = np.abs(seen - np.einsum("kij,kj->ki", jacobians, direction))
        noise = _EPS / _STEP * np.abs(self.rates(times, states)).max(axis=1, keepdims=True)
        return np.broadcast_to((gap + noise)[:, :, None], jacobians.shape)

    def derivative_gap(self, times: FloatArray, states: FloatArray) -> float:
        """By how much the model's own derivative contradicts differences; 0 if it does not.

        At some of the instants, along one direction in general position, over shorter steps where
        the right-hand side bends within longer ones.
        """
        if not self.has_derivative:
            return 0.0
        # Some instants: a derivative that is wrong is seldom so at a few of them alone.
        some = slice(None, None, max(1, len(times) // _INSTANTS_CHECKED))
        times, states = times[some], states[some]
        direction = _direction(states.shape)
        claimed = np.einsum("kij,kj->ki", self.jacobians(times, states), direction)
        size = 1.0 + float(np.abs(claimed).max())
        rates = float(np.abs(self.rates(times, states)).max())
        apart = 0.0
        for step in _CHECKING_STEPS:
            near, far = self._along(times, states, direction, (step, 2 * step))
            gap = np.abs((4 * near - far) / 3 - claimed)
            truncation = np.abs(near - far)
            # Richardson's extrapolation is off by about the square of what it takes off.
            extrapolated = truncation * np.minimum(1.0, 10 * truncation / size)
            noise = _EPS * (rates + size) / step
            if (gap > _MARGIN * (extrapolated + noise)).any():
                apart = max(apart, float(gap.max()))
            elif truncation.max() <= _SHARP * size:
                return 0.0
        return apart

    def _along(
        self, times: FloatArray, states: FloatArray, direction: FloatArray, steps: Sequence[float]
    ) -> FloatArray:
        """Central differences (S, K, n) along a direction (K, n), over steps (S,)."""
        lengths = np.array(steps)[:, None]
        sides = np.stack([lengths, -lengths], axis=1)
        rows = states[:, None, None] + sides * direction[:, None, None]
        found = self.rates(np.repeat(times, sides.size), rows.reshape(-1, states.shape[1]))
        ahead, back = np.moveaxis(found.reshape(rows.shape), 2, 0)
        return np.swapaxes((ahead - back) / (2 * lengths), 0, 1)


@lru_cache(maxsize=16)
def _direction(shape: tuple[int, int]) -> FloatArray:
    """Unit vectors (K, n) in general position."""
    direction = np.random.default_rng(0).standard_normal(shape)
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    direction.flags.writeable = False
    return direction
