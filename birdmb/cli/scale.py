"""The command `birdmb scale`."""

from __future__ import annotations

from pathlib import Path

import typer

from birdmb.studies.scaling import scale_bird
from birdmb.topology import load_bird
from birdmb.topology.writing import bird_text


def run(
    mass: float | None,
    span: float | None,
    frequency: float | None,
    like: str,
    out: Path | None,
) -> None:
    """Scale a bird and write it."""
    scaled = scale_bird(load_bird(like), mass, span=span, frequency=frequency)
    if out is None:
        typer.echo(bird_text(scaled.bird, scaled.assumptions), nl=False)
        return
    typer.echo(f"wrote {scaled.bird.save(out, about=scaled.assumptions)}")
