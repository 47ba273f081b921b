"""The command `birdmb trim`."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import typer

from birdmb.cli.birds import lasting, requested_bird
from birdmb.cli.console import messages
from birdmb.cli.models import model_class
from birdmb.cli.outcome import ResultUnwrittenError
from birdmb.cli.progress import Progress
from birdmb.cli.results import result_object, taken_as_prescribed, verdict_sentence
from birdmb.errors import OutputError
from birdmb.studies.trim import Trim, trim_flight
from birdmb.studies.validity import assess_validity
from birdmb.topology import Bird
from birdmb.topology.shipped import topology_file


def run(
    bird: Bird,
    topology: str,
    assignments: Sequence[str],
    parameters: Mapping[str, tuple[float, float]] | None,
    climb_rate: float,
    speed: float | None,
    *,
    model: str,
    out: Path | None,
    as_json: bool,
) -> None:
    """Trim, and say to what, by which values, and how it flies then.

    `bird` is that of the file `topology` with the values of `assignments`.
    """
    progress = Progress(messages())
    with progress.shown():
        progress.doing("trimming the flight")
        found = trim_flight(
            bird,
            parameters,
            climb_rate=climb_rate,
            speed=speed,
            model=model_class(model),
        )
        validity = assess_validity(found.cycle)
        told: dict[str, object] = {
            "trim": {"values": found.values, "residual": found.residual},
            **result_object(found.cycle, validity, model),
        }
        held = taken_as_prescribed(found.cycle.model)
    if held:
        progress.line(
            f"The {model} model takes {', '.join(held)} as prescribed: springs and dampers are not "
            "used."
        )
    if not as_json:
        for line in _lines(found):
            typer.echo(line)
        for warning in validity.warnings:
            typer.echo(f"outside the model's validity: {warning}")
    written: list[Path] = []
    if out is not None:
        targets = f"climb rate {climb_rate:g} m/s"
        if speed is not None:
            targets += f", speed {speed:g} m/s"
        kept, passing = lasting(assignments)
        about = [f"Trimmed to {targets} ({model} model): {_listed(found.values)}."]
        about += [f"Set before: {text}." for text in kept]
        about += [f"Found with {text}, which is not kept." for text in passing]
        trimmed = requested_bird(topology, kept).with_values(found.values)
        try:
            written = [trimmed.save(out, like=topology_file(topology), about=about)]
        except OutputError as error:
            raise ResultUnwrittenError(str(error), told) from error
        if not as_json:
            typer.echo(f"wrote {written[0]}")
            if passing:
                typer.echo(f"  with its own discretisation, not the {passing[-1]} of this search")
    if as_json:
        told["files"] = list(map(str, written))
        json.dump(told, sys.stdout, allow_nan=False, indent=2)
        sys.stdout.write("\n")


def _lines(found: Trim) -> Iterator[str]:
    """Values, speed, costs and verdict."""
    cycle = found.cycle
    for name, value in found.values.items():
        yield f"{name} = {value:.6g}"
    yield (
        f"speed {cycle.mean_speed:.4f} m/s, climb rate {cycle.mean_climb_rate:+.1e} m/s, power "
        f"{cycle.power:.4f} W, cost of transport {cycle.cost_of_transport:.4f}"
    )
    yield verdict_sentence(cycle)


def _listed(values: Mapping[str, float]) -> str:
    return ", ".join(f"{name} = {value:.6g}" for name, value in values.items())
