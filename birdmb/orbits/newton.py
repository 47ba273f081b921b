"""Newton's method and Levenberg-Marquardt's, both accepting only steps that reduce the residual."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple, Protocol, get_args

import numpy as np
import scipy.sparse as sp
from scipy.linalg import lapack
from scipy.sparse.linalg import LinearOperator, onenormest, splu
from scipy.sparse.linalg import norm as sparse_norm

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError, StateError
from birdmb.orbits.errors import ConvergenceError, SingularJacobianError
from birdmb.orbits.iteration import Iteration

Damping = Literal["line-search", "levenberg-marquardt"]
Linear = Callable[[FloatArray], FloatArray]
# Sparse for shooting over many segments, dense for collocation.
Matrix = sp.csc_array | FloatArray

SHORTEST_DAMPING = 2.0**-12
_SUFFICIENT_DECREASE = 1e-4
# A Jacobian by differences costs 2 n flows, a trial one: updated steps earn their keep as long as
# each still takes away two thirds of the residual.
_REUSE_DECREASE = 1 / 3
_SINGULAR_CONDITION = 1e14
# Differences leave a singular Jacobian regular by their noise; a failed search gives it away.
_SUSPECT_CONDITION = 1e8
_LARGEST_LM = 1e10


class Equations(Protocol):
    """Square nonlinear equations in scaled unknowns u (N,)."""

    def residual(self, u: FloatArray) -> FloatArray:
        """Residual (N,); StateError where it is not defined."""

    def jacobian(self, u: FloatArray) -> Matrix:
        """Derivative (N, N) of the residual."""

    @property
    def expensive_jacobian(self) -> bool:
        """Whether a Jacobian costs many residuals, so that an old one is worth a try."""

    def start_and_period(self, u: FloatArray) -> tuple[FloatArray, float]:
        """State (n,) at the start and the period, for reports."""

    def closure(self, residual: FloatArray) -> float:
        """Largest closure error in the units of the states."""


class Solved(NamedTuple):
    """A solution of nonlinear equations.

    Attributes:
        u: unknowns (N,).
        residual: residual (N,) there.
        iterations: the steps that led to it.
        solve: solver of the linear equations that Newton's method took last, if it took any.
    """

    u: FloatArray
    residual: FloatArray
    iterations: tuple[Iteration, ...]
    solve: Linear | None


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


def factorise(matrix: Matrix) -> tuple[Linear, float]:
    """Return the solver of an LU factorisation and the condition number (1-norm estimate).

    LinAlgError if the matrix is singular to working precision. Entries are in scaled units, so the
    condition of a matrix that is small as a whole is taken against unit size.
    """
    if isinstance(matrix, np.ndarray):
        solver, condition = _factorise_dense(matrix)
    else:
        solver, condition = _factorise_sparse(matrix)
    if not condition <= _SINGULAR_CONDITION:
        raise np.linalg.LinAlgError
    return solver, condition


def _factorise_dense(matrix: FloatArray) -> tuple[Linear, float]:
    size = float(np.abs(matrix).sum(axis=0).max())
    lu, pivots, singular = lapack.dgetrf(matrix)
    if singular or not np.isfinite(size):
        raise np.linalg.LinAlgError
    reciprocal, _ = lapack.dgecon(lu, size)
    inverse_size = 1.0 / (reciprocal * size) if reciprocal > 0 else np.inf

    def solve_dense(right: FloatArray) -> FloatArray:
        return np.asarray(lapack.dgetrs(lu, pivots, right)[0])

    return solve_dense, inverse_size * max(1.0, size)


def _factorise_sparse(matrix: sp.csc_array) -> tuple[Linear, float]:
    try:
        lu, transposed = splu(matrix), splu(matrix.T.tocsc())
    except RuntimeError as error:  # SuperLU's word for an exact zero pivot
        raise np.linalg.LinAlgError from error
    inverse = LinearOperator(
        matrix.shape, matvec=lu.solve, rmatvec=transposed.solve, dtype=np.float64
    )
    condition = float(onenormest(inverse, t=1) * max(1.0, sparse_norm(matrix, 1)))
    return lu.solve, condition


def solve(
    equations: Equations,
    u: FloatArray,
    *,
    damping: Damping,
    tolerance: float,
    max_iterations: int,
    callback: Callable[[Iteration], None] | None = None,
    first_solver: Linear | None = None,
    shortest_damping: float = SHORTEST_DAMPING,
    enough: Callable[[FloatArray], float] = lambda _: 0.0,
) -> Solved:
    """Solve equations(u) = 0 from u.

    Line search: by halving, down to `shortest_damping`, on the Euclidean norm. Where Jacobians are
    dear, a step with the last one, updated from the steps since (Broyden 1965), is tried first and
    kept only if it cuts the residual to a third; `first_solver`, of the linear equations at a
    neighbouring solution for instance, is what the first such step takes. Levenberg-Marquardt: the
    parameter is a factor times the residual norm (Fan & Yuan 2005), the factor adapted by success;
    it takes no `first_solver`.

    The norm of the residual of what is returned is at most `tolerance`, or what is `enough` there.

    Raises:
        StateError: the residual is not defined at the guess.
        SingularJacobianError: Newton met a singular Jacobian.
        ConvergenceError: no step reduces the residual, or `max_iterations` were taken.
    """
    if damping not in get_args(Damping):
        choice = " or ".join(f'"{each}"' for each in get_args(Damping))
        raise ArgumentError(f'damping must be {choice}, not "{damping}".')
    point = _Point(u, equations.residual(u))
    stepper: _Newton | _LevenbergMarquardt = _LevenbergMarquardt(equations)
    if damping == "line-search":
        stepper = _Newton(equations, first_solver, shortest_damping)
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
    while history[-1].residual > max(tolerance, enough(point.u)):
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
                "the Jacobian became singular",
                "The orbit may be at a fold or one of a family; try levenberg-marquardt damping, "
                "another period or another guess.",
            ) from None
        if step is None:
            raise failure(
                ConvergenceError,
                "no step along the search direction reduces the closure error",
                "Try a closer guess, more segments or the other damping; if the error is small "
                "already, the accuracy of the flow limits it: ask for a larger tolerance.",
            )
        length = float(np.linalg.norm(step.point.u - point.u))
        point = step.point
        record(len(history), length, step.damping, step.reused)
    return Solved(point.u, point.residual, tuple(history), stepper.solve)


def _try(equations: Equations, u: FloatArray, below: float) -> _Point | None:
    try:
        point = _Point(u, equations.residual(u))
    except StateError:
        return None
    return point if point.norm < below else None


class _Newton:
    def __init__(
        self, equations: Equations, first_solver: Linear | None, shortest_damping: float
    ) -> None:
        self._equations, self._shortest = equations, shortest_damping
        self.solve = first_solver
        self._broyden: _Broyden | None = None
        if first_solver is not None and equations.expensive_jacobian:
            self._broyden = _Broyden(first_solver)

    def advance(self, point: _Point) -> _Step | None:
        if self._broyden is not None:
            step = self._broyden.step(point.residual)
            if step is not None:
                trial = _try(self._equations, point.u + step, _REUSE_DECREASE * point.norm)
                if trial is not None:
                    self._broyden.taken(step)
                    return _Step(trial, 1.0, reused=True)
            self._broyden = None
        solved, condition = factorise(self._equations.jacobian(point.u))
        self.solve = solved
        direction = -solved(point.residual)
        damping = 1.0
        while damping >= self._shortest:
            below = (1 - _SUFFICIENT_DECREASE * damping) * point.norm
            trial = _try(self._equations, point.u + damping * direction, below)
            if trial is not None:
                if damping == 1 and self._equations.expensive_jacobian:
                    self._broyden = _Broyden(solved)
                    self._broyden.taken(direction)
                return _Step(trial, damping)
            damping /= 2
        if condition > _SUSPECT_CONDITION:
            raise np.linalg.LinAlgError
        return None


class _Broyden:
    """Quasi-Newton steps from one factorised Jacobian, updated by the full steps taken since.

    The rank-one updates are applied to the steps themselves, which they are functions of, so that
    nothing is factorised anew (Kelley 1995, section 7.3).
    """

    def __init__(self, solved: Linear) -> None:
        self._solved = solved
        self._steps: list[FloatArray] = []

    def step(self, residual: FloatArray) -> FloatArray | None:
        """The next step; `None` where the updated Jacobian is singular."""
        try:
            step = -self._solved(residual)
        except np.linalg.LinAlgError:
            return None
        # An overflow is no step either.
        with np.errstate(all="ignore"):
            for before, after in itertools.pairwise(self._steps):
                step = step + after * (before @ step) / (before @ before)
            if self._steps:
                last = self._steps[-1]
                step = step / (1 - (last @ step) / (last @ last))
        return step if np.isfinite(step).all() else None

    def taken(self, step: FloatArray) -> None:
        """Learn from the residual that the next step is asked for at: this step led to it."""
        self._steps.append(step)


class _LevenbergMarquardt:
    solve = None

    def __init__(self, equations: Equations) -> None:
        self._equations = equations
        self._factor = 1e-2

    def advance(self, point: _Point) -> _Step | None:
        jacobian = sp.csc_array(self._equations.jacobian(point.u))
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
