"""A model made of any right-hand side dx/dt = f(t, x)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.orbits.errors import ArgumentError

Rhs = Callable[[float, FloatArray], npt.ArrayLike]

# Near eps**(1/5), the best step of the four-point difference.
_STENCIL_STEP = 1e-3


@dataclass(frozen=True)
class Trajectory:
    """A solution at given times: `times` (k,) in s, `states` (k, n) in the units of the states."""

    times: FloatArray
    states: FloatArray


class OdeModel:
    """Flow, variational equations and divergence of dx/dt = rhs(t, x).

    Integrated by default by DOP853 (Hairer, Norsett & Wanner 1993, Dormand-Prince of order 8 with
    step control). The Jacobian of the flow solves the variational equations dPhi/dt = J(t, x) Phi
    along with the state, under the same error control. Where `jacobian` is not given, J is a
    four-point central difference of `rhs`: relative error about 1e-12, exact for polynomials up to
    degree 4.
    """

    def __init__(
        self,
        rhs: Rhs,
        state_names: Sequence[str],
        period: float | None = None,
        jacobian: Rhs | None = None,
        *,
        guess: npt.ArrayLike | None = None,
        state_scale: npt.ArrayLike | None = None,
        integrator: Literal["DOP853", "LSODA", "Radau"] = "DOP853",
        rtol: float = 1e-11,
        atol: npt.ArrayLike = 1e-13,
    ) -> None:
        """Describe the system.

        Args:
            rhs: function of (t, x) that returns dx/dt, n values.
            state_names: names of the n states.
            period: period of the forcing in s; `None` if rhs does not depend on t.
            jacobian: function of (t, x) that returns d rhs/dx, (n, n).
            guess: state (n,) near the orbit, where a search starts if it is given no other.
            state_scale: typical sizes of the states, (n,); also sizes difference steps. By default
                the search takes them from the solution through its guess.
            integrator: method of scipy's `solve_ivp`; one of the others for a stiff system.
            rtol: relative tolerance of the integration.
            atol: absolute tolerance, one value or one per state, in the units of the states.

        Raises:
            ArgumentError: a period that is not positive, or a guess, scale or tolerance that does
                not fit the number of states.
        """
        self.state_names = tuple(state_names)
        n = len(self.state_names)
        if period is not None and not period > 0:
            raise ArgumentError(f"period must be positive or None, not {period}.")
        for name, value in (("guess", guess), ("state_scale", state_scale)):
            if value is not None and np.shape(value) != (n,):
                raise ArgumentError(
                    f"{name} has shape {np.shape(value)}; the {n} states need shape ({n},)."
                )
        if np.shape(atol) not in {(), (n,)}:
            raise ArgumentError(f"atol must be one value or {n} values, one per state.")
        self.period = period
        self.flow_accuracy = 10 * rtol  # local tolerances add up over the steps of a segment
        self._rhs = rhs
        self._jacobian = jacobian
        self._guess = None if guess is None else np.array(guess, float)
        self._scale = None if state_scale is None else np.array(state_scale, float)
        self._integrator = integrator
        self._rtol = rtol
        self._atol = np.broadcast_to(np.asarray(atol, float), (n,))

    def rhs(self, t: float, x: FloatArray) -> FloatArray:
        """Time derivative of the state, (n,)."""
        return np.asarray(self._rhs(t, x), float)

    def jacobian(self, t: float, x: FloatArray) -> FloatArray:
        """Derivative of the right-hand side with respect to the state, (n, n)."""
        if self._jacobian is not None:
            return np.asarray(self._jacobian(t, x), float)
        size = np.ones_like(x) if self._scale is None else self._scale
        step = _STENCIL_STEP * np.maximum(np.abs(x), size)
        columns = []
        for shift in np.diag(step):
            near = self.rhs(t, x + shift) - self.rhs(t, x - shift)
            far = self.rhs(t, x + 2 * shift) - self.rhs(t, x - 2 * shift)
            columns.append((8 * near - far) / (12 * shift.sum()))
        return np.stack(columns, axis=1)

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
        end: FloatArray = self._integrate(self.rhs, x0, t0, t1, self._atol)[-1]
        return end

    def trajectory(
        self, x0: FloatArray, t0: float, t1: float, times: FloatArray | None = None
    ) -> Trajectory:
        """Solution at `times` in [t0, t1] (default: 201 even ones), from one integration."""
        at = np.linspace(t0, t1, 201) if times is None else np.asarray(times, float)
        return Trajectory(at, self._integrate(self.rhs, x0, t0, t1, self._atol, at))

    def flow_jacobian(self, x0: FloatArray, t0: float, t1: float) -> tuple[FloatArray, FloatArray]:
        """State (n,) at t1 and its derivative with respect to x0, (n, n)."""
        n = len(x0)

        def variational(t: float, y: FloatArray) -> FloatArray:
            x = y[:n]
            tangent = self.jacobian(t, x) @ y[n:].reshape(n, n)
            return np.concatenate([self.rhs(t, x), tangent.ravel()])

        # d x_i / d x_j has the unit of x_i over that of x_j; so has its absolute tolerance.
        size = np.ones(n) if self._scale is None else self._scale
        atol = np.concatenate([self._atol, np.outer(self._atol, 1 / size).ravel()])
        start = np.concatenate([x0, np.eye(n).ravel()])
        end = self._integrate(variational, start, t0, t1, atol)[-1]
        return end[:n], end[n:].reshape(n, n)

    def divergence_integral(self, x0: FloatArray, t0: float, t1: float) -> float:
        """Integral of trace(d rhs/dx) along the solution: ln det of its flow Jacobian."""
        n = len(x0)

        def extended(t: float, y: FloatArray) -> FloatArray:
            return np.append(self.rhs(t, y[:n]), np.trace(self.jacobian(t, y[:n])))

        atol = np.append(self._atol, self._rtol)
        return float(self._integrate(extended, np.append(x0, 0.0), t0, t1, atol)[-1, n])

    def _integrate(
        self,
        function: Callable[[float, FloatArray], FloatArray],
        start: FloatArray,
        t0: float,
        t1: float,
        atol: FloatArray,
        times: FloatArray | None = None,
    ) -> FloatArray:
        # A solution that runs away overflows before the integrator gives up; StateError says it.
        with np.errstate(all="ignore"):
            solution = solve_ivp(
                function,
                (t0, t1),
                start,
                method=self._integrator,
                t_eval=[t1] if times is None else times,
                rtol=self._rtol,
                atol=atol,
            )
        states = np.asarray(solution.y, float).T
        if not solution.success or not np.isfinite(states).all():
            reached = solution.t[-1] if len(solution.t) else t0
            raise StateError(
                f"The integration from t = {t0:.6g} to {t1:.6g} failed after t = {reached:.6g}: "
                f"{solution.message}"
            )
        return states
