"""Coexisting periodic orbits on few collocation nodes: many starts, then deflation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError, OrbitError, StateError
from birdmb.orbits.collocation import CollocationEquations
from birdmb.orbits.collocation_search import guessed_path
from birdmb.orbits.cycle import LimitCycle
from birdmb.orbits.deflation import Deflated, Known, apart
from birdmb.orbits.enough_nodes import more_nodes
from birdmb.orbits.iteration import Iteration
from birdmb.orbits.newton import Equations, solve
from birdmb.orbits.periodicity import require_period, turns
from birdmb.orbits.problem import Model
from birdmb.orbits.right_hand_side import RightHandSide
from birdmb.orbits.sameness import state_repeats
from birdmb.orbits.scales import declared_scale, sizes_along
from birdmb.orbits.shooting_search import SMALLEST_AMPLITUDE
from birdmb.orbits.trigonometric import interpolated, resampled

# Fewer than a single search begins with: enough to tell orbits apart, and starts are many.
COARSE_NODES = 17
# Solutions of the same coarse equations, so well solved, differ by far less if they are the same.
_TOLERANCE = 1e-8
_SAME = 1e-4
# A start whose path needs more than the first nodes gets them only while nothing is found.
_SECOND_CHANCES = 8
_OTHER_SIZES = (0.5, 2.0, 4.0)
# So many steps in a row cut so short lead into a local minimum of the residual: another start
# promises more.
_SHORT, _SHORT_STEPS = 0.1, 3


class _StalledError(OrbitError):
    """The search from one start is given up."""


class _Stalling:
    """Callback of a search from one start that gives it up where it stalls."""

    def __init__(self) -> None:
        self._short = 0

    def __call__(self, iteration: Iteration) -> None:
        self._short = self._short + 1 if iteration.damping < _SHORT else 0
        if self._short >= _SHORT_STEPS:
            raise _StalledError


@dataclass(frozen=True)
class CoarseOrbit:
    """A solution on few nodes: `states` (N, n) in their units, period in s."""

    states: FloatArray
    period: float


class CoarseSearch:
    """Solutions of a model's collocation equations on few nodes, all that several starts lead to.

    Args:
        model: with a right-hand side.
        start_time: time of the first node, in s.
        period: of the forcing, or a typical one, in s.
        max_iterations: accepted steps allowed from each start.
        known: orbits that are not to be found again.
    """

    def __init__(
        self,
        model: Model,
        start_time: float,
        period: float,
        max_iterations: int,
        known: Sequence[LimitCycle],
    ) -> None:
        self._model, self._start, self._period = model, start_time, period
        self._max_iterations = max_iterations
        self._autonomous = model.period is None
        self._given = known
        self._found: list[Known] = []
        # Equilibria and what was known before: not to be found, and not to be returned.
        self._others: list[Known] = []

    @property
    def times(self) -> FloatArray:
        """Times (N,) of the nodes in s."""
        return self._start + self._period * np.arange(COARSE_NODES) / COARSE_NODES

    def run(
        self,
        guesses: Sequence[object],
        periods: Sequence[float],
        deflations: int,
        told: Callable[..., None],
    ) -> list[CoarseOrbit]:
        """Search from each guess, then deflated from some; orbits in the order they are found.

        Raises:
            ArgumentError: a guess of the wrong shape, or a period in which the model's right-hand
                side does not repeat.
            StateError: it fails at every guess.
        """
        each = list(periods) if len(periods) == len(guesses) else [periods[0]] * len(guesses)
        starts, error = self._laid_out(guesses, each)
        if not starts:
            raise error or StateError("There is no start.")
        self._prepare(starts)
        reached: list[tuple[FloatArray, float]] = []
        failures: list[StateError] = []
        for number, (path, period) in enumerate(starts, 1):
            if self._try(path, period, self._equations, failures):
                reached.append((path, period))
            told("starts", number, len(starts), len(self._found))
        if len(failures) == len(starts):
            raise failures[0]
        if not self._found:
            self._try_on_more_nodes(starts)
        self._deflate(starts, reached, deflations, told)
        scale = self._scale
        return [CoarseOrbit(k.points * scale, k.period or self._period) for k in self._found]

    def _laid_out(
        self, guesses: Sequence[object], periods: Sequence[float]
    ) -> tuple[list[tuple[FloatArray, float]], StateError | None]:
        starts, first_error = [], None
        for guess, period in zip(guesses, periods, strict=True):
            try:
                path = guessed_path(self._model, guess, self._start, period, COARSE_NODES)  # type: ignore[arg-type]
                starts.append((path, period))
            except StateError as error:
                first_error = first_error or error
        return starts, first_error

    def _prepare(self, starts: Sequence[tuple[FloatArray, float]]) -> None:
        model, start = self._model, self._start
        declared = declared_scale(model)
        if declared is None:
            sizes = [sizes_along(model, path, start, period) for path, period in starts]
            declared = np.max(sizes, axis=0)
        self._scale = declared
        path, period = starts[0]
        require_period(model, path[0], declared, start, period)
        equations = CollocationEquations(
            RightHandSide(model, declared), start, self._period, self._autonomous, COARSE_NODES
        )
        contradicted = equations.derivative_gap(equations.pack(path / declared, period)) > 0
        self._equations = equations.by_differences() if contradicted else equations
        self._repeats = state_repeats(model, declared)
        nodes = np.arange(COARSE_NODES) / COARSE_NODES
        for cycle in self._given:
            period = cycle.minimal_period if self._autonomous else cycle.period
            points = cycle.trajectory(start + period * nodes).states / declared
            self._others.append(Known(points, period if self._autonomous else None))

    def _try(
        self,
        path: FloatArray,
        period: float,
        equations: Equations,
        failures: list[StateError] | None = None,
    ) -> bool:
        """Whether a start leads to a solution that was not known."""
        u = self._equations.pack(path / self._scale, period)
        try:
            u = solve(
                equations,
                u,
                damping="line-search",
                tolerance=max(_TOLERANCE, self._equations.round_off(u)),
                max_iterations=self._max_iterations,
                callback=_Stalling(),
            ).u
        except ArgumentError:
            raise
        except StateError as error:
            if failures is not None:
                failures.append(error)
            return False
        except OrbitError:
            return False
        return self._keep(*self._equations.unpack(u))

    def _keep(self, points: FloatArray, period: float) -> bool:
        known = Known(points)
        if self._autonomous:
            if np.abs(points - points[0]).max() <= SMALLEST_AMPLITUDE:
                if not self._seen(known, period, self._others):
                    self._others.append(known)
                return False
            known = self._once_round(points, period)
        if self._seen(known, known.period or period, [*self._found, *self._others]):
            return False
        self._found.append(self._turned(known))
        return True

    def _once_round(self, points: FloatArray, period: float) -> Known:
        def states_at(times: FloatArray) -> FloatArray:
            return interpolated(points, (times - self._start) / period)

        number = turns(self._model, states_at, np.ones_like(points[0]), self._start, period)
        phases = np.arange(len(points)) / len(points) / number
        return Known(interpolated(points, phases), period / number)

    def _turned(self, known: Known) -> Known:
        """The same orbit with the mean of states that repeat as near to 0 as it can be."""
        turning = np.isfinite(self._repeats)
        points = known.points.copy()
        repeats = self._repeats[turning]
        points[:, turning] -= repeats * np.round(points[:, turning].mean(axis=0) / repeats)
        return replace(known, points=points)

    def _seen(self, known: Known, period: float, others: Sequence[Known]) -> bool:
        def gap(other: Known) -> float:
            return apart(
                known.points, period, other, self._repeats, any_phase=self._autonomous
            ).squared

        return any(gap(other) < _SAME**2 for other in others)

    def _try_on_more_nodes(self, starts: Sequence[tuple[FloatArray, float]]) -> None:
        """Look for orbits that the first nodes do not resolve, from a few of the starts."""
        few = self._equations
        nodes = more_nodes(more_nodes(few.nodes))
        self._equations = few.with_nodes(nodes)
        self._others = [replace(k, points=resampled(k.points, nodes)) for k in self._others]
        for path, period in starts[:_SECOND_CHANCES]:
            for other in (path, *self._beside(Known(path / self._scale))):
                if self._try(resampled(other, nodes), period, self._equations):
                    break

    def _deflate(
        self,
        starts: Sequence[tuple[FloatArray, float]],
        reached: Sequence[tuple[FloatArray, float]],
        deflations: int,
        told: Callable[..., None],
    ) -> None:
        """Search away from what is known: from the starts that led to it, and from beside it."""
        nodes, tried = self._equations.nodes, 0
        others = [start for start in starts if not any(start is each for each in reached)]
        queue = [*reached, *others[:: max(1, len(others) // max(1, deflations // 2))]]
        varied = 0
        while tried < deflations and (self._found or self._others):
            if varied < len(self._found):
                around = self._found[varied]
                sizes = self._beside(around)
                queue = [*((path, around.period or self._period) for path in sizes), *queue]
                varied += 1
            if not queue:
                break
            path, period = queue.pop(0)
            going = True
            while going and tried < deflations:
                tried += 1
                known = (*self._found, *self._others)
                equations = Deflated(self._equations, known, self._repeats)
                going = self._try(resampled(path, nodes), period, equations)
                told("deflation", tried, deflations, len(self._found))

    def _beside(self, known: Known) -> list[FloatArray]:
        """Paths (N, n) of a known orbit's shape and of other sizes about its mean."""
        mean = known.points.mean(axis=0)
        return [(mean + size * (known.points - mean)) * self._scale for size in _OTHER_SIZES]
