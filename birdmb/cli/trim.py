"""The command `birdmb trim`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import typer

from birdmb.cli.birds import lasting, requested_bird
from birdmb.cli.console import messages
from birdmb.cli.models import model_class
from birdmb.cli.progress import Progress
from birdmb.cli.results import taken_as_prescribed, verdict_sentence
from birdmb.studies.trim import trim_flight
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
        cycle = found.cycle
        warnings = assess_validity(cycle).warnings
        held = taken_as_prescribed(cycle.model)
    if held:
        progress.line(
            f"The {model} model takes {', '.join(held)} as prescribed: springs and dampers are not "
            "used."
        )
    for name, value in found.values.items():
        typer.echo(f"{name} = {value:.6g}")
    typer.echo(
        f"speed {cycle.mean_speed:.4f} m/s, climb rate {cycle.mean_climb_rate:+.1e} m/s, power "
        f"{cycle.power:.4f} W, cost of transport {cycle.cost_of_transport:.4f}"
    )
    typer.echo(verdict_sentence(cycle))
    for warning in warnings:
        typer.echo(f"outside the model's validity: {warning}")
    if out is not None:
        targets = f"climb rate {climb_rate:g} m/s"
        if speed is not None:
            targets += f", speed {speed:g} m/s"
        kept, passing = lasting(assignments)
        about = [f"Trimmed to {targets} ({model} model): {_listed(found.values)}."]
        about += [f"Set before: {text}." for text in kept]
        about += [f"Found with {text}, which is not kept." for text in passing]
        trimmed = requested_bird(topology, kept).with_values(found.values)
        typer.echo(f"wrote {trimmed.save(out, like=topology_file(topology), about=about)}")
        if passing:
            typer.echo(f"  with its own discretisation, not the {passing[-1]} of this search")


def _listed(values: Mapping[str, float]) -> str:
    return ", ".join(f"{name} = {value:.6g}" for name, value in values.items())
