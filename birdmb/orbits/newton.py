"""Newton's method and Levenberg-Marquardt's, both accepting only steps that reduce the residual."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, onenormest, splu
from scipy.sparse.linalg import norm as sparse_norm

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.orbits.errors import ArgumentError, ConvergenceError, SingularJacobianError

SolverMethod = Literal["newton", "levenberg-marquardt"]

_SHORTEST_DAMPING = 2.0**-12
_SUFFICIENT_DECREASE = 1e-4
# A Jacobian by differences costs 2 n flows, a trial one: an old one earns its keep if it still
# gains a digit.
_REUSE_DECREASE = 0.1
_SINGULAR_CONDITION = 1e14
# Differences leave a singular Jacobian regular by their noise; a failed search gives it away.
_SUSPECT_CONDITION = 1e8
_LARGEST_LM = 1e10


@dataclass(frozen=True)
class Iteration:
    """One accepted step of a search; number 0 is the guess.

    Attributes:
        number: steps taken so far.
        residual: Euclidean norm of the closure errors, in units of the state scale.
        step_length: Euclidean length of the step, in units of the state scale.
        damping: fraction of the Newton step taken, or the Levenberg-Marquardt parameter.
        x: state (n,) at the start of the orbit.
        period: period in s.
        jacobian_reused: the step was made with the Jacobian of an earlier point.
    """

    number: int
    residual: float
    step_length: float
    damping: float
    x: FloatArray
    period: float
    jacobian_reused: bool = False


class Equations(Protocol):
    """Square nonlinear equations in scaled unknowns u (N,)."""

    def residual(self, u: FloatArray) -> FloatArray:
        """Residual (N,); StateError where it is not defined."""

    def jacobian(self, u: FloatArray) -> sp.csc_array:
        """Derivative (N, N) of the residual."""

    @property
    def dear_jacobian(self) -> bool:
        """Whether a Jacobian costs many residuals, so that an old one is worth a try."""

    def start_and_period(self, u: FloatArray) -> tuple[FloatArray, float]:
        """State (n,) at the start and the period, for reports."""

    def closure(self, residual: FloatArray) -> float:
        """Largest closure error in the units of the states."""


@dataclass(frozen=True)
class _Point:
    u: FloatArray
    residual: FloatArray

    @property
    def norm(self) -> float:
        # A flow that all but blew up may return values whose squares overflow: no better for it.
        with np.errstate(over="ignore"):
            return float(np.linalg.norm(self.residual))


@dataclass(frozen=True)
class _Step:
    point: _Point
    damping: float
    reused: bool = False


def factorise(matrix: sp.csc_array) -> tuple[Callable[[FloatArray], FloatArray], float]:
    """Return the solver of a sparse LU factorisation and the condition number (1-norm estimate).

    LinAlgError if the matrix is singular to working precision. Entries are in scaled units, so the
    condition of a matrix that is small as a whole is taken against unit size.
    """
    try:
        lu, transposed = splu(matrix), splu(matrix.T.tocsc())
    except RuntimeError as error:  # SuperLU's word for an exact zero pivot
        raise np.linalg.LinAlgError from error
    inverse = LinearOperator(
        matrix.shape, matvec=lu.solve, rmatvec=transposed.solve, dtype=np.float64
    )
    condition = float(onenormest(inverse, t=1) * max(1.0, sparse_norm(matrix, 1)))
    if condition > _SINGULAR_CONDITION:
        raise np.linalg.LinAlgError
    return lu.solve, condition


def solve(
    equations: Equations,
    u: FloatArray,
    *,
    method: SolverMethod,
    tolerance: float,
    max_iterations: int,
    callback: Callable[[Iteration], None] | None = None,
) -> tuple[FloatArray, FloatArray, tuple[Iteration, ...]]:
    """Solve equations(u) = 0 from u.

    Newton: line search by halving on the Euclidean norm; where Jacobians are dear, a step with the
    previous one is tried first after a full step and kept only if it cuts the residual tenfold.
    Levenberg-Marquardt: the
    parameter is a factor times the residual norm (Fan & Yuan 2005), the factor adapted by success.

    Returns:
        The solution, its residual (norm at most `tolerance`) and the iterations.

    Raises:
        StateError: the residual is not defined at the guess.
        SingularJacobianError: Newton met a singular Jacobian.
        ConvergenceError: no step reduces the residual, or `max_iterations` were taken.
    """
    if method not in {"newton", "levenberg-marquardt"}:
        raise ArgumentError(f'method must be "newton" or "levenberg-marquardt", not "{method}".')
    point = _Point(u, equations.residual(u))
    stepper = _Newton(equations) if method == "newton" else _LevenbergMarquardt(equations)
    history: list[Iteration] = []

    def record(number: int, length: float, damping: float, reused: bool) -> None:
        x, period = equations.start_and_period(point.u)
        history.append(Iteration(number, point.norm, length, damping, x, period, reused))
        if callback is not None:
            callback(history[-1])

    def failure(kind: type[ConvergenceError], why: str, advice: str) -> ConvergenceError:
        x, period = equations.start_and_period(point.u)
        closure = equations.closure(point.residual)
        where = np.array2string(x, precision=6, max_line_width=1000)
        return kind(
            f"No orbit found: {why} after {len(history) - 1} iterations; the best closure error is "
            f"{closure:.3g} (goal {tolerance:.1g} of the state scale), at x0 = {where}, period "
            f"{period:.6g} s. {advice}",
            x,
            closure,
            history,
        )

    record(0, 0.0, 1.0, False)
    while history[-1].residual > tolerance:
        if len(history) > max_iterations:
            raise failure(
                ConvergenceError,
                "the iterations allowed were used up",
                "Allow more, or start from a closer guess or with more segments.",
            )
        try:
            step = stepper.advance(point)
        except StateError as error:
            raise failure(
                ConvergenceError,
                f"beside the point reached the flow fails ({error})",
                "The orbit may lie at the edge of what the model covers; start further inside.",
            ) from error
        except np.linalg.LinAlgError:
            raise failure(
                SingularJacobianError,
                "the shooting Jacobian became singular",
                "The orbit may be at a fold or one of a family; try levenberg-marquardt, another "
                "period or another guess.",
            ) from None
        if step is None:
            raise failure(
                ConvergenceError,
                "no step along the search direction reduces the closure error",
                "Try a closer guess, more segments or the other method; if the error is small "
                "already, the accuracy of the flow limits it: ask for a larger tolerance.",
            )
        length = float(np.linalg.norm(step.point.u - point.u))
        point = step.point
        record(len(history), length, step.damping, step.reused)
    return point.u, point.residual, tuple(history)


def _try(equations: Equations, u: FloatArray, below: float) -> _Point | None:
    try:
        point = _Point(u, equations.residual(u))
    except StateError:
        return None
    return point if point.norm < below else None


class _Newton:
    def __init__(self, equations: Equations) -> None:
        self._equations = equations
        self._solve: Callable[[FloatArray], FloatArray] | None = None

    def advance(self, point: _Point) -> _Step | None:
        if self._solve is not None:
            u = point.u - self._solve(point.residual)
            trial = _try(self._equations, u, _REUSE_DECREASE * point.norm)
            if trial is not None:
                return _Step(trial, 1.0, reused=True)
        self._solve, condition = factorise(self._equations.jacobian(point.u))
        direction = -self._solve(point.residual)
        damping = 1.0
        while damping >= _SHORTEST_DAMPING:
            below = (1 - _SUFFICIENT_DECREASE * damping) * point.norm
            trial = _try(self._equations, point.u + damping * direction, below)
            if trial is not None:
                if damping < 1 or not self._equations.dear_jacobian:
                    self._solve = None
                return _Step(trial, damping)
            damping /= 2
        if condition > _SUSPECT_CONDITION:
            raise np.linalg.LinAlgError
        return None


class _LevenbergMarquardt:
    def __init__(self, equations: Equations) -> None:
        self._equations = equations
        self._factor = 1e-2

    def advance(self, point: _Point) -> _Step | None:
        jacobian = self._equations.jacobian(point.u)
        n = len(point.u)
        right = np.concatenate([-point.residual, np.zeros(n)])
        while self._factor <= _LARGEST_LM:
            damping = self._factor * point.norm
            # The augmented form of the normal equations does not square the condition number.
            augmented = sp.block_array(
                [[sp.eye_array(n), jacobian], [jacobian.T, -damping * sp.eye_array(n)]],
                format="csc",
            )
            direction = splu(augmented).solve(right)[n:]
            below = (1 - _SUFFICIENT_DECREASE) * point.norm
            trial = _try(self._equations, point.u + direction, below)
            if trial is not None:
                self._factor = max(self._factor / 10, 1e-10)
                return _Step(trial, damping)
            self._factor *= 5
        return None
