"""Finding a periodic orbit by multiple shooting."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from contextlib import suppress
from typing import Literal

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError, StateError
from birdmb.orbits.agreement import jacobian_gaps
from birdmb.orbits.cycle import LimitCycle, cycle_type
from birdmb.orbits.errors import (
    ConvergenceError,
    EquilibriumError,
)
from birdmb.orbits.iteration import Iteration
from birdmb.orbits.linearisation import linearise
from birdmb.orbits.newton import Damping, Linear, factorise, solve
from birdmb.orbits.periodic import periodic_multipliers
from birdmb.orbits.periodicity import require_period
from birdmb.orbits.problem import HasInitialGuess, Model
from birdmb.orbits.scales import SAMPLES_PER_SEGMENT, declared_scale, lay_out, outgrown
from birdmb.orbits.segments import Segments, choose_jacobian, sample
from birdmb.orbits.shooting import ShootingEquations

# A cycle of less than this part of the state scale is the neighbourhood of an equilibrium.
SMALLEST_AMPLITUDE = 1e-5
_Found = tuple[ShootingEquations, FloatArray, FloatArray, tuple[Iteration, ...]]

# Each can shrink a state by 1e7.
MOST_RESCALINGS = 3


def search_by_shooting(
    model: Model,
    guess: npt.ArrayLike | None,
    *,
    period_guess: float | None,
    segments: int,
    start_time: float,
    damping: Damping,
    tolerance: float,
    max_iterations: int,
    jacobian: Literal["auto", "variational", "finite-differences"],
    jacobian_guess: npt.ArrayLike | None,
    executor: Executor | None,
    callback: Callable[[Iteration], None] | None,
    reason: str,
) -> LimitCycle:
    """Find a periodic orbit by multiple shooting; arguments and errors of `find_limit_cycle`.

    `reason` is why not by collocation.
    """
    autonomous, period = period_or_guess(model, period_guess)
    jacobian_method = choose_jacobian(model, jacobian)
    start = proposal(model) if guess is None else guess

    def search(
        points: FloatArray, period: float, scale: FloatArray, first: npt.ArrayLike | None = None
    ) -> _Found:
        work = Segments(model, scale, start_time, jacobian_method, executor)
        equations = ShootingEquations(work, period, autonomous)
        first_solver = _first_solver(equations, points, period, first)
        u = equations.pack(points, period)

        def solved(equations: ShootingEquations) -> _Found:
            found = solve(
                equations,
                u,
                damping=damping,
                tolerance=tolerance,
                max_iterations=max_iterations,
                callback=callback,
                first_solver=first_solver,
            )
            return equations, *found[:3]

        try:
            return solved(equations)
        except ConvergenceError as error:
            best = error.history[-1]
            if autonomous:
                _reject_equilibrium(work, best.x, best.period, error.residual, error.history)
            if not _misled(equations, best):
                raise
            if jacobian == "auto":
                # On the orbit that these lead to, the two are compared again.
                return equations, *solved(equations.by_differences())[1:]
            raise type(error)(
                f"{error} The variational equations contradict differences of the flow there: the "
                f"right-hand side jumps, or a Jacobian given to the model is wrong; take "
                f'jacobian="finite-differences".',
                error.best_x,
                error.residual,
                error.history,
            ) from error

    try:
        scale, points = lay_out(model, start, start_time, period, segments)
        require_period(model, points[0], scale, start_time, period)
        equations, u, residual, iterations = search(points, period, scale, jacobian_guess)
    except StateError as error:
        raise StateError(f"The search cannot start from this guess: {error}") from error
    if declared_scale(model) is None:
        for _ in range(MOST_RESCALINGS):
            points, period = equations.unpack(u)
            fitting = outgrown(equations.segments.scale, _along(equations.segments, points, period))
            if fitting is None:
                break
            # What round-off leaves of an orbit at rest need not close on a scale of its own.
            with suppress(ConvergenceError, StateError):
                equations, u, residual, further = search(points, period, fitting)
                iterations += further
    points, period = equations.unpack(u)
    if autonomous:
        closure = equations.closure(residual)
        _reject_equilibrium(equations.segments, points[0], period, closure, iterations)
    found = linearise(equations, points, period, periodic_multipliers, residual, jacobian == "auto")
    return cycle_type(model).of(found, iterations, method_reason=reason)


def _misled(equations: ShootingEquations, best: Iteration) -> bool:
    """Whether the variational equations are not the derivative of the flow at the point reached."""
    work = equations.segments
    if work.jacobian_method != "variational":
        return False
    points = best.x[None, :]
    try:
        factors, ends = work.jacobians(points, best.period), work.ends(points, best.period)
        return bool(jacobian_gaps(work, points, best.period, factors, ends).any())
    except StateError:
        return False


def _along(work: Segments, points: FloatArray, period: float) -> FloatArray:
    """States (k, n) along the orbit through `points` (M, n)."""
    grid = np.linspace(work.start, work.start + period, len(points) + 1)
    parts = np.arange(SAMPLES_PER_SEGMENT) / SAMPLES_PER_SEGMENT
    return np.concatenate(
        [
            sample(work.model, x, t0, t0 + (t1 - t0) * parts, t1)
            for x, t0, t1 in zip(points, grid[:-1], grid[1:], strict=True)
        ]
    )


def _first_solver(
    equations: ShootingEquations,
    points: FloatArray,
    period: float,
    guess: npt.ArrayLike | None,
) -> Linear | None:
    if guess is None:
        return None
    factors, (m, n) = np.array(guess, float), points.shape
    if factors.shape != (m, n, n) or not np.isfinite(factors).all():
        raise ArgumentError(
            f"jacobian_guess must hold finite values of shape ({m}, {n}, {n}), not of "
            f"{factors.shape}."
        )
    # A Jacobian that is singular says nothing about the equations at hand.
    with suppress(np.linalg.LinAlgError):
        return factorise(equations.assemble(points, period, factors))[0]
    return None


def period_or_guess(model: Model, period_guess: float | None) -> tuple[bool, float]:
    """Whether the model is autonomous, and its period or the guess of it in s.

    Raises:
        ArgumentError: a missing or superfluous guess.
    """
    if model.period is not None:
        if period_guess is not None:
            raise ArgumentError(
                f"period_guess is for autonomous systems; this one is forced with period "
                f"{model.period:.6g} s."
            )
        return False, float(model.period)
    if period_guess is None:
        raise ArgumentError("an autonomous system (period None) needs a period_guess.")
    if not 0 < period_guess < np.inf:
        raise ArgumentError(f"period_guess must be positive and finite, not {period_guess}.")
    return True, float(period_guess)


def proposal(model: Model) -> FloatArray:
    """The model's own guess (n,); ArgumentError if it has none."""
    if not isinstance(model, HasInitialGuess):
        raise ArgumentError("this model proposes no initial guess; pass one.")
    return model.initial_guess()


def _reject_equilibrium(
    work: Segments,
    x: FloatArray,
    period: float,
    closure: float,
    iterations: tuple[Iteration, ...],
) -> None:
    times = work.start + period * np.arange(SAMPLES_PER_SEGMENT) / SAMPLES_PER_SEGMENT
    try:
        path = sample(work.model, x, work.start, times, work.start + period)
    except StateError:
        return  # so unstable that it runs away within a period: no equilibrium does
    if float(np.abs((path - x) / work.scale).max()) > SMALLEST_AMPLITUDE:
        return
    raise at_equilibrium(x, period, closure, iterations)


def at_equilibrium(
    x: FloatArray, period: float, closure: float, iterations: tuple[Iteration, ...]
) -> EquilibriumError:
    """The error that says that a search ended on an equilibrium, at the state x (n,)."""
    where = np.array2string(x, precision=6, max_line_width=1000)
    return EquilibriumError(
        f"No cycle found: the search ended on an equilibrium, or at period zero, near {where} "
        f"(period {period:.3g} s) after {len(iterations) - 1} iterations; start further away from "
        f"the equilibrium, or with another period guess.",
        x,
        closure,
        iterations,
    )
