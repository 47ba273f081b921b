"""The command `birdmb scale`."""

from __future__ import annotations

from pathlib import Path

import typer

import birdmb
from birdmb.cli.outcome import InputError
from birdmb.studies.scaling import scale_bird
from birdmb.topology import load_bird
from birdmb.topology.writing import bird_text


def run(mass: float, like: Path | None, out: Path | None) -> None:
    """Scale a bird and write it."""
    scaled = scale_bird(load_bird(like or _ibis()), mass)
    if out is None:
        typer.echo(bird_text(scaled.bird, scaled.assumptions), nl=False)
        return
    typer.echo(f"wrote {scaled.bird.save(out, about=scaled.assumptions)}")


def _ibis() -> Path:
    path = Path(birdmb.__file__).parent.parent / "topologies" / "ibis.toml"
    if not path.is_file():
        raise InputError(
            "The ibis is not installed with this package; name a topology file by --like."
        )
    return path
