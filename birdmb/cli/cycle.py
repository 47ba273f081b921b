"""The command `birdmb cycle`."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from birdmb.cli.console import messages, output
from birdmb.cli.drawing import Pictures
from birdmb.cli.files import prepare, write_results
from birdmb.cli.outcome import NO_CYCLE, ResultUnwrittenError
from birdmb.cli.progress import Progress, at_work
from birdmb.cli.report import print_report
from birdmb.cli.results import (
    mean_flight,
    other_flights_sentence,
    result_object,
)
from birdmb.cli.searching import TRIM, Search, announce, found_flight, model_of, other_flights
from birdmb.errors import BirdmbError, OutputError
from birdmb.studies import assess_validity, memory_effect

if TYPE_CHECKING:
    from birdmb.cli.saved_guess import SavedGuess
    from birdmb.models import FlightCycle
    from birdmb.models.multibody import MultibodyModel
    from birdmb.models.rigid import RigidModel
    from birdmb.topology import Bird


def run(
    bird: Bird,
    search: Search,
    *,
    guess: SavedGuess | None,
    out: Path | None,
    pictures: Pictures,
    as_json: bool,
    with_memory: bool,
) -> None:
    """Find the limit cycle, report it on standard output and write it into `out`."""
    if out is not None:
        prepare(out)
    progress = Progress(messages())
    with at_work(progress, out):
        model = model_of(bird, search.model, search.motion, search.steps_per_beat)
        cycle = _found(model, search, guess, progress)
        progress.doing("loads and power over the beat")
        validity = assess_validity(cycle)
        others = other_flights(model, cycle, progress)
        found = {
            **result_object(cycle, validity, search.model),
            "other_flights": None if others is None else list(map(mean_flight, others)),
        }
        effect = None
        if with_memory:
            effect, found["memory"] = _of_memory(cycle, progress)
    if not as_json:
        print_report(output(), cycle, validity)
        if others:
            output().print(other_flights_sentence(others), highlight=False)
        if effect is not None:
            output().print(effect, highlight=False)
    written: list[Path] = []
    if out is not None:
        try:
            with at_work(progress, out):
                written = write_results(cycle, out, pictures, progress)
        except OutputError as error:
            raise ResultUnwrittenError(str(error), found) from error
    if as_json:
        json.dump(
            {**found, "files": list(map(str, written))}, sys.stdout, allow_nan=False, indent=2
        )
        sys.stdout.write("\n")
    else:
        for path in written:
            progress.line(f"wrote {path}")
    if cycle.why_no_flight is not None:
        progress.line(f"No flight found. What to do next: {TRIM}.")
        raise typer.Exit(NO_CYCLE)


def _of_memory(cycle: FlightCycle, progress: Progress) -> tuple[str, dict[str, object]]:
    """What the memory of the air changes, as a sentence and as an object for JSON."""
    progress.doing("the flight in the other air")
    try:
        effect = memory_effect(cycle)
    except BirdmbError as error:
        why = f"Nothing can be said of the memory of the air: {error}"
        return why, {"error": str(error)}
    flights = {"unsteady": effect.unsteady, "quasi-steady": effect.quasi_steady}
    return str(effect), {
        "changes_verdict": effect.changes_verdict,
        "multiplier_change": effect.multiplier_change,
        **{
            name: {
                **mean_flight(flight),
                "stability": flight.stability,
                "largest_multiplier": float(abs(flight.multipliers).max()),
                "corrected_power": flight.corrected_power,
            }
            for name, flight in flights.items()
        },
    }


def _found(
    model: RigidModel | MultibodyModel, search: Search, guess: SavedGuess | None, progress: Progress
) -> FlightCycle:
    announce(model, search.model, progress)
    if guess is not None:
        progress.line(f"Starting from {guess.about}.")
    return found_flight(model, search, guess, progress)
