"""The command `birdmb new`."""

from __future__ import annotations

from pathlib import Path

import typer

from birdmb.cli.outcome import InputError
from birdmb.topology import load_bird
from birdmb.topology.shipped import bird_names, topology_file


def run(file: Path, like: str | None) -> None:
    """Copy a bird with its comments, under the name of the file."""
    if like is None:
        names = ", ".join(bird_names())
        raise InputError(f"say what to make {file} from: --like one of {names}, or a file.")
    if file.exists():
        raise InputError(f"{file} is there already; name another file, or remove it first.")
    bird = load_bird(like).with_values({"name": file.stem})
    typer.echo(f"wrote {bird.save(file, like=topology_file(like))}")
