"""One point of a sweep: a pure function of its task, which a worker runs."""

from __future__ import annotations

import math
import textwrap
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from typing import Any, cast

from threadpoolctl import threadpool_limits

from birdmb.errors import BirdmbError, OrbitError, StateError
from birdmb.models import FlightCycle, MultibodyModel
from birdmb.models.wing_model import WingModel
from birdmb.orbits import find_limit_cycle
from birdmb.orbits.problem import HasInitialGuess
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.sweeps.grid import Value
from birdmb.studies.sweeps.sensitivity import sensitivities
from birdmb.studies.sweeps.settings import Search, Trimming
from birdmb.studies.trim import TrimGuess, trim_flight
from birdmb.studies.validity import assess_validity
from birdmb.topology import Bird

COLD = "cold"
_LONGEST_REASON = 600  # characters; foreign errors may bring a traceback


@dataclass(frozen=True)
class Guess:
    """A neighbour's flight to start from.

    Attributes:
        place: the neighbour's, as the store writes it.
        x0: its state at t = 0, by name.
        monodromy: derivative (n, n) of its state after a beat with respect to x0.
        trimmed: values of the parameters that it was trimmed by, by name, if it was.
    """

    place: str
    x0: Mapping[str, float]
    monodromy: Sequence[Sequence[float]]
    trimmed: Mapping[str, float]


@dataclass(frozen=True)
class Task:
    """All that the outcome of a point depends on; `steps` are those of its sensitivities."""

    bird: Bird
    model: ModelFactory
    search: Search
    values: Mapping[str, Value]
    steps: Mapping[str, float]
    guess: Guess | None
    trimming: Trimming | None


@dataclass(frozen=True)
class Outcome:
    """What became of a point.

    Attributes:
        result: the limit cycle as `described`; `None` if none was found.
        reason: why none was found, else empty.
        start: place of the neighbour that the search succeeded from, or "cold" where it had, or was
            left with, the model's own guess.
        seconds: how long it took.
    """

    result: dict[str, Any] | None
    reason: str
    start: str
    seconds: float


def compute(task: Task) -> Outcome:
    """Find the limit cycle of a point, from its neighbour's or else from the model's own guess.

    Whatever goes wrong is the outcome of the point, with its reason: a deliberate error by its
    sentence, any other by type and text. Only `KeyboardInterrupt` is raised.
    """
    began = time.perf_counter()
    start, result, reason = COLD, None, ""
    try:
        with _one_thread():
            if task.trimming is None:
                cycle, start = _found(task)
                trimmed = dict[str, float]()
            else:
                cycle, trimmed, start = _trimmed(task, task.trimming)
            result = described(cycle) | {"trimmed": trimmed, **_answers(task, cycle, trimmed)}
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        start, reason = COLD, _told(error)
    return Outcome(result, reason, start, time.perf_counter() - began)


def _told(error: BaseException) -> str:
    text = textwrap.shorten(str(error), _LONGEST_REASON, placeholder=" ...")
    if isinstance(error, BirdmbError) and text:
        return text
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


_counting = threading.Lock()
_computing = 0
_limits: threadpool_limits | None = None


@contextmanager
def _one_thread() -> Iterator[None]:
    """One thread of linear algebra within: how many share a sum decides its last bits.

    The limit is the whole process's. Where threads compute points side by side, the first one that
    begins sets it and the last one that ends lifts it.
    """
    global _computing, _limits  # noqa: PLW0603 - the limit that they count is global, too
    with _counting:
        _computing += 1
        if _computing == 1:
            _limits = threadpool_limits(1)
    try:
        yield
    finally:
        with _counting:
            _computing -= 1
            if _computing == 0 and _limits is not None:
                _limits.restore_original_limits()
                _limits = None


def prepare(bird: Bird, model: ModelFactory) -> None:
    """Load or compile the kernels, by flying a beat; a bird that cannot is left to its points."""
    with suppress(Exception):
        flying = model(bird)
        if isinstance(flying, HasInitialGuess):
            flying.flow(flying.initial_guess(), 0.0, bird.period)


def _found(task: Task) -> tuple[FlightCycle, str]:
    model = task.model(task.bird.with_values(task.values))
    search = asdict(task.search)
    guess = task.guess
    # A varied mode of a joint may have given the neighbour other states.
    if guess is not None and tuple(guess.x0) == model.state_names:
        with suppress(OrbitError, StateError):
            x0 = list(guess.x0.values())
            # Of several segments only the product is kept.
            known = [guess.monodromy] if task.search.segments in {None, 1} else None
            cycle = find_limit_cycle(model, x0, jacobian_guess=known, **search)
            return cast("FlightCycle", cycle), guess.place
    return cast("FlightCycle", find_limit_cycle(model, **search)), COLD


def _trimmed(task: Task, trimming: Trimming) -> tuple[FlightCycle, dict[str, float], str]:
    guess, near = task.guess, None
    if guess is not None:
        near = TrimGuess(guess.trimmed, list(guess.x0.values()))
    trim = trim_flight(
        task.bird.with_values(task.values),
        trimming.parameters,
        climb_rate=trimming.climb_rate,
        speed=trimming.speed,
        model=task.model,
        tolerance=trimming.tolerance,
        guess=near,
        search=asdict(task.search),
    )
    start = guess.place if guess is not None and trim.from_guess else COLD
    return trim.cycle, trim.values, start


def _answers(task: Task, cycle: FlightCycle, trimmed: Mapping[str, float]) -> dict[str, Any]:
    found = sensitivities(
        cycle, task.bird, task.model, task.values, task.steps, task.trimming, trimmed
    )
    return {"sensitivity": found, "state_scale": cycle.state_scale.tolist()}


def described(cycle: FlightCycle) -> dict[str, Any]:
    """What is kept of a limit cycle, fit for JSON: units as in `FlightCycle`, `None` for NaN."""
    model = cast("WingModel", cycle.model)
    validity = assess_validity(cycle)
    numbers = {
        "residual": cycle.residual,
        "integration_error": cycle.integration_error,
        "energy_imbalance": cycle.energy_imbalance,
        "mean_speed": cycle.mean_speed,
        "mean_pitch": cycle.mean_pitch,
        "climb_rate": cycle.mean_climb_rate,
        "path_angle": cycle.path_angle,
        "power": cycle.power,
        "potential_power": cycle.potential_power,
        "corrected_power": cycle.corrected_power,
        "cost_of_transport": cycle.cost_of_transport,
        **{f"lost_to_{name}": power for name, power in cycle.dissipation.items()},
        "largest_tail_angle": validity.largest_tail_angle,
        "period": cycle.period,
        "iterations": len(cycle.iterations) - 1,
        "steps_per_beat": model.steps_per_beat,
    }
    return {
        **{name: value if math.isfinite(value) else None for name, value in numbers.items()},
        "x0": dict(zip(cycle.state_names, cycle.x0.tolist(), strict=True)),
        "multiplier_real": cycle.multipliers.real.tolist(),
        "multiplier_imag": cycle.multipliers.imag.tolist(),
        # An error without bound is no JSON number.
        "multiplier_error": [e if math.isfinite(e) else None for e in cycle.verdict_errors],
        "monodromy": cycle.monodromy.tolist(),
        "stability": cycle.stability,
        "flight": "forwards" if cycle.why_no_flight is None else "backwards",
        "integrator": model.integration.method if isinstance(model, MultibodyModel) else "explicit",
        "warning": " ".join(validity.warnings),
    }
