"""The command `birdmb show`."""

from __future__ import annotations

import webbrowser
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from birdmb.animation.animation import animate, require_ending
from birdmb.cli.birds import requested_bird
from birdmb.cli.console import messages
from birdmb.cli.drawing import Pictures
from birdmb.cli.files import prepare
from birdmb.cli.outcome import NO_CYCLE, InputError
from birdmb.cli.progress import Progress, at_work
from birdmb.cli.searching import TRIM, Search, announce, found_flight, model_of
from birdmb.models import load_cycle

if TYPE_CHECKING:
    from birdmb.animation.colours import ColourName
    from birdmb.animation.stage import ViewName
    from birdmb.models import FlightCycle
    from birdmb.models.motion import FlightMotionName
    from birdmb.topology import Bird


@dataclass(frozen=True)
class Wanted:
    """Which flights: files or names, and of topologies the model; `None` is the default."""

    flights: tuple[str, ...]
    model: str | None
    motion: FlightMotionName | None
    assignments: tuple[str, ...]


@dataclass(frozen=True)
class Picture:
    """What the options say about the picture; modes are counted from 1, the phase is 0 to 1."""

    colour: ColourName
    beats: int | None
    frames: int | None
    mode: int | None
    scale: float | None
    view: ViewName
    phase: float


def run(wanted: Wanted, picture: Picture, *, out: Path | None, opened: bool) -> None:
    """Find or read the flights, and write the picture of them."""
    if picture.scale is not None and picture.mode is None:
        raise InputError("--scale is the amplitude of a mode; give --mode with it.")
    path = Path("_and_".join(_stem(flight) for flight in wanted.flights) + ".html")
    if out is not None:
        path = out
    require_ending(path)
    prepare(path.parent)
    birds = [
        None if _is_saved(f) else requested_bird(f, wanted.assignments) for f in wanted.flights
    ]
    progress = Progress(messages())
    with at_work(progress, path.parent), Pictures().style():
        cycles = [
            _saved(flight, wanted) if bird is None else _searched(bird, wanted, progress)
            for flight, bird in zip(wanted.flights, birds, strict=True)
        ]
        for cycle in cycles:
            _require_mode(cycle, picture.mode)
        progress.doing("wings, loads and wake over the flight")
        moving = animate(
            cycles,
            beats=picture.beats,
            frames=picture.frames,
            colour=picture.colour,
            mode=None if picture.mode is None else picture.mode - 1,
            scale=picture.scale,
            view=picture.view,
        )
        progress.doing(f"writing {path}")
        written, *beside = moving.save(path, phase=picture.phase)
    more = f" and {len(beside)} files in {beside[0].parent}" if beside else ""
    typer.echo(f"wrote {written}{more}")
    if opened:
        webbrowser.open(written.resolve().as_uri())
    reasons = [cycle.why_no_flight for cycle in cycles if cycle.why_no_flight is not None]
    for reason in reasons:
        progress.line(f"Not a flight: {reason}. What to do next: {TRIM}.")
    if reasons:
        raise typer.Exit(NO_CYCLE)


def _stem(flight: str) -> str:
    path = Path(flight)
    return path.stem if path.suffix in {".nc", ".toml"} else path.name


def _is_saved(flight: str) -> bool:
    return Path(flight).suffix.lower() == ".nc"


def _saved(flight: str, wanted: Wanted) -> FlightCycle:
    for option, value in (
        ("--set", wanted.assignments),
        ("--model", wanted.model),
        ("--motion", wanted.motion),
    ):
        if value:
            raise InputError(
                f"{option} is for topologies; {flight} holds a flight that was found already."
            )
    return load_cycle(flight)


def _searched(bird: Bird, wanted: Wanted, progress: Progress) -> FlightCycle:
    name, motion = wanted.model or "multibody", wanted.motion or "planar"
    model = model_of(bird, name, motion, None)
    announce(model, name, progress)
    search = Search(
        name, motion, None, 1e-9, 50, method="auto", damping="line-search", steps_per_beat=None
    )
    return found_flight(model, search, None, progress)


def _require_mode(cycle: FlightCycle, mode: int | None) -> None:
    count = len(cycle.multipliers)
    if mode is not None and mode > count:
        raise InputError(
            f"--mode: the flight of {cycle.model.bird.name} has {count} modes, not {mode}; `birdmb "
            "cycle` lists them."
        )
