"""Finding a periodic orbit by Fourier collocation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError, OrbitError, StateError
from birdmb.orbits.collocated import linearise_collocated
from birdmb.orbits.collocation import CollocationEquations
from birdmb.orbits.cycle import LimitCycle, cycle_type
from birdmb.orbits.enough_nodes import FIRST_NODES, Collocated, collocate, fewer_nodes, more_nodes
from birdmb.orbits.errors import ConvergenceError, NotSmoothError
from birdmb.orbits.iteration import Iteration
from birdmb.orbits.newton import Damping
from birdmb.orbits.periodicity import require_period
from birdmb.orbits.piecewise import GAUSS, PiecewiseEquations, mesh_along, uniform
from birdmb.orbits.piecewise_search import PARTS, search_piecewise
from birdmb.orbits.problem import HasGuessedPath, Model
from birdmb.orbits.result import FloquetResult
from birdmb.orbits.right_hand_side import RightHandSide
from birdmb.orbits.scales import declared_scale, outgrown, sizes_along
from birdmb.orbits.segments import sample
from birdmb.orbits.shooting_search import (
    MOST_RESCALINGS,
    SMALLEST_AMPLITUDE,
    at_equilibrium,
    period_or_guess,
    proposal,
)
from birdmb.orbits.trigonometric import along_path, resampled, without_drift
from birdmb.threads import one_thread

# Fewer instants do not show a path: it is then flown from them.
FEWEST_INSTANTS = 9
# To begin with on a mesh: instants of a guessed path, and intervals of each part of it.
_GUESSED, _INTERVALS = 1025, 2
_Found = Collocated[CollocationEquations]
CycleT = TypeVar("CycleT", bound=LimitCycle)


@one_thread()
def search_by_collocation(
    model: Model,
    guess: npt.ArrayLike | FloquetResult | None,
    *,
    period_guess: float | None,
    start_time: float,
    damping: Damping,
    tolerance: float,
    accuracy: float,
    max_iterations: int,
    nodes: int | None,
    most_nodes: int,
    callback: Callable[[Iteration], None] | None,
) -> LimitCycle:
    """Find a periodic orbit; arguments and errors of `find_limit_cycle`.

    `most_nodes` is the number of nodes beyond which a `NotSmoothError` says that it is too rough.
    """
    if nodes is not None and not (nodes % 2 and 3 <= nodes <= most_nodes):
        raise ArgumentError(f"nodes must be odd and from 3 to {most_nodes}, not {nodes}.")
    if not np.isfinite(start_time):
        raise ArgumentError(f"start_time must be finite, not {start_time}.")
    autonomous, period = period_or_guess(model, period_guess)
    first = nodes or FIRST_NODES
    if nodes is None:
        first = min(max(FIRST_NODES, nodes_shown(guess)), most_nodes)
    path = guessed_path(model, guess, start_time, period, first)
    declared = declared_scale(model)
    scale = sizes_along(model, path, start_time, period) if declared is None else declared
    require_period(model, path[0], scale, start_time, period)

    def equations_on(scale: FloatArray, period: float, nodes: int) -> CollocationEquations:
        rhs = RightHandSide(model, scale)
        return CollocationEquations(rhs, start_time, period, autonomous, nodes)

    guessed = equations_on(scale, period, len(path))
    gap = guessed.derivative_gap(guessed.pack(path / scale, period))

    def search(path: FloatArray, period: float, scale: FloatArray) -> _Found:
        equations = equations_on(scale, period, len(path))
        if gap > 0:
            equations = equations.by_differences()
        return collocate(
            equations,
            equations.pack(path / scale, period),
            damping=damping,
            tolerance=tolerance,
            accuracy=accuracy,
            max_iterations=max_iterations,
            most_nodes=most_nodes,
            fixed=nodes is not None,
            callback=callback,
            path_of=CollocationEquations.path,
        )

    found = _on_enough_nodes(search, path, period, scale, most_nodes if nodes is None else first)
    iterations = found.iterations
    for _ in range(MOST_RESCALINGS if declared is None else 0):
        points, period = found.equations.unpack(found.u)
        path = points * scale
        fitting = outgrown(scale, path)
        if fitting is None:
            break
        scale = fitting
        found = search(path, period, scale)
        iterations += found.iterations
    _refuse_equilibrium(found, iterations)
    found = replace(found, iterations=iterations)
    return collocated_cycle(found, cycle_type(model), accuracy, gap)


def collocated_cycle(
    found: _Found, kind: type[CycleT], accuracy: float, derivative_gap: float = 0.0
) -> CycleT:
    """The cycle that was found, of the kind that its model names; see `linearise_collocated`."""
    return kind.of(
        linearise_collocated(found, accuracy, derivative_gap),
        found.iterations,
        nodes=found.equations.nodes,
        state_error=found.state_error,
    )


@one_thread()
def search_on_mesh(
    model: Model,
    guess: npt.ArrayLike | FloquetResult | None,
    failed: OrbitError | StateError,
    *,
    period_guess: float | None,
    start_time: float,
    damping: Damping,
    tolerance: float,
    accuracy: float,
    max_iterations: int,
    callback: Callable[[Iteration], None] | None,
) -> LimitCycle:
    """Find an orbit on a mesh, from what another search that `failed` came to or from the guess.

    Arguments and errors of `find_limit_cycle`.
    """
    autonomous, period = period_or_guess(model, period_guess)
    if isinstance(failed, NotSmoothError) and failed.path is not None:
        path = failed.path
        period = failed.history[-1].period if autonomous else period
    else:
        path = guessed_path(model, guess, start_time, period, _GUESSED)
    declared = declared_scale(model)
    scale = sizes_along(model, path, start_time, period) if declared is None else declared
    rhs = RightHandSide(model, scale)
    mesh = mesh_along(path / scale, uniform(_INTERVALS * PARTS))
    equations = PiecewiseEquations(rhs, start_time, period, autonomous, mesh)
    inside = equations.mesh[:-1, None] + equations.widths[:, None] * np.append(0.0, GAUSS)
    values = along_path(path / scale, inside.ravel()).reshape(*inside.shape, -1)
    u = equations.pack(values, period)
    gap = equations.derivative_gap(u)
    if gap > 0:
        equations = replace(equations, rhs=replace(rhs, by_differences=True))
    reason = str(failed).partition(" Take method=")[0]
    return search_piecewise(
        equations,
        u,
        damping=damping,
        tolerance=tolerance,
        accuracy=accuracy,
        max_iterations=max_iterations,
        reason=f"a mesh was taken: {reason}",
        derivative_gap=gap,
        callback=callback,
    )


def nodes_shown(guess: npt.ArrayLike | FloquetResult | None) -> int:
    """The odd number of nodes that a guess is good for; 0 where it tells of none."""
    if isinstance(guess, FloquetResult):
        shown = guess.nodes if isinstance(guess, LimitCycle) and guess.pieces is None else None
        return fewer_nodes(shown or 1)
    shape = () if guess is None else np.shape(guess)
    return shape[0] if len(shape) == 2 and shape[0] % 2 else 0


def guessed_path(
    model: Model,
    guess: npt.ArrayLike | FloquetResult | None,
    start_time: float,
    period: float,
    nodes: int,
) -> FloatArray:
    """States (nodes, n) along a closed path to start from.

    Raises:
        ArgumentError: the guess has the wrong shape or is not finite.
        StateError: the flow from the guess fails.
    """
    phases = np.arange(nodes) / nodes
    if isinstance(guess, FloquetResult):
        if guess.state_names != tuple(model.state_names):
            raise ArgumentError(
                f"the orbit given as guess has the states {', '.join(guess.state_names)}; this "
                f"model has {', '.join(model.state_names)}."
            )
        return guess.trajectory(guess.start_time + phases * guess.period).states
    if guess is None:
        if isinstance(model, HasGuessedPath):
            return np.asarray(model.guess_along(start_time + phases * period), float)
        guess = proposal(model)
    states, n = np.array(guess, float), len(model.state_names)
    if states.ndim not in {1, 2} or states.shape[-1] != n or states.size == 0:
        raise ArgumentError(
            f"the guess has shape {states.shape}; the states {', '.join(model.state_names)} need "
            f"({n},), or (K, {n}) for K even instants of the period."
        )
    if not np.isfinite(states).all():
        raise ArgumentError("the guess holds values that are not finite.")
    if states.ndim == 2 and len(states) >= FEWEST_INSTANTS:
        return states if nodes == len(states) else along_path(states, phases)
    return _flown(model, np.atleast_2d(states), start_time, period, phases)


def _flown(
    model: Model, starts: FloatArray, start_time: float, period: float, phases: FloatArray
) -> FloatArray:
    """Path (nodes, n) by the flow from `starts` (M, n) of M segments, made to close."""
    count = len(starts)
    grid = start_time + period * np.arange(count + 1) / count
    times = start_time + period * np.append(phases, 1.0)
    pieces = []
    for k, x in enumerate(starts):
        inside = (times >= grid[k]) & ((times < grid[k + 1]) | (k == count - 1))
        at = np.clip(times[inside], grid[k], grid[k + 1])
        pieces.append(sample(model, x, grid[k], at, grid[k + 1]))
    return without_drift(np.concatenate(pieces))


def _on_enough_nodes(
    search: Callable[[FloatArray, float, FloatArray], _Found],
    path: FloatArray,
    period: float,
    scale: FloatArray,
    most_nodes: int,
) -> _Found:
    """The solution from a path; on more nodes at first where there is none on few."""
    nodes = len(path)
    larger = more_nodes(more_nodes(nodes))
    try:
        return search(path, period, scale)
    except NotSmoothError:
        raise
    except (ConvergenceError, StateError) as first_error:
        if larger > most_nodes:
            raise
        try:
            return search(resampled(path, larger), period, scale)
        except (OrbitError, StateError):
            raise first_error from None


def _refuse_equilibrium(found: _Found, iterations: tuple[Iteration, ...]) -> None:
    if not found.equations.autonomous:
        return
    points, period = found.equations.unpack(found.u)
    if np.abs(points - points[0]).max() <= SMALLEST_AMPLITUDE:
        x = points[0] * found.equations.rhs.scale
        raise at_equilibrium(x, period, found.equations.closure(found.residual), iterations)
