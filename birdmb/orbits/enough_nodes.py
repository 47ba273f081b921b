"""Collocation equations solved on as many nodes as the orbit needs."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Generic, Protocol, Self, TypeVar

import numpy as np

from birdmb._typing import FloatArray
from birdmb.orbits.collocation import LatestJacobians
from birdmb.orbits.errors import NotSmoothError
from birdmb.orbits.iteration import Iteration
from birdmb.orbits.newton import SHORTEST_DAMPING, Damping, Equations, Linear, factorise, solve
from birdmb.orbits.trigonometric import resampled
from birdmb.orbits.two_levels import Factorised

FIRST_NODES = 25
_GROWTH = 1.5
# Harmonics that decay more slowly than this from one number of nodes to the next will not reach
# the accuracy: 1.5 times the nodes take a smooth orbit's error down by far more.
_SLOWEST_DECAY = 0.5
# On fewer numbers of nodes an error need not fall off yet.
_RUNGS_TO_JUDGE = 4
# A corrected solution is better, not exact.
_ERROR_PER_CORRECTION = 2.0
# What the highest harmonics hold is more than the error, if not by so much.
_SURELY = 4.0
# Of the error that the nodes leave: a residual below it decides nothing on more nodes.
_PART_OF_ERROR = 0.1
# Of the residual that a linear step may leave: the derivatives that it takes are no better.
_PART_LEFT = 1e-3


class OnNodes(Equations, Protocol):
    """Equations of an orbit on nodes, the number of which can be chosen."""

    @property
    def nodes(self) -> int:
        """Number N of nodes."""

    @property
    def latest(self) -> LatestJacobians:
        """What `jacobian` took last."""

    def rate_jacobians(self, u: FloatArray) -> FloatArray:
        """Derivatives (N, n, n) of the rates by the scaled states."""

    def assemble(self, u: FloatArray, rate_jacobians: FloatArray) -> FloatArray:
        """Derivative of the residual from them."""

    def product(self, u: FloatArray, rate_jacobians: FloatArray) -> Linear:
        """What the derivative makes of a change of the unknowns; only what `assemble` tells."""

    def round_off(self, u: FloatArray) -> float:
        """Norm that round-off leaves of the residual."""

    def on_nodes(self, nodes: int, u: FloatArray) -> tuple[Self, FloatArray]:
        """The same equations and unknowns on other nodes."""


EquationsT = TypeVar("EquationsT", bound=OnNodes)


@dataclass(frozen=True)
class Collocated(Generic[EquationsT]):
    """A solution of the collocation equations, and what a finer one makes of it.

    Attributes:
        equations: those solved.
        u: unknowns.
        residual: of the equations.
        finer: the equations on half as many nodes again.
        finer_u: unknowns there, of this solution corrected by one Newton step.
        state_error: bound of the error of the states, in units of their scale: twice the largest
            correction.
        iterations: steps of Newton's method on all numbers of nodes.
    """

    equations: EquationsT
    u: FloatArray
    residual: FloatArray
    finer: EquationsT
    finer_u: FloatArray
    state_error: float
    iterations: tuple[Iteration, ...]


def more_nodes(nodes: int) -> int:
    """The next odd number of nodes above half as many again."""
    return int(_GROWTH * nodes) | 1


def fewer_nodes(nodes: int) -> int:
    """An odd number of nodes from which `more_nodes` leads about back to `nodes`."""
    return int(nodes / _GROWTH) | 1


def collocate(
    equations: EquationsT,
    u: FloatArray,
    *,
    damping: Damping,
    tolerance: float,
    accuracy: float,
    max_iterations: int,
    most_nodes: int,
    fixed: bool = False,
    shortest_damping: float = SHORTEST_DAMPING,
    callback: Callable[[Iteration], None] | None = None,
    path_of: Callable[[EquationsT, FloatArray], FloatArray] | None = None,
) -> Collocated[EquationsT]:
    """Solve the equations on as many nodes as the orbit needs, from the unknowns `u`.

    The number of nodes grows by half until the correction that a Newton step on half as many again
    makes is below `accuracy` (state scales). `fixed`: the number given is kept, whatever it leaves.
    `path_of`: the states of unknowns, for a `NotSmoothError` to keep.

    Raises:
        StateError: the right-hand side fails at the guess.
        ConvergenceError: no solution on some number of nodes.
        NotSmoothError: the error does not fall off with the nodes, or not with `most_nodes`.
    """
    history: list[Iteration] = []
    errors: list[float] = []
    first: Linear | None = None
    jacobians: FloatArray | None = None
    factorised: Factorised | None = None
    roughly = not fixed

    def record(iteration: Iteration) -> None:
        history.append(replace(iteration, number=len(history), nodes=equations.nodes))
        if callback is not None:
            callback(history[-1])

    def enough(u: FloatArray) -> float:
        """More nodes will be needed: what these leave of error is not worth a smaller residual."""
        left = _tail(u, equations.nodes)
        return _PART_OF_ERROR * left if roughly and left > _SURELY * accuracy else 0.0

    while True:
        goal = max(tolerance, equations.round_off(u))
        u, residual, _, last = solve(
            equations,
            u,
            damping=damping,
            tolerance=goal,
            max_iterations=max_iterations,
            callback=record,
            first_solver=first,
            shortest_damping=shortest_damping,
            enough=enough,
        )
        if last is not None and last is not first:
            factorised = Factorised(equations.nodes, last)
        if equations.latest.jacobians is not None:
            jacobians = equations.latest.jacobians
        elif jacobians is None:
            jacobians = equations.rate_jacobians(u)
        finer, finer_u, error, following = _correction(equations, u, jacobians, factorised)
        if fixed or error <= accuracy:
            if not roughly or np.linalg.norm(residual) <= goal:
                return Collocated(equations, u, residual, finer, finer_u, error, tuple(history))
            roughly, first = False, last
            continue
        roughly = True
        errors.append(error)
        path = None if path_of is None else path_of(equations, u)
        _refuse_rough(equations, u, errors, accuracy, most_nodes, history, path)
        jacobians = resampled(jacobians, finer.nodes)
        equations, u, first = finer, finer_u, following


def _tail(u: FloatArray, nodes: int) -> float:
    """Largest amplitude of the states' two highest harmonics, in units of their scale.

    About what the nodes leave of error. The states come first among the unknowns.
    """
    states = u[: u.size // nodes * nodes].reshape(nodes, -1)
    return 2.0 / nodes * float(np.abs(np.fft.rfft(states, axis=0)[-2:]).max())


def _correction(
    equations: EquationsT, u: FloatArray, jacobians: FloatArray, factorised: Factorised | None
) -> tuple[EquationsT, FloatArray, float, Linear]:
    """The equations on more nodes, unknowns after a Newton step there, its size and its solver.

    The derivatives on the finer nodes are those interpolated: they decide how good the step is, not
    where it leads.
    """
    finer, start = equations.on_nodes(more_nodes(equations.nodes), u)
    between = resampled(jacobians, finer.nodes)
    solver = _solver(finer, start, between, factorised)
    residual = finer.residual(start)
    try:
        step = -solver(residual)
    except np.linalg.LinAlgError:
        # Least squares where the orbit is one of a family: its Jacobian is singular.
        step = np.array(np.linalg.lstsq(finer.assemble(start, between), -residual)[0], float)
    return finer, start + step, _ERROR_PER_CORRECTION * float(np.abs(step).max()), solver


def _solver(
    equations: EquationsT, u: FloatArray, jacobians: FloatArray, factorised: Factorised | None
) -> Linear:
    """Solver of the linear equations, for as many right-hand sides as are asked for."""
    _, period = equations.start_and_period(u)
    by_phase = period * jacobians[:, :, : jacobians.shape[1]]
    product = equations.product(u, jacobians)
    whole: list[Linear] = []

    def solver(right: FloatArray) -> FloatArray:
        if factorised is not None and not whole:
            found = factorised.solve_on_more(product, right, by_phase, _PART_LEFT)
            if found is not None:
                return found
        if not whole:
            whole.append(factorise(equations.assemble(u, jacobians))[0])
        return whole[0](right)

    return solver


def _refuse_rough(
    equations: OnNodes,
    u: FloatArray,
    errors: list[float],
    accuracy: float,
    most_nodes: int,
    history: list[Iteration],
    path: FloatArray | None,
) -> None:
    """Raise `NotSmoothError` where the `errors` so far will not reach the accuracy."""
    nodes = equations.nodes
    following = more_nodes(nodes)
    known = len(errors) >= _RUNGS_TO_JUDGE
    slow = known and errors[-1] > _SLOWEST_DECAY * errors[-3]
    hopeless = known and _needed(nodes, errors, accuracy) > most_nodes
    if following <= most_nodes and not slow and not hopeless:
        return
    x, _ = equations.start_and_period(u)
    why = (
        f"{most_nodes} nodes, the most allowed, do not reach it"
        if following > most_nodes
        else "it does not fall off with the number of nodes as that of a smooth orbit does"
    )
    raise NotSmoothError(
        f"The orbit is too rough for collocation: with {nodes} nodes its error is still "
        f"{errors[-1]:.1e} of the state scale (goal {accuracy:.1g}), and {why}. "
        f'Take method="shooting", or allow more nodes.',
        x,
        errors[-1],
        history,
        path,
    )


def _needed(nodes: int, errors: list[float], accuracy: float) -> float:
    """Nodes that the accuracy would take if the errors fell off as they did over two rungs.

    Taken as algebraic: a spectral decay only gets faster.
    """
    last, before = errors[-1], errors[-3]
    if not last < before:
        return math.inf
    rungs = 2 * math.log(last / accuracy) / math.log(before / last)
    return nodes * math.exp(min(rungs * math.log(_GROWTH), 100.0))
