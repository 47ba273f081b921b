"""One point of a sweep: a pure function of its task, which a worker runs."""

from __future__ import annotations

import math
import textwrap
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict
from typing import Any

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import BirdmbError, OrbitError, StateError
from birdmb.models import FlightCycle, FlightModel
from birdmb.orbits import NotSmoothError, find_limit_cycle
from birdmb.orbits.enough_nodes import FIRST_NODES
from birdmb.orbits.problem import HasGuessedPath, HasInitialGuess, HasRates
from birdmb.quantities import described_by, valid_by
from birdmb.studies.cycles import ModelFactory, path_for_search, shot_near
from birdmb.studies.sweeps.sensitivity import sensitivities
from birdmb.studies.sweeps.settings import Trimming
from birdmb.studies.sweeps.sheets import on_sheet
from birdmb.studies.sweeps.tasks import Outcome, Task
from birdmb.studies.trim import TrimGuess, trim_flight
from birdmb.studies.validity import assess_validity
from birdmb.threads import one_thread
from birdmb.topology import Bird

COLD = "cold"
_DIGITS = 6  # after the point, of states in units of their scale
_LONGEST_REASON = 600  # characters; foreign errors may bring a traceback


def compute(task: Task) -> Outcome:
    """Find the limit cycle of a point, from its neighbour's or else from the model's own guess.

    Whatever goes wrong is the outcome of the point, with its reason: a deliberate error by its
    sentence, any other by type and text. Only `KeyboardInterrupt` is raised.
    """
    began = time.perf_counter()
    start, result, reason = COLD, None, ""
    try:
        with one_thread():
            result, start = on_sheet(task, _flight) if task.keep_to_sheet else _flight(task)
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        start, reason = COLD, _told(error)
    return Outcome(result, reason, start, time.perf_counter() - began)


def _flight(task: Task) -> tuple[dict[str, Any], str]:
    """What is kept of the flight of a task, and where the search for it succeeded from."""
    if task.trimming is None:
        cycle, start = _found(task)
        trimmed = dict[str, float]()
    else:
        cycle, trimmed, start = _trimmed(task, task.trimming)
    result = described(cycle) | {"trimmed": trimmed}
    result["sensitivity"] = sensitivities(
        cycle, task.bird, task.model, task.values, task.steps, task.trimming, trimmed
    )
    return result, start


def _told(error: BaseException) -> str:
    text = textwrap.shorten(str(error), _LONGEST_REASON, placeholder=" ...")
    if isinstance(error, BirdmbError) and text:
        return text
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def prepare(bird: Bird, model: ModelFactory) -> None:
    """Load or compile the kernels, along a guess; a bird that cannot is left to its points."""
    with suppress(Exception):
        flying = model(bird)
        if isinstance(flying, HasInitialGuess):
            flying.loads(0.0, flying.initial_guess())
        if isinstance(flying, HasGuessedPath) and isinstance(flying, HasRates):
            times = bird.period * np.arange(FIRST_NODES) / FIRST_NODES
            flying.rates(times, flying.guess_along(times))


def _found(task: Task) -> tuple[FlightCycle, str]:
    model = task.model(task.bird.with_values(task.values))
    search = asdict(task.search)
    guess = task.guess
    # A varied mode of a joint may have given the neighbour other states.
    if guess is None or guess.state_names != model.state_names:
        return find_limit_cycle(model, **search), COLD
    orbit, _ = guess.moved_to(task.values, {})
    if guess.flight["method"] == "collocation":
        with suppress(NotSmoothError):
            return _collocated_near(model, guess.place, orbit, search)
    else:
        with suppress(OrbitError, StateError):
            # Of several segments only the product is kept.
            known = [guess.flight["monodromy"]] if search["segments"] in {None, 1} else None
            found = shot_near(model, orbit, known, search)
            return found, guess.place
    return find_limit_cycle(model, **search), COLD


def _collocated_near(
    model: FlightModel, place: str, orbit: FloatArray, search: Mapping[str, Any]
) -> tuple[FlightCycle, str]:
    """The cycle of a model by collocation alone, and what it was found from.

    Beside a smooth orbit, as the one (K, n) is that a neighbour's `place` leads to, there is none
    that only shooting would find, and its vain search takes a hundred times as long.
    """
    collocation = {**search, "method": "collocation"}
    try:
        found, start = find_limit_cycle(model, orbit, **collocation), place
    except NotSmoothError:
        raise
    except (OrbitError, StateError):
        found, start = find_limit_cycle(model, **collocation), COLD
    return found, start


def _trimmed(task: Task, trimming: Trimming) -> tuple[FlightCycle, dict[str, float], str]:
    guess, near = task.guess, None
    if guess is not None:
        orbit, trimmed = guess.moved_to(task.values, trimming.parameters)
        near = TrimGuess(trimmed, orbit)
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


def described(cycle: FlightCycle) -> dict[str, Any]:
    """What is kept of a limit cycle, fit for JSON: units as in `FlightCycle`, `None` for NaN."""
    model = cycle.model
    validity = assess_validity(cycle)
    numbers = {
        **described_by(cycle),
        **valid_by(validity),
        "iterations": len(cycle.iterations) - 1,
    }
    collocated = cycle.method == "collocation"
    return {
        **{name: value if math.isfinite(value) else None for name, value in numbers.items()},
        # Integrated are only cycles that were shot.
        "nodes": cycle.nodes,
        "steps_per_beat": None if collocated else model.steps_per_beat,
        "integrator": "" if collocated else model.integration_method,
        "method": cycle.method,
        "method_reason": cycle.method_reason,
        "x0": dict(zip(cycle.state_names, cycle.x0.tolist(), strict=True)),
        "multiplier_real": cycle.multipliers.real.tolist(),
        "multiplier_imag": cycle.multipliers.imag.tolist(),
        # An error without bound is no JSON number.
        "multiplier_error": [e if math.isfinite(e) else None for e in cycle.verdict_errors],
        "multiplier_mode": [mode.name or mode.plane for mode in cycle.flight_modes],
        "monodromy": cycle.monodromy.tolist(),
        "stability": cycle.stability,
        "flight": "forwards" if cycle.why_no_flight is None else "backwards",
        "state_scale": cycle.state_scale.tolist(),
        "orbit": _orbit(cycle) if collocated else None,
        "warning": " ".join(validity.warnings),
    }


def _orbit(cycle: FlightCycle) -> list[list[float]]:
    """States (K, n) of a collocated cycle in units of their scale: a guess for its neighbours.

    As few as a search from them begins with, and rounded: it only has to begin nearby.
    """
    path = path_for_search(cycle) / cycle.state_scale
    return [[round(value, _DIGITS) for value in state] for state in path.tolist()]
