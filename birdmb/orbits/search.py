"""Finding a periodic orbit from a guess, by the method that suits the model."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import replace
from typing import Literal, TypedDict, TypeVar, Unpack, overload

import numpy as np
import numpy.typing as npt

from birdmb.arguments import checked
from birdmb.errors import ArgumentError, OrbitError, StateError
from birdmb.orbits.collocation_search import (
    FEWEST_INSTANTS,
    search_by_collocation,
    search_on_mesh,
)
from birdmb.orbits.cycle import LimitCycle
from birdmb.orbits.errors import (
    NotSmoothError,
    require_tolerance,
)
from birdmb.orbits.iteration import Iteration
from birdmb.orbits.newton import Damping
from birdmb.orbits.problem import HasRates, HasRhs, Model, ModelWithCycles
from birdmb.orbits.result import FloquetResult
from birdmb.orbits.shooting_search import search_by_shooting

SearchMethod = Literal["auto", "collocation", "shooting"]
CycleT = TypeVar("CycleT", bound=LimitCycle)

TOLERANCE, ACCURACY = 1e-9, 1e-7
# An automatic choice goes on to shooting rather than to more nodes, or to more unknowns, than this.
_MOST_NODES_BY_CHOICE = 129
_MOST_UNKNOWNS_BY_CHOICE = 1000
_MOST_NODES = 1025
# What collocation left unfinished is a better guess than the one it began with, if it is this near.
NEAR = 0.01


class SearchOptions(TypedDict, total=False):
    """What `find_limit_cycle` takes besides model and guess."""

    method: SearchMethod
    period_guess: float | None
    start_time: float
    damping: Damping
    tolerance: float
    max_iterations: int
    nodes: int | None
    accuracy: float
    segments: int | None
    jacobian: Literal["auto", "variational", "finite-differences"]
    jacobian_guess: npt.ArrayLike | None
    executor: Executor | None
    callback: Callable[[Iteration], None] | None


@overload
def find_limit_cycle(
    model: ModelWithCycles[CycleT],
    guess: npt.ArrayLike | FloquetResult | None = ...,
    **options: Unpack[SearchOptions],
) -> CycleT: ...


@overload
def find_limit_cycle(
    model: Model,
    guess: npt.ArrayLike | FloquetResult | None = ...,
    **options: Unpack[SearchOptions],
) -> LimitCycle: ...


@checked
def find_limit_cycle(
    model: Model,
    guess: npt.ArrayLike | FloquetResult | None = None,
    *,
    method: SearchMethod = "auto",
    period_guess: float | None = None,
    start_time: float = 0.0,
    damping: Damping = "line-search",
    tolerance: float = TOLERANCE,
    max_iterations: int = 50,
    nodes: int | None = None,
    accuracy: float = ACCURACY,
    segments: int | None = None,
    jacobian: Literal["auto", "variational", "finite-differences"] = "auto",
    jacobian_guess: npt.ArrayLike | None = None,
    executor: Executor | None = None,
    callback: Callable[[Iteration], None] | None = None,
) -> LimitCycle:
    """Find a periodic orbit of a model and its Floquet multipliers.

    Three methods. Fourier collocation satisfies the right-hand side at N equidistant nodes of the
    period, by a trigonometric interpolant; N grows until the orbit's error is below `accuracy`.
    It is fast and accurate where the orbit is smooth, however unstable or stiff, and needs the
    model's `rhs` or `rates`. Collocation by polynomials on a mesh, which is refined where the orbit
    is rough, takes many more nodes and holds orbits with kinks and fast phases as accurately.
    Multiple shooting closes the model's own flow over M segments; it needs no smoothness.
    "collocation" is the first, and the second where that fails. "auto" takes the first where it
    can, then shooting, which is cheaper beside a rough orbit, and the mesh where shooting fails,
    too; `method_reason` of the result says why.

    Forced systems (`model.period` given): the states are unknown. Autonomous ones (`model.period`
    is `None`): so is the period. Only steps that reduce the residual are accepted. Where the state
    scale is taken from the guess and does not fit the orbit found, the search goes on with that of
    the orbit. Sources: Trefethen (2000), chapter 3, and Boyd (2001) for collocation; Keller (1968)
    and Seydel (2010), chapter 7, for shooting.

    Args:
        model: anything that satisfies `birdmb.orbits.Model`.
        guess: state (n,) at `start_time`, states (K, n) at K even instants of the period, or an
            orbit found before; by default what the model proposes (`guess_along` or
            `initial_guess`). Shooting takes the states at the starts of its segments.
        method: "collocation", "shooting" or "auto".
        period_guess: guess of the period in s, needed if and only if the system is autonomous; that
            of an orbit given as guess is its default.
        start_time: time of the first state, in s.
        damping: how steps of Newton's method are shortened: "line-search", or
            "levenberg-marquardt" (takes longer, starts further away).
        tolerance: Euclidean norm of the residual accepted, in units of the state scale; at most
            0.01. Of collocation, the root mean square of the slopes' mismatch in a period.
        max_iterations: accepted steps allowed, of collocation with each number of nodes.
        nodes: number N of nodes, odd; by default as many as `accuracy` needs.
        accuracy: largest error of the states accepted by collocation, in units of their scale.
        segments: number M of shooting segments, by default 1; more of them tame strongly unstable
            orbits. Given, it makes "auto" choose shooting.
        jacobian: of shooting: "variational" where the model differentiates its flow,
            "finite-differences" (central), or "auto": the first where possible and not contradicted
            by differences of the flow. Anything but "auto" makes "auto" choose shooting.
        jacobian_guess: of shooting: segment Jacobians (segments, n, n) of an orbit nearby. Newton's
            method tries its first steps with them where it would have to find its own by
            differences; the linearisation of the orbit that is found does not depend on them.
        executor: spreads the flows of shooting over workers; results do not depend on it.
        callback: called with every `Iteration` as it is accepted, the guess first.

    Returns:
        A `LimitCycle`, or the subclass that the model names as `limit_cycle_type`.

    Raises:
        ArgumentError: a guess of the wrong shape or not finite, a missing or superfluous period
            guess, a number out of range, options of one method given to the other, or a period in
            which the right-hand side does not repeat.
        StateError: the right-hand side or the flow fails at the guess.
        ConvergenceError: no orbit was found; it keeps the best point.
        NotSmoothError: collocation was asked for and the orbit is too rough for it and a mesh.
        SingularJacobianError: the equations have no unique solution where the search ended.
        EquilibriumError: the search ended on an equilibrium, or at period zero.
    """
    _require_options(tolerance, accuracy, max_iterations)
    if isinstance(guess, FloquetResult) and period_guess is None and model.period is None:
        period_guess = guess.period
    shooting = _options_of_shooting(segments, jacobian)
    reason = shooting or _without_rhs(model)
    if method == "collocation" and reason:
        raise ArgumentError(f'method="collocation" cannot be taken: {reason}.')
    if nodes is not None and (method == "shooting" or reason):
        raise ArgumentError("nodes are of collocation; shooting takes segments.")
    common: _Common = {
        "start_time": start_time,
        "damping": damping,
        "tolerance": tolerance,
        "max_iterations": max_iterations,
        "callback": callback,
    }
    asked = {
        "method": method,
        "start_time": start_time,
        "damping": damping,
        "tolerance": tolerance,
        "max_iterations": max_iterations,
        "nodes": nodes,
        "accuracy": accuracy,
        "segments": segments,
        "jacobian": jacobian,
    }
    failed: OrbitError | StateError | None = None
    if method != "shooting" and not reason:
        try:
            found = search_by_collocation(
                model,
                guess,
                period_guess=period_guess,
                nodes=nodes,
                accuracy=accuracy,
                most_nodes=most_nodes(model, method),
                **common,
            )
            return replace(found, search=asked)
        except ArgumentError:
            raise
        except (OrbitError, StateError) as error:
            if nodes is not None:
                raise
            failed, reason = (
                error,
                f"collocation failed: {str(error).partition(' Take method=')[0]}",
            )

    def on_mesh(error: OrbitError | StateError) -> LimitCycle:
        """The orbit on a mesh; raises `error` where there is none either."""
        try:
            found = search_on_mesh(
                model, guess, error, period_guess=period_guess, accuracy=accuracy, **common
            )
            return replace(found, search=asked)
        except (OrbitError, StateError) as failure:
            raise error from failure

    if failed is not None and method == "collocation":
        return on_mesh(failed)
    start, period = _beginning(guess, failed), period_guess
    if isinstance(failed, NotSmoothError) and failed.residual < NEAR and period_guess:
        period = failed.history[-1].period
    count = 1 if segments is None else segments
    try:
        found = search_by_shooting(
            model,
            _points(start, count),
            period_guess=period,
            segments=count,
            jacobian=jacobian,
            jacobian_guess=jacobian_guess,
            executor=executor,
            reason=reason or 'method="shooting" was asked for',
            **common,
        )
        return replace(found, search=asked)
    except (OrbitError, StateError) as error:
        if not isinstance(failed, NotSmoothError):
            raise
        return on_mesh(error)


def _require_options(tolerance: float, accuracy: float, max_iterations: int) -> None:
    """Refuse options out of range; raises `ArgumentError`."""
    require_tolerance("tolerance", tolerance)
    require_tolerance("accuracy", accuracy)
    if max_iterations < 1:
        raise ArgumentError(f"max_iterations must be at least 1, not {max_iterations}.")


class _Common(TypedDict):
    """What all methods take."""

    start_time: float
    damping: Damping
    tolerance: float
    max_iterations: int
    callback: Callable[[Iteration], None] | None


def _beginning(
    guess: npt.ArrayLike | FloquetResult | None, failed: OrbitError | StateError | None
) -> npt.ArrayLike | FloquetResult | None:
    """What shooting starts from, after collocation, if it was tried, `failed`."""
    if isinstance(failed, NotSmoothError) and failed.residual < NEAR:
        return failed.best_x
    if failed is None or guess is None or isinstance(guess, FloquetResult):
        return guess
    states = np.asarray(guess, float)
    return states[0] if states.ndim == 2 else states


def _options_of_shooting(segments: int | None, jacobian: str) -> str:
    if segments is not None:
        return "segments are of shooting"
    return "" if jacobian == "auto" else f'jacobian="{jacobian}" is of shooting'


def _without_rhs(model: Model) -> str:
    return "" if isinstance(model, HasRates | HasRhs) else "the model has no right-hand side"


def most_nodes(model: Model, method: SearchMethod) -> int:
    """Number of collocation nodes beyond which an orbit counts as too rough."""
    if method == "collocation":
        return _MOST_NODES
    return max(_MOST_NODES_BY_CHOICE, _MOST_UNKNOWNS_BY_CHOICE // len(model.state_names))


def _points(guess: npt.ArrayLike | FloquetResult | None, segments: int) -> npt.ArrayLike | None:
    """What shooting starts from: the starts of its segments of a path given as guess."""
    if not isinstance(guess, FloquetResult):
        path = None if guess is None else np.asarray(guess, float)
        # Of a shorter one that the segments do not fit, they would be made up.
        if path is None or path.ndim != 2 or len(path) < FEWEST_INSTANTS or len(path) % segments:
            return path
        return path[:: len(path) // segments]
    phases = np.arange(segments) / segments
    return guess.trajectory(guess.start_time + phases * guess.period).states
