"""The command `birdmb new`."""

from __future__ import annotations

from pathlib import Path

import typer

from birdmb.cli.morphology import save_measured_bird
from birdmb.cli.outcome import InputError
from birdmb.topology import load_bird
from birdmb.topology.shipped import bird_names, topology_file


def run(file: Path, like: str | None, morphology: Path | None) -> None:
    """Copy a bird with its comments, or make one from its morphology, under the file's name."""
    if file.exists():
        raise InputError(f"{file} is there already; name another file, or remove it first.")
    if morphology is not None:
        typer.echo(f"wrote {save_measured_bird(file, morphology, like)}")
        return
    if like is None:
        names = ", ".join(bird_names())
        raise InputError(
            f"say what to make {file} from: --like one of {names}, or a file, or --from a "
            "morphology file."
        )
    bird = load_bird(like).with_values({"name": file.stem})
    typer.echo(f"wrote {bird.save(file, like=topology_file(like))}")
