"""The Fourier collocation equations of a periodic orbit, and how many nodes it needs."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Generic, Protocol, Self, TypeVar

import numpy as np
from scipy.linalg import lapack

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.orbits.errors import NotSmoothError
from birdmb.orbits.iteration import Iteration
from birdmb.orbits.newton import SHORTEST_DAMPING, Damping, Equations, solve
from birdmb.orbits.right_hand_side import RightHandSide
from birdmb.orbits.trigonometric import differentiation_matrix, resampled

_EPS = float(np.finfo(float).eps)
FIRST_NODES = 25
_GROWTH = 1.5
# Harmonics that decay more slowly than this from one number of nodes to the next will not reach
# the accuracy: 1.5 times the nodes take a smooth orbit's error down by far more.
_SLOWEST_DECAY = 0.5
# On fewer numbers of nodes an error need not fall off yet.
_RUNGS_TO_JUDGE = 4
# A corrected solution is better, not exact.
_ERROR_PER_CORRECTION = 2.0
# Of the error that the nodes leave: a residual below it decides nothing on more nodes.
_PART_OF_ERROR = 0.1
# Round-off of the residual, in units of machine precision times its largest term.
_NOISE = 100.0


class LatestJacobians:
    """The derivatives of the rates that a search took last."""

    jacobians: FloatArray | None = None


class _Latest(LatestJacobians):
    """What was evaluated last: a residual and a Jacobian at the same point share the rates."""

    period = math.nan
    points = rates = np.empty(0)


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

    def round_off(self, u: FloatArray) -> float:
        """Norm that round-off leaves of the residual."""

    def on_nodes(self, nodes: int, u: FloatArray) -> tuple[Self, FloatArray]:
        """The same equations and unknowns on other nodes."""


EquationsT = TypeVar("EquationsT", bound=OnNodes)


@dataclass(frozen=True)
class CollocationEquations:
    """D X = T f(t, X) at N equidistant nodes, D the trigonometric differentiation matrix.

    Unknowns: the states at the nodes in units of the scale and, for an autonomous system, the
    period in units of `period`. Residual: the mismatch of the slopes by phase, in the same units,
    divided by the root of N so that its norm does not depend on N. The phase of an autonomous orbit
    is fixed as in shooting: a step is orthogonal to the velocities along the iterate itself, and
    that row of the residual is always zero (Doedel, Keller & Kernevez 1991).
    """

    rhs: RightHandSide
    start: float
    period: float
    autonomous: bool
    nodes: int
    latest: _Latest = field(default_factory=_Latest, repr=False, compare=False)

    # One Jacobian costs 2 n residuals where it is taken by differences, and an LU anyway.
    expensive_jacobian = True

    def on_nodes(self, nodes: int, u: FloatArray) -> tuple[CollocationEquations, FloatArray]:
        """The same equations and unknowns on other nodes."""
        points, period = self.unpack(u)
        other = self.with_nodes(nodes)
        return other, other.pack(resampled(points, nodes), period)

    def with_nodes(self, nodes: int) -> CollocationEquations:
        """The same equations on other nodes."""
        return replace(self, nodes=nodes, latest=_Latest())

    def by_differences(self) -> CollocationEquations:
        """The same equations with derivatives of the rates by differences."""
        return replace(self, rhs=replace(self.rhs, by_differences=True), latest=_Latest())

    def pack(self, points: FloatArray, period: float) -> FloatArray:
        """Unknowns of the orbit with scaled states `points` (N, n)."""
        return (
            np.append(points.ravel(), period / self.period) if self.autonomous else points.ravel()
        )

    def unpack(self, u: FloatArray) -> tuple[FloatArray, float]:
        """Scaled states (N, n) and period of the unknowns."""
        period = self.period
        if self.autonomous:
            u, period = u[:-1], float(u[-1]) * self.period
        return u.reshape(self.nodes, -1), period

    def times(self, period: float) -> FloatArray:
        """Times (N,) of the nodes in s."""
        return self.start + period * np.arange(self.nodes) / self.nodes

    def start_and_period(self, u: FloatArray) -> tuple[FloatArray, float]:
        """State (n,) at the start, in its own units, and the period."""
        points, period = self.unpack(u)
        return points[0] * self.rhs.scale, period

    def path(self, u: FloatArray) -> FloatArray:
        """States (N, n) at the nodes, in their own units."""
        return self.unpack(u)[0] * self.rhs.scale

    def closure(self, residual: FloatArray) -> float:
        """Largest mismatch of slopes, in the units of the states per period."""
        gaps = residual[:-1] if self.autonomous else residual
        gaps = gaps.reshape(self.nodes, -1) * self.rhs.scale * np.sqrt(self.nodes)
        return float(np.abs(gaps).max())

    def rates(self, points: FloatArray, period: float) -> FloatArray:
        """Rates (N, n) of scaled states per second at the nodes; raises `StateError`."""
        latest = self.latest
        if latest.period != period or not np.array_equal(latest.points, points):
            latest.rates = self.rhs.rates(self.times(period), points)
            latest.points, latest.period = points.copy(), period
        return latest.rates

    def residual(self, u: FloatArray) -> FloatArray:
        """Scaled mismatch of slopes; StateError where the right-hand side fails."""
        points, period = self.unpack(u)
        if not period > 0:
            raise StateError(f"The period {period:.6g} is not positive.")
        gaps = differentiation_matrix(self.nodes) @ points - period * self.rates(points, period)
        scaled = gaps.ravel() / np.sqrt(self.nodes)
        return np.append(scaled, 0.0) if self.autonomous else scaled

    def jacobian(self, u: FloatArray) -> FloatArray:
        """Derivative of the residual."""
        self.latest.jacobians = self.rate_jacobians(u)
        return self.assemble(u, self.latest.jacobians)

    def rate_jacobians(self, u: FloatArray) -> FloatArray:
        """Derivatives (N, n, n) of the rates by the scaled states at the nodes."""
        points, period = self.unpack(u)
        return self.rhs.jacobians(self.times(period), points)

    def derivative_gap(self, u: FloatArray) -> float:
        """By how much a derivative that the model gives contradicts differences; 0 if it agrees."""
        if not self.rhs.has_derivative:
            return 0.0
        points, period = self.unpack(u)
        return self.rhs.derivative_gap(self.times(period), points, self.rate_jacobians(u))

    def assemble(self, u: FloatArray, rate_jacobians: FloatArray) -> FloatArray:
        """Derivative of the residual from the derivatives (N, n, n) of the rates."""
        points, period = self.unpack(u)
        nodes, n = points.shape
        blocks = differentiation_matrix(nodes)[:, None, :, None] * np.eye(n)[None, :, None, :]
        at = np.arange(nodes)
        blocks[at, :, at, :] -= period * rate_jacobians
        matrix = blocks.reshape(nodes * n, nodes * n) / np.sqrt(nodes)
        if not self.autonomous:
            return np.asarray(matrix)
        rates = self.rates(points, period)
        stretch = -self.period * rates.ravel() / np.sqrt(self.nodes)
        phase = rates.ravel() / (np.linalg.norm(rates) or 1.0)
        return np.block([[matrix, stretch[:, None]], [phase[None, :], np.zeros((1, 1))]])

    def round_off(self, u: FloatArray) -> float:
        """Norm that round-off leaves of the residual."""
        points, period = self.unpack(u)
        slopes = period * self.rates(points, period)
        largest = self.nodes * np.abs(points).max() + np.abs(slopes).max()
        return float(_NOISE * _EPS * largest)


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
    first: FloatArray | None = None
    roughly = not fixed

    def record(iteration: Iteration) -> None:
        history.append(replace(iteration, number=len(history), nodes=equations.nodes))
        if callback is not None:
            callback(history[-1])

    def enough(u: FloatArray) -> float:
        """More nodes will be needed: what these leave of error is not worth a smaller residual."""
        left = _tail(u, equations.nodes)
        return _PART_OF_ERROR * left if roughly and left > accuracy else 0.0

    while True:
        goal = max(tolerance, equations.round_off(u))
        u, residual, _ = solve(
            equations,
            u,
            damping=damping,
            tolerance=goal,
            max_iterations=max_iterations,
            callback=record,
            first_jacobian=None if first is None else equations.assemble(u, first),
            shortest_damping=shortest_damping,
            enough=enough,
        )
        jacobians = equations.latest.jacobians
        if jacobians is None:
            jacobians = equations.rate_jacobians(u) if first is None else first
        finer, finer_u, error = _correction(equations, u, jacobians)
        if fixed or error <= accuracy:
            if not roughly or np.linalg.norm(residual) <= goal:
                return Collocated(equations, u, residual, finer, finer_u, error, tuple(history))
            roughly, first = False, jacobians
            continue
        roughly = True
        errors.append(error)
        path = None if path_of is None else path_of(equations, u)
        _refuse_rough(equations, u, errors, accuracy, most_nodes, history, path)
        first = resampled(jacobians, finer.nodes)
        equations, u = finer, finer_u


def _tail(u: FloatArray, nodes: int) -> float:
    """Largest amplitude of the states' two highest harmonics, in units of their scale.

    About what the nodes leave of error. The states come first among the unknowns.
    """
    states = u[: u.size // nodes * nodes].reshape(nodes, -1)
    return 2.0 / nodes * float(np.abs(np.fft.rfft(states, axis=0)[-2:]).max())


def _correction(
    equations: EquationsT, u: FloatArray, jacobians: FloatArray
) -> tuple[EquationsT, FloatArray, float]:
    """The equations on more nodes, unknowns after a Newton step there, and the step's size.

    The derivatives on the finer nodes are those interpolated: they decide how good the step is, not
    where it leads.
    """
    finer, start = equations.on_nodes(more_nodes(equations.nodes), u)
    matrix = finer.assemble(start, resampled(jacobians, finer.nodes))
    residual = finer.residual(start)
    # Least squares where the orbit is one of a family: its Jacobian is singular.
    lu, pivots, singular = lapack.dgetrf(matrix)
    step = -lapack.dgetrs(lu, pivots, residual)[0]
    if singular or not np.isfinite(step).all():
        step = -np.linalg.lstsq(matrix, residual)[0]
    return finer, start + step, _ERROR_PER_CORRECTION * float(np.abs(step).max())


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
