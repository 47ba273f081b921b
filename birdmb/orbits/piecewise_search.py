"""Finding a periodic orbit that is not smooth by collocation on an adaptive mesh."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse.linalg import splu

from birdmb._typing import FloatArray
from birdmb.orbits.cycle import LimitCycle, cycle_type
from birdmb.orbits.errors import NotSmoothError, SingularJacobianError
from birdmb.orbits.iteration import Iteration
from birdmb.orbits.linearisation import trivial_mode
from birdmb.orbits.multipliers import Spectrum, paired_distances, product
from birdmb.orbits.newton import Damping, solve
from birdmb.orbits.periodic import periodic_multipliers
from birdmb.orbits.piecewise import (
    STAGES,
    PiecewiseEquations,
    PiecewisePath,
    parts_for,
    redistributed,
    split,
    uniform,
)
from birdmb.orbits.result import FloquetResult
from birdmb.orbits.shooting_search import SMALLEST_AMPLITUDE, at_equilibrium
from birdmb.threads import one_thread

# The period's parts that every mesh has for its first one; results are given at their borders.
PARTS = 16
_MOST_UNKNOWNS = 60_000
_ERROR_PER_CORRECTION = 2.0
_ERROR_PER_DIFFERENCE = 3.0
# Of the goal: what the meshes leave adds up from many intervals.
_MARGIN = 0.5
_MOST_MESHES = 20
_LEAST_CHANGE = 2.0
_COUNTS = 0.01  # part of the largest defect


@dataclass(frozen=True)
class _Solved:
    """A solution on a mesh, and what halving each interval makes of it."""

    equations: PiecewiseEquations
    u: FloatArray
    residual: FloatArray
    finer: PiecewiseEquations
    finer_u: FloatArray
    state_error: float
    defects: FloatArray


@one_thread()
def search_piecewise(
    equations: PiecewiseEquations,
    u: FloatArray,
    *,
    damping: Damping,
    tolerance: float,
    accuracy: float,
    max_iterations: int,
    reason: str,
    derivative_gap: float = 0.0,
    callback: Callable[[Iteration], None] | None = None,
) -> LimitCycle:
    """Solve on one mesh after another until the error of the states is below `accuracy`.

    Each is compared with the one that has every interval halved: a Newton step there tells the
    error, and the mismatch of slopes there which intervals leave it. The next mesh has more there.

    Args:
        equations: on the mesh to begin with.
        u: unknowns to begin with.
        damping: as all that follow, of `find_limit_cycle`.
        tolerance: residual accepted.
        accuracy: largest error of the states, in units of their scale.
        max_iterations: accepted steps on each mesh.
        reason: why the orbit is not taken as smooth.
        derivative_gap: as for `linearise_collocated`.
        callback: called with each iteration.

    Raises:
        StateError: the right-hand side fails at the guess.
        ConvergenceError: no solution on some mesh.
        NotSmoothError: the accuracy is not reached with the most unknowns allowed, or the states
            make the right-hand side jump.
        SingularJacobianError: the equations have no unique solution on a mesh.
        EquilibriumError: the search ended on an equilibrium.
    """
    history: list[Iteration] = []

    def record(iteration: Iteration) -> None:
        nodes = equations.intervals * STAGES
        history.append(replace(iteration, number=len(history), nodes=nodes))
        if callback is not None:
            callback(history[-1])

    for _ in range(_MOST_MESHES):
        goal = max(tolerance, equations.round_off(u))
        u, residual, _, _ = solve(
            equations,
            u,
            damping=damping,
            tolerance=goal,
            max_iterations=max_iterations,
            callback=record,
        )
        solved = _compared(equations, u, residual, history)
        if solved.state_error <= accuracy:
            _refuse_equilibrium(solved, history)
            _refuse_jumps_by_state(solved, history)
            return _cycle(solved, tuple(history), reason, derivative_gap)
        mesh = _refined(solved, accuracy)
        if mesh is None:
            break
        # With every interval halved the solution is known better.
        equations, u = solved.finer.on_mesh(mesh, solved.finer_u)
    x, _ = equations.start_and_period(u)
    raise NotSmoothError(
        f"The orbit is too rough for collocation on a mesh: with {equations.intervals} intervals "
        f"its error is still {solved.state_error:.1e} of the state scale (goal {accuracy:.1g}). "
        f'Take method="shooting", or a larger accuracy.',
        x,
        solved.state_error,
        history,
    )


def _refuse_jumps_by_state(solved: _Solved, history: list[Iteration]) -> None:
    """Raise `NotSmoothError` where multipliers would lack what a moving jump does to neighbours."""
    equations = solved.finer
    at = equations.jumps_by_state(solved.finer_u)
    if at is not None:
        x, _ = equations.start_and_period(solved.finer_u)
        raise NotSmoothError(
            f"The right-hand side jumps near t = {at:.6g} s where a state passes a threshold: "
            f"collocation finds the orbit, but not its multipliers, for neighbours jump at other "
            f'times. Take method="shooting".',
            x,
            solved.state_error,
            history,
        )


def _refuse_equilibrium(solved: _Solved, history: list[Iteration]) -> None:
    equations = solved.equations
    values, period = equations.unpack(solved.u)
    if equations.autonomous and np.abs(values - values[0, 0]).max() <= SMALLEST_AMPLITUDE:
        x = values[0, 0] * equations.rhs.scale
        raise at_equilibrium(x, period, equations.closure(solved.residual), tuple(history))


def _compared(
    equations: PiecewiseEquations, u: FloatArray, residual: FloatArray, history: list[Iteration]
) -> _Solved:
    """The solution with its error, by a Newton step on the mesh with every interval halved."""
    halves = split(equations.mesh, np.full(equations.intervals, 2))
    finer, start = equations.on_mesh(halves, u)
    try:
        linear = splu(finer.jacobian(start))
    except RuntimeError as error:  # SuperLU's word for an exact zero pivot
        x, _ = equations.start_and_period(u)
        raise SingularJacobianError(
            f"The collocation equations have no unique solution on {finer.intervals} intervals: "
            "the orbit may be at a fold or one of a family.",
            x,
            equations.closure(residual),
            history,
        ) from error
    step = -linear.solve(finer.residual(start))
    unseen = finer.unseen(start + step)
    hidden = linear.solve(finer.as_gaps(unseen))
    defects = np.abs(finer.mismatch(start)).max(axis=(1, 2)) * finer.widths
    beside = np.abs(unseen).max(axis=1)
    defects = np.maximum(defects, np.maximum(beside, np.roll(beside, 1)))
    return _Solved(
        equations,
        u,
        residual,
        finer,
        start + step,
        _ERROR_PER_CORRECTION * float(np.abs(step).max() + np.abs(hidden).max()),
        defects.reshape(-1, 2),
    )


def _refined(solved: _Solved, accuracy: float) -> FloatArray | None:
    """A mesh on which all intervals leave as much error; `None` if it would be too large."""
    defects, equations = solved.defects, solved.equations
    largest = defects.max(axis=1)
    goal = _MARGIN * accuracy / solved.state_error * float(largest.sum())
    # Those that leave next to nothing need no share of it.
    count = max(PARTS, int(np.count_nonzero(largest > _COUNTS * largest.max())))
    parts = parts_for(defects, goal / count)
    if parts.max() < _LEAST_CHANGE:
        parts = _LEAST_CHANGE * parts / parts.max()
    mesh = redistributed(equations.mesh, parts, uniform(PARTS))
    unknowns = (len(mesh) - 1) * (solved.u.size // equations.intervals)
    return mesh if unknowns <= _MOST_UNKNOWNS else None


def _cycle(
    solved: _Solved, history: tuple[Iteration, ...], reason: str, derivative_gap: float
) -> LimitCycle:
    """The limit cycle, its multipliers with errors that the finer mesh shows."""
    equations = solved.equations
    values, period = equations.unpack(solved.u)
    scale, model = equations.rhs.scale, equations.rhs.model
    factors, spectrum = _spectrum(equations, solved.u)
    _, finer = _spectrum(solved.finer, solved.finer_u, with_errors=False)
    apart = paired_distances(spectrum.multipliers, finer.multipliers)
    size = np.maximum(np.abs(spectrum.multipliers), np.finfo(float).tiny)
    typical = size * float((apart / np.maximum(size, 1.0)).max())
    errors = spectrum.errors + _ERROR_PER_DIFFERENCE * np.maximum(apart, typical)
    # Given at even instants, as those of other orbits are.
    borders = np.searchsorted(equations.mesh, uniform(PARTS)[:-1] - 1e-12)
    ends = np.append(borders[1:], equations.intervals)
    whole = np.array([product(factors[a:b]) for a, b in zip(borders, ends, strict=True)])
    points = values[borders, 0]
    velocity = equations.rates(values, period)[0, 0] * scale
    orbit = FloquetResult(
        model=model,
        x0=points[0] * scale,
        state_names=tuple(model.state_names),
        period=period,
        start_time=equations.start,
        points=points * scale,
        state_scale=scale,
        residual=equations.closure(solved.residual),
        monodromy=product(factors),
        segment_jacobians=whole,
        multipliers=spectrum.multipliers,
        multiplier_errors=errors,
        modes=spectrum.modes,
        left_modes=spectrum.left_modes,
        modes_along=spectrum.modes_along[borders],
        trivial_index=trivial_mode(spectrum, velocity * period, scale)
        if equations.autonomous
        else None,
        jacobian_method="variational" if equations.rhs.has_derivative else "finite-differences",
        jacobian_gap=derivative_gap,
    )
    return cycle_type(model).of(
        orbit,
        history,
        method_reason=reason,
        nodes=equations.intervals * STAGES,
        state_error=solved.state_error,
        pieces=PiecewisePath(equations.mesh, values * scale),
    )


def _spectrum(
    equations: PiecewiseEquations, u: FloatArray, *, with_errors: bool = True
) -> tuple[FloatArray, Spectrum]:
    """Transfer matrices (J, n, n) of the intervals in the states' units, and their spectrum."""
    values, period = equations.unpack(u)
    jacobians = equations.rate_jacobians(u)
    factors = equations.transfers(period, jacobians)
    errors = np.zeros_like(factors)
    if with_errors:
        n = factors.shape[-1]
        flat = equations.rhs.jacobian_errors(
            equations.times(period), values[:, 1:].reshape(-1, n), jacobians.reshape(-1, n, n)
        )
        of_rates = flat.reshape(jacobians.shape).mean(axis=1)
        # To first order an error of the derivative acts for the length of an interval.
        amount = np.maximum(np.abs(factors), np.eye(n))
        steps = (period * equations.widths)[:, None, None]
        errors = 0.5 * steps * (amount @ of_rates + of_rates @ amount)
    units = np.divide.outer(equations.rhs.scale, equations.rhs.scale)
    return factors * units, periodic_multipliers(
        factors * units, errors * units, equations.rhs.scale
    )
