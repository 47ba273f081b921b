"""A model made of any right-hand side dx/dt = f(t, x)."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Self, cast

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError, StateError
from birdmb.orbits.integration import SOLVERS, Integration, Integrator
from birdmb.summary import Fact, Summarised, shortened

Rhs = Callable[[float, FloatArray], npt.ArrayLike]

# Near eps**(1/5), the best step of the four-point difference.
_STENCIL_STEP = 1e-3
# Part of a slope by which differences over a step and over twice as much may part; a tenth of its
# square is what their extrapolation is off by, and smooth functions stay far below it.
_BENDING = 1e-4
_SHORTER, _SHORTENINGS = 30.0, 8
# By default the absolute tolerance of a state is this part of the relative one, of its size.
_ABSOLUTE_PART = 1e-2
# Whose reciprocal and tolerance are still normal numbers.
_SMALLEST_SIZE = 1e-200
# Below 100 eps scipy's integrators replace the tolerance.
_RTOL_RANGE = (2.3e-14, 1e-2)


@dataclass(frozen=True, repr=False)
class Trajectory(Summarised):
    """A solution at given times: `times` (k,) in s, `states` (k, n) in the units of the states."""

    times: FloatArray
    states: FloatArray


class OdeModel(Summarised):
    """Flow, variational equations and divergence of dx/dt = rhs(t, x).

    Integrated by default by DOP853 (Hairer, Norsett & Wanner 1993, Dormand-Prince of order 8 with
    step control). The Jacobian of the flow solves the variational equations dPhi/dt = J(t, x) Phi
    along with the state, under the same error control. Where `jacobian` is not given, J is a
    four-point central difference of `rhs` over a thousandth of the typical sizes of the states, or
    less where `rhs` bends within that: relative error about 1e-12, exact for polynomials up to
    degree 4.

    The variational equations hold for a smooth right-hand side. Where it jumps they leave out what
    the jump does to neighbours (saltation); `floquet` and `find_limit_cycle` notice by differences
    of the flow and widen the error bars.
    """

    @checked
    def __init__(
        self,
        rhs: Rhs,
        state_names: Sequence[str],
        period: float | None = None,
        jacobian: Rhs | None = None,
        *,
        guess: npt.ArrayLike | None = None,
        state_scale: npt.ArrayLike | None = None,
        integrator: Integrator = "DOP853",
        rtol: float = 1e-11,
        atol: npt.ArrayLike | None = None,
        most_steps: int = 20_000,
    ) -> None:
        """Describe the system.

        Args:
            rhs: function of (t, x) that returns dx/dt, n values.
            state_names: names of the n states.
            period: period of the forcing in s; `None` if rhs does not depend on t.
            jacobian: function of (t, x) that returns d rhs/dx, (n, n).
            guess: state (n,) near the orbit, where a search starts if it is given no other.
            state_scale: typical sizes of the states, (n,), which size tolerances and difference
                steps. By default a search takes them from the solution through its guess; a flow on
                its own takes the largest entry of its first state for all.
            integrator: "DOP853", or "LSODA" or "Radau" for a stiff system.
            rtol: relative tolerance of the integration.
            atol: absolute tolerance, one value or one per state, in the units of the states; by
                default rtol/100 of the typical sizes.
            most_steps: number of steps after which one integration is given up.

        Raises:
            ArgumentError: a period that is not positive, an unknown integrator, or a guess, scale
                or tolerance that does not fit the number of states or is not positive and finite.
        """
        self.state_names = tuple(state_names)
        n = len(self.state_names)
        if n == 0:
            raise ArgumentError("a model needs at least one state; state_names is empty.")
        if period is not None and not 0 < period < np.inf:
            raise ArgumentError(f"period must be positive and finite, or None, not {period}.")
        if integrator not in SOLVERS:
            names = ", ".join(f'"{name}"' for name in SOLVERS)
            raise ArgumentError(f'integrator must be one of {names}, not "{integrator}".')
        low, high = _RTOL_RANGE
        if not low <= rtol <= high:
            raise ArgumentError(f"rtol must be from {low:g} to {high:g}, not {rtol}.")
        if most_steps < 1:
            raise ArgumentError(f"most_steps must be at least 1, not {most_steps}.")
        self.period = period
        self._rhs = rhs
        self._jacobian = jacobian
        self._guess = _per_state("guess", guess, n)
        self._scale = _per_state("state_scale", state_scale, n, positive=True)
        if atol is not None and np.ndim(atol) == 0:
            atol = np.full(n, atol)
        self._atol = _per_state("atol", atol, n, positive=True)
        self._integration = Integration(integrator, rtol, most_steps)
        self._stencil = _STENCIL_STEP

    def _summary(self) -> Iterator[Fact]:
        yield Fact("states", shortened(", ".join(self.state_names)))
        yield Fact("period", "unknown" if self.period is None else f"{self.period:.6g} s")
        yield Fact("integrator", self._integration.integrator)

    def scaled_to(self, scale: FloatArray) -> Self:
        """The same system with typical sizes (n,) for its states, if it was not given its own."""
        if self._scale is not None:
            return self
        other = copy.copy(self)
        other._scale = np.array(scale, float)
        return other

    def coarser(self) -> Self:
        """The same system with ten times the tolerances and twice the steps of differences.

        What changes is a bound of the errors that the integration and the differences leave here.
        """
        other = copy.copy(self)
        rtol = 10 * self._integration.rtol
        other._integration = replace(self._integration, rtol=rtol)
        other._atol = None if self._atol is None else 10 * self._atol
        other._stencil = 2 * self._stencil
        return other

    @property
    def flow_accuracy(self) -> float:
        """Relative error of the flow: local tolerances add up over the steps of a segment."""
        accuracy = self._integration.rtol
        if self._atol is not None and self._scale is not None:
            accuracy += float((self._atol / self._scale).max())
        return 10 * accuracy

    def rhs(self, t: float, x: FloatArray) -> FloatArray:
        """Time derivative of the state, (n,)."""
        return self._evaluate("rhs", self._rhs, t, x, (len(self.state_names),))

    def jacobian(self, t: float, x: FloatArray) -> FloatArray:
        """Derivative of the right-hand side with respect to the state, (n, n)."""
        n = len(self.state_names)
        if self._jacobian is not None:
            return self._evaluate("jacobian", self._jacobian, t, x, (n, n))
        steps = self._stencil * np.maximum(np.abs(x), self._sizes(x))
        return np.stack([self._slope(t, x, j, h) for j, h in enumerate(steps)], axis=1)

    def _slope(self, t: float, x: FloatArray, j: int, step: float) -> FloatArray:
        """Derivative (n,) of the right-hand side with respect to state j.

        Over `step`, or less where the right-hand side bends within it: over the longest one, each
        thirty times shorter, at which differences over it and over twice as much agree. Where none
        does, at a jump for instance, over `step`.
        """
        first, steepest = None, 0.0
        for shortening in range(_SHORTENINGS):
            shift = np.zeros_like(x)
            shift[j] = step / _SHORTER**shortening
            near = (self.rhs(t, x + shift) - self.rhs(t, x - shift)) / (2 * shift[j])
            far = (self.rhs(t, x + 2 * shift) - self.rhs(t, x - 2 * shift)) / (4 * shift[j])
            slope = (4 * near - far) / 3
            scaled = np.abs([near - far, near, far]) / self._sizes(x)
            # Where terms cancel, the slope itself is no measure.
            steepest = max(steepest, float(scaled[1:].max()))
            if scaled[0].max() <= _BENDING * steepest:
                return slope
            first = slope if first is None else first
        return cast("FloatArray", first)

    def initial_guess(self) -> FloatArray:
        """State (n,) given as `guess`; raises ArgumentError if there was none."""
        if self._guess is None:
            raise ArgumentError("this model was made without a guess; pass one to the search.")
        return self._guess

    @property
    def state_scale(self) -> FloatArray | None:
        """Typical sizes (n,), or `None` where the search is to find them."""
        return self._scale

    def flow(self, x0: FloatArray, t0: float, t1: float) -> FloatArray:
        """State (n,) at t1 from x0 at t0; StateError if the solution does not reach t1."""
        end: FloatArray = self._integrate(self.rhs, x0, t0, t1)[-1]
        return end

    def trajectory(
        self, x0: FloatArray, t0: float, t1: float, times: FloatArray | None = None
    ) -> Trajectory:
        """Solution at `times` in [t0, t1] (default: 201 even ones), from one integration."""
        at = np.linspace(t0, t1, 201) if times is None else np.asarray(times, float)
        return Trajectory(at, self._integrate(self.rhs, x0, t0, t1, times=at))

    def flow_jacobian(self, x0: FloatArray, t0: float, t1: float) -> tuple[FloatArray, FloatArray]:
        """State (n,) at t1 and its derivative with respect to x0, (n, n)."""
        n = len(x0)

        def variational(t: float, y: FloatArray) -> FloatArray:
            x = y[:n]
            tangent = self.jacobian(t, x) @ y[n:].reshape(n, n)
            return np.concatenate([self.rhs(t, x), tangent.ravel()])

        # d x_i / d x_j has the unit of x_i over that of x_j; so has its absolute tolerance.
        tangent_tolerance = np.outer(self._tolerances(x0), 1 / self._sizes(x0))
        start = np.concatenate([x0, np.eye(n).ravel()])
        end = self._integrate(variational, start, t0, t1, tangent_tolerance.ravel())[-1]
        return end[:n], end[n:].reshape(n, n)

    def divergence_integral(self, x0: FloatArray, t0: float, t1: float) -> float:
        """Integral of trace(d rhs/dx) along the solution: ln det of its flow Jacobian."""
        n = len(x0)

        def extended(t: float, y: FloatArray) -> FloatArray:
            return np.append(self.rhs(t, y[:n]), np.trace(self.jacobian(t, y[:n])))

        further = np.array([self._integration.rtol])
        return float(self._integrate(extended, np.append(x0, 0.0), t0, t1, further)[-1, n])

    def _integrate(
        self,
        function: Callable[[float, FloatArray], FloatArray],
        start: FloatArray,
        t0: float,
        t1: float,
        further_atol: FloatArray | None = None,
        times: FloatArray | None = None,
    ) -> FloatArray:
        """Values (k, n + m) of the states and of m further unknowns with their own tolerances."""
        atol = self._tolerances(start[: len(self.state_names)])
        if further_atol is not None:
            atol = np.concatenate([atol, further_atol])
        return self._integration.run(function, np.asarray(start, float), t0, t1, atol, times)

    def _tolerances(self, x: FloatArray) -> FloatArray:
        if self._atol is not None:
            return self._atol
        return _ABSOLUTE_PART * self._integration.rtol * self._sizes(x)

    def _sizes(self, x: FloatArray) -> FloatArray:
        if self._scale is not None:
            return self._scale
        # A size for each state would chase the round-off of one that is at rest.
        largest = float(np.abs(x).max())
        return np.full(len(x), largest if largest > _SMALLEST_SIZE else 1.0)

    def _evaluate(
        self, name: str, function: Rhs, t: float, x: FloatArray, shape: tuple[int, ...]
    ) -> FloatArray:
        try:
            values = np.asarray(function(t, x))
        except (ArithmeticError, ValueError) as error:
            raise StateError(f"{name} fails at t = {t:.6g}: {error}") from error
        if values.shape != shape or values.dtype.kind not in "fiub":
            raise ArgumentError(
                f"{name} must return real values of shape {shape} for the states "
                f"{', '.join(self.state_names)}, not {values.dtype} of shape {values.shape}."
            )
        return values.astype(float)


def _per_state(
    name: str, values: npt.ArrayLike | None, n: int, positive: bool = False
) -> FloatArray | None:
    if values is None:
        return None
    array = np.array(values, float)
    if array.shape != (n,):
        raise ArgumentError(f"{name} has shape {array.shape}; the {n} states need shape ({n},).")
    if not np.isfinite(array).all() or (positive and not (array > 0).all()):
        kind = "positive and finite" if positive else "finite"
        raise ArgumentError(f"{name} must hold {kind} values, not {values}.")
    return array
