"""What a search for a trim has tried, and what it says when there is none."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError, OrbitError, StateError
from birdmb.models import FlightCycle, FlightModel
from birdmb.models.motion import PLANAR
from birdmb.models.wing_model import BODY_STATES
from birdmb.orbits import FloquetResult, NotSmoothError
from birdmb.orbits.collocation_search import collocated_cycle, guessed_path, nodes_shown
from birdmb.orbits.problem import HasGuessedPath, HasRates
from birdmb.orbits.search import ACCURACY, TOLERANCE
from birdmb.studies.cycles import KeptModels, ModelFactory, WarmCycles
from birdmb.studies.trim_collocation import CollocatedTrim, solve_collocated
from birdmb.studies.trim_equations import TrimEquations
from birdmb.topology import Bird

_STEEP = np.radians(30.0)
_LIFT_COEFFICIENT = 0.6
_SLOWEST = 1.0  # m/s
# Fewer than of a search for a cycle: each step makes the wing anew at every node.
_FIRST_NODES = 17


@dataclass(frozen=True)
class Trial:
    """A limit cycle that was tried: parameters (k,), what it reaches, and by how much it misses."""

    point: FloatArray
    cycle: FlightCycle
    reached: dict[str, float]
    differences: FloatArray

    @property
    def steep(self) -> bool:
        """Whether the body stands up rather than flies forwards; such flights are a last resort."""
        return abs(self.cycle.mean_pitch) > _STEEP


class TrimSearch:
    """Differences from the targets as a function of the parameters (k,), and all that was tried."""

    def __init__(
        self,
        bird: Bird,
        parameters: Mapping[str, tuple[float, float]],
        targets: Mapping[str, float],
        model: ModelFactory,
        tolerance: float,
        options: Mapping[str, Any],
    ) -> None:
        self.bird, self.names, self._targets = bird, tuple(parameters), dict(targets)
        self._tolerance, self._model = tolerance, model
        self.low, self.high = np.array(list(parameters.values()), dtype=float).T
        own = np.array([_number(bird.value(name)) for name in self.names])
        inside = (self.low <= own) & (own <= self.high)
        self.start = np.where(inside, own, 0.5 * (self.low + self.high))
        for bound in (self.low, self.high):  # bounds that no bird can have are told at once
            bird.with_values(self.named(bound))
        self._cycle, self._options = WarmCycles(bird, model, options), options
        self._model_at = KeptModels(self._made_at)
        if self._model_at(self.start).motion is not PLANAR:
            raise ArgumentError(
                "a trim is that of a symmetric flight: trim with a planar model, then fly the bird "
                "that it finds in space."
            )
        self.found: dict[tuple[float, ...], Trial] = {}
        self._failures: dict[tuple[float, ...], str] = {}
        self._failure_together = ""

    @property
    def succeeded(self) -> bool:
        """Whether a flight that is not steep meets all targets within the tolerance."""
        return any(self.is_trimmed(trial) and not trial.steep for trial in self.found.values())

    def differences(self, point: FloatArray) -> FloatArray:
        """Reached minus wanted (k,), m/s; exactly zero once the search has succeeded.

        So whatever solver asks for them comes to its end.

        Raises:
            OrbitError, StateError: there is no limit cycle.
        """
        if self.succeeded:
            return np.zeros(len(self._targets))
        key = tuple(point.tolist())
        if key not in self.found:
            try:
                cycle = self._cycle(self.named(point))
            except (OrbitError, StateError) as error:
                self._failures[key] = str(error)
                raise
            self._keep(point, cycle)
        return np.zeros(len(self._targets)) if self.succeeded else self.found[key].differences

    def _keep(self, point: FloatArray, cycle: FlightCycle) -> None:
        """Keep a trial."""
        reached = {"climb_rate": cycle.mean_climb_rate, "speed": cycle.mean_speed}
        missed = np.array([reached[name] - wanted for name, wanted in self._targets.items()])
        self.found[tuple(point.tolist())] = Trial(point.copy(), cycle, reached, missed)

    def solve_together(
        self, point: FloatArray, guess: npt.ArrayLike | FloquetResult | None
    ) -> None:
        """Solve closure and targets as one system from parameters (k,) and a guess of the orbit.

        By collocation; where the model has no rates, the options ask for shooting or the orbit is
        not smooth, by shooting. `None` is level forward flight.

        Raises:
            OrbitError, StateError: they are not met.
        """
        if self._collocates(point):
            try:
                self._keep(*self._collocated(point, guess))
            except NotSmoothError:
                if self._options.get("method") == "collocation":
                    raise
            else:
                return
        state = self.forward_flight() if guess is None else _first_state(guess)
        equations = TrimEquations(self._model_at, self.low, self.high, self._targets)
        point, state = equations.solve(point, state)
        self._cycle.start_from(state)
        self.differences(point)

    def _collocates(self, point: FloatArray) -> bool:
        options = self._options
        shooting = options.get("method") == "shooting" or options.get("segments") is not None
        return not shooting and isinstance(self._model_at(point), HasRates)

    def _collocated(
        self, point: FloatArray, guess: npt.ArrayLike | FloquetResult | None
    ) -> tuple[FloatArray, FlightCycle]:
        nodes = max(_FIRST_NODES, nodes_shown(guess))
        model = self._model_at(point)
        if guess is None:
            path = self._forward_path(nodes)
        else:
            path = guessed_path(model, guess, 0.0, model.bird.period, nodes)
        equations = CollocatedTrim(self._model_at, self.low, self.high, self._targets, nodes)
        accuracy = self._options.get("accuracy", ACCURACY)
        # The targets are part of the residual.
        tolerance = min(self._options.get("tolerance", TOLERANCE), 0.1 * self._tolerance)
        point, found = solve_collocated(
            equations, path, point, tolerance=tolerance, accuracy=accuracy
        )
        return point, collocated_cycle(found, FlightCycle, accuracy)

    def _forward_path(self, nodes: int) -> FloatArray:
        """States (nodes, n) over a beat of a body in level forward flight."""
        state, model = self.forward_flight(), self._model_at(self.start)
        path = np.tile(state, (nodes, 1))
        if state.size > len(BODY_STATES) and isinstance(model, HasGuessedPath):
            path = model.guess_along(model.bird.period * np.arange(nodes) / nodes)
            path[:, : len(BODY_STATES)] = state[: len(BODY_STATES)]
        return path

    def _made_at(self, point: FloatArray) -> FlightModel:
        return self._model(self.bird.with_values(self.named(point)))

    def forward_flight(self) -> FloatArray:
        """State (n,) of a level body that flies as fast as its wings need to carry it."""
        model = self._model_at(self.start)
        x = np.zeros(len(BODY_STATES))
        if len(model.state_names) > x.size:
            x = model.initial_guess()
        still = model.loads(0.0, x)
        area = 2.0 * float((still.right.chord * still.right.width).sum())
        bird = model.bird
        lift = 0.5 * bird.air.density * area * _LIFT_COEFFICIENT
        fastest = np.sqrt(model.mass * bird.gravity / lift) if lift else 0.0
        x[: len(BODY_STATES)] = max(float(fastest), _SLOWEST), 0.0, 0.0, 0.0
        return x

    def orbit_at(self, point: FloatArray) -> FlightCycle | FloatArray:
        """The limit cycle with these parameters, or the state (n,) that the model guesses.

        Raises:
            StateError: the model has no guess.
        """
        with suppress(OrbitError, StateError):
            self.differences(point)
            return self.found[tuple(point.tolist())].cycle
        return self._model_at(point).initial_guess()

    def failed_together(self, error: Exception) -> None:
        """Keep why closure and targets could not be met together; the last reason counts."""
        self._failure_together = str(error)

    @property
    def best(self) -> Trial | None:
        """The trial that misses the targets least; one that meets them without being steep."""

        def badness(trial: Trial) -> tuple[bool, bool, float]:
            missed = float(np.abs(trial.differences).max())
            return missed > self._tolerance, trial.steep, missed

        return min(self.found.values(), key=badness, default=None)

    def is_trimmed(self, trial: Trial) -> bool:
        """Whether it misses the targets by no more than the tolerance."""
        return bool((np.abs(trial.differences) <= self._tolerance).all())

    def named(self, point: FloatArray) -> dict[str, float]:
        """The parameters by dotted name."""
        return {name: float(value) for name, value in zip(self.names, point, strict=True)}

    def not_trimmed(self, best: Trial) -> str:
        """Say what was wanted, and what came closest."""
        return (
            f"{self.bird.name}: no trim to {_spelt(self._targets)} was found for {self._bounds()}; "
            f"closest is {_spelt({name: best.reached[name] for name in self._targets})} with "
            f"{_assigned(self.named(best.point))}{self._span()}{self._first_failure()}."
        )

    def nothing_found(self) -> str:
        """Say that there was no limit cycle to judge."""
        why = self._first_failure()
        if not why and self._failure_together:
            why = f"; {self._failure_together.rstrip('.')}"
        return f"{self.bird.name}: no trim for {self._bounds()}{why}."

    def _bounds(self) -> str:
        return " and ".join(
            f"{name} from {low:.6g} to {high:.6g}"
            for name, low, high in zip(self.names, self.low, self.high, strict=True)
        )

    def _span(self) -> str:
        """What one parameter made of its target all over its bounds."""
        if len(self.names) > 1 or len(self.found) == 1:
            return ""
        rates = [trial.reached["climb_rate"] for trial in self.found.values()]
        if max(rates) - min(rates) <= self._tolerance:
            return " (it does not depend on it)"
        return f" (it goes from {min(rates):.4g} to {max(rates):.4g} m/s)"

    def _first_failure(self) -> str:
        if not self._failures:
            return ""
        (point, reason), *_ = self._failures.items()
        tries = len(self._failures) + len(self.found)
        values = _assigned(self.named(np.array(point)))
        return (
            f"; {len(self._failures)} of {tries} values tried have no limit cycle, first {values}: "
            f"{reason.rstrip('.')}"
        )


def _spelt(speeds: Mapping[str, float]) -> str:
    return " and ".join(
        f"{name.replace('_', ' ')} {value:.4g} m/s" for name, value in speeds.items()
    )


def _assigned(values: Mapping[str, float]) -> str:
    return ", ".join(f"{name} = {value:.6g}" for name, value in values.items())


def _first_state(guess: npt.ArrayLike | FloquetResult) -> FloatArray:
    """State (n,) at the start of a guess."""
    if isinstance(guess, FloquetResult):
        return guess.x0
    return np.atleast_2d(np.asarray(guess, dtype=float))[0]


def _number(value: object) -> float:
    """A parameter's own value; NaN, which is outside all bounds, where it has none."""
    return float(value) if isinstance(value, int | float) else float("nan")
