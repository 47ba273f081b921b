"""The command `birdmb flights`."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import typer

from birdmb.cli.console import messages, output
from birdmb.cli.files import prepare
from birdmb.cli.outcome import NO_CYCLE, ResultUnwrittenError, SearchFailed
from birdmb.cli.progress import Progress, at_work
from birdmb.cli.results import result_object
from birdmb.cli.searching import TRIM, announce, deflations_for, model_of, number_of, told
from birdmb.cli.tables import table_of
from birdmb.errors import OutputError
from birdmb.orbits import find_limit_cycles
from birdmb.studies import assess_validity

if TYPE_CHECKING:
    from rich.table import Table

    from birdmb.models import FlightCycle
    from birdmb.models.motion import FlightMotionName
    from birdmb.studies import Validity
    from birdmb.topology import Bird

_STYLES = {"stable": "green", "unstable": "red", "undecided": "yellow"}


def run(
    bird: Bird, model_name: str, motion: FlightMotionName, *, out: Path | None, as_json: bool
) -> None:
    """Find the flights of a bird, list them on standard output and write them into `out`."""
    if out is not None:
        prepare(out)
    progress = Progress(messages())
    with at_work(progress, out):
        cycles = _found(bird, model_name, motion, progress)
        progress.doing("loads and power over the beats")
        validity = [assess_validity(cycle) for cycle in cycles]
        objects: list[dict[str, object]] = [
            result_object(cycle, valid, model_name)
            for cycle, valid in zip(cycles, validity, strict=True)
        ]
    if not as_json:
        output().print(_table(cycles, validity))
        for number, each in enumerate(zip(cycles, validity, strict=True), 1):
            for remark in _remarks(number, *each):
                output().print(remark, style="yellow", highlight=False)
    if out is not None:
        try:
            with at_work(progress, out):
                for number, cycle in enumerate(cycles, 1):
                    path = out / f"flight_{number}.nc"
                    cycle.save(path)
                    objects[number - 1]["files"] = [str(path)]
                    progress.line(f"wrote {path}")
        except OutputError as error:
            raise ResultUnwrittenError(str(error), {"flights": objects}) from error
    if as_json:
        json.dump(objects, sys.stdout, allow_nan=False, indent=2)
        sys.stdout.write("\n")
    if all(cycle.why_no_flight is not None for cycle in cycles):
        progress.line(f"None of these is a flight. What to do next: {TRIM}.")
        raise typer.Exit(NO_CYCLE)


def _found(
    bird: Bird, model_name: str, motion: FlightMotionName, progress: Progress
) -> list[FlightCycle]:
    model = model_of(bird, model_name, motion, None)
    announce(model, model_name, progress)
    progress.doing("laying out the starts")
    cycles = find_limit_cycles(model, deflations=deflations_for(model), callback=told(progress))
    if not cycles:
        raise SearchFailed(
            f"{bird.name}: no limit cycle from any of the starts over speed, incidence and path "
            f"angle. What to do next: {TRIM}.",
            {"bird": bird.name, "model": model_name},
        )
    progress.line(f"Found {number_of(cycles)}. There may be others that no start leads to.")
    return cycles


def _table(cycles: list[FlightCycle], validity: list[Validity]) -> Table:
    in_space = cycles[0].model.motion.lateral.any()
    table = table_of(
        "Limit cycles, means over a beat",
        "no.", "speed, m/s", "climb", "pitch, °", *(["bank, °"] if in_space else []),
        "|Λ| max", "verdict", "warnings",
        numbers=(0, 1, 2, 3, 4, 5, 7) if in_space else (0, 1, 2, 3, 4, 6),
    )  # fmt: skip
    for number, (cycle, valid) in enumerate(zip(cycles, validity, strict=True), 1):
        count = len(valid.warnings)
        table.add_row(
            str(number),
            f"{cycle.mean_speed:.2f}",
            f"{cycle.mean_climb_rate:+.2f}",
            f"{round(np.degrees(cycle.mean_pitch)):+d}",
            *([f"{round(np.degrees(cycle.mean_bank)):+d}"] if in_space else []),
            f"{float(np.abs(cycle.multipliers[0])):.4f}",
            cycle.stability if cycle.why_no_flight is None else "no flight",
            str(count) if count else "",
            style=_STYLES[cycle.stability] if cycle.why_no_flight is None else "dim",
        )
    return table


def _remarks(number: int, cycle: FlightCycle, validity: Validity) -> list[str]:
    """What speaks against calling a cycle a flight, against its numbers, and against the model."""
    remarks = [] if cycle.why_no_flight is None else [f"no flight: {cycle.why_no_flight}"]
    remarks += [f"not to be trusted: {failed}" for failed in cycle.failed_checks]
    if cycle.why_no_flight is None:
        remarks += [f"outside the model's validity: {warning}" for warning in validity.warnings]
    return [f"{number} {remark}" for remark in remarks]
