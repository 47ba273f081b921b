"""What the orbit toolbox asks of a model: three members are needed, the others are used if present.

A model is any object that satisfies `Model`. Each optional protocol below adds one ability; nothing
needs to be inherited.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Protocol, TypeVar, runtime_checkable

import numpy as np

from birdmb._typing import FloatArray

CycleT_co = TypeVar("CycleT_co", covariant=True)


@runtime_checkable
class Model(Protocol):
    """A flow with named states.

    `period` is the period of the forcing in s, or `None` for an autonomous system, whose cycles
    have an unknown period. `flow(x0, t0, t1)` returns the state (n,) at `t1` of the solution
    through `x0` (n,) at `t0`; it raises `StateError`, or returns non-finite values, where the model
    has no meaning. Use with a process pool requires the model to be picklable.
    """

    @property
    def state_names(self) -> tuple[str, ...]:
        """Names of the n states."""

    @property
    def period(self) -> float | None:
        """Forcing period in s, `None` if autonomous."""

    def flow(self, x0: FloatArray, t0: float, t1: float, /) -> FloatArray:
        """State at t1."""


@runtime_checkable
class VariationalModel(Protocol):
    """The model differentiates its own flow."""

    def flow_jacobian(self, x0: FloatArray, t0: float, t1: float) -> tuple[FloatArray, FloatArray]:
        """State at t1, (n,), and its derivative with respect to x0, (n, n)."""


@runtime_checkable
class HasRhs(Protocol):
    """The model has a right-hand side dx/dt = rhs(t, x)."""

    def rhs(self, t: float, x: FloatArray, /) -> FloatArray:
        """Time derivative of the state, (n,)."""


@runtime_checkable
class HasRates(Protocol):
    """The model evaluates its right-hand side at many instants in one call."""

    def rates(self, times: FloatArray, states: FloatArray, /) -> FloatArray:
        """Time derivatives (K, n) at `times` (K,) of `states` (K, n)."""


@runtime_checkable
class HasJacobian(Protocol):
    """The model differentiates its right-hand side."""

    def jacobian(self, t: float, x: FloatArray, /) -> FloatArray:
        """Derivative (n, n) of the right-hand side with respect to the state."""


@runtime_checkable
class HasRateJacobians(Protocol):
    """The model differentiates its right-hand side at many instants in one call."""

    def rate_jacobians(self, times: FloatArray, states: FloatArray, /) -> FloatArray:
        """Derivatives (K, n, n) of the rates with respect to `states` (K, n), at `times` (K,)."""


@runtime_checkable
class HasGuessedPath(Protocol):
    """The model proposes a closed path near its orbit without integrating."""

    def guess_along(self, times: FloatArray, /) -> FloatArray:
        """States (K, n) at `times` (K,)."""


@runtime_checkable
class HasStartingPaths(Protocol):
    """The model proposes closed paths from which a search may find its orbits, all of them."""

    def starting_paths(self, times: FloatArray, /) -> Iterable[FloatArray]:
        """States (K, n) along paths at `times` (K,), spread evenly; the best start first."""


@runtime_checkable
class KnowsRepetition(Protocol):
    """The model knows in which times its right-hand side repeats, without an evaluation."""

    def repeats_after(self, duration: float, /) -> bool:
        """Whether it surely repeats after `duration` (s); where not, evaluations may tell."""


@runtime_checkable
class HasStatePeriods(Protocol):
    """The model has states, such as angles, that mean the same a period of theirs further on."""

    @property
    def state_periods(self) -> FloatArray:
        """Periods (n,) in the units of the states; infinite of those that do not repeat."""


@runtime_checkable
class HasDivergence(Protocol):
    """The model integrates the divergence of its right-hand side (for Liouville's formula)."""

    def divergence_integral(self, x0: FloatArray, t0: float, t1: float, /) -> float:
        """Integral of trace(d rhs/dx) along the solution from t0 to t1."""


@runtime_checkable
class HasInitialGuess(Protocol):
    """The model proposes a state near its orbit."""

    def initial_guess(self) -> FloatArray:
        """State (n,) at the start time."""


@runtime_checkable
class HasStateScale(Protocol):
    """The model knows the typical sizes of its states."""

    @property
    def state_scale(self) -> FloatArray | None:
        """Typical sizes, (n,), positive, in the units of the states; `None` to have them found."""


@runtime_checkable
class HasStateUnits(Protocol):
    """The model names the units of its states."""

    @property
    def state_units(self) -> tuple[str, ...]:
        """One unit per state."""


@runtime_checkable
class Scalable(Protocol):
    """The model takes typical sizes of its states, for its tolerances and difference steps."""

    def scaled_to(self, scale: FloatArray, /) -> Model:
        """The same system with typical sizes (n,), or itself if it has its own."""


@runtime_checkable
class HasCoarser(Protocol):
    """The model has a less accurate version of itself, whose difference bounds its own errors."""

    def coarser(self) -> VariationalModel:
        """The same system, its flow and flow Jacobian some times less accurate."""


@runtime_checkable
class HasFlowAccuracy(Protocol):
    """The model declares the relative accuracy of its flow and of its flow Jacobian."""

    @property
    def flow_accuracy(self) -> float:
        """Relative error, e.g. of the time integration."""


def flow_accuracy(model: Model) -> float:
    """Relative accuracy of the flow that a model declares, else round-off."""
    declared = model.flow_accuracy if isinstance(model, HasFlowAccuracy) else 0.0
    return max(float(np.finfo(float).eps), declared)


class HasStates(Protocol):
    """A solution at given times."""

    @property
    def states(self) -> FloatArray:
        """States, (number of times, n)."""


@runtime_checkable
class HasTrajectory(Protocol):
    """The model gives a whole solution in one integration."""

    def trajectory(
        self, x0: FloatArray, t0: float, t1: float, times: FloatArray | None = None
    ) -> HasStates:
        """Solution from t0 to t1 at `times`; the result has `.states` (len(times), n)."""


@runtime_checkable
class HasLimitCycleType(Protocol[CycleT_co]):
    """The model brings its own subclass of `LimitCycle`."""

    @property
    def limit_cycle_type(self) -> type[CycleT_co]:
        """The subclass."""


class ModelWithCycles(Model, HasLimitCycleType[CycleT_co], Protocol[CycleT_co]):
    """A model that brings its own subclass of `LimitCycle`; searches return such cycles of it."""
