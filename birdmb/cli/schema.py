"""The command `birdmb schema`."""

from __future__ import annotations

import json
from pathlib import Path

import typer

from birdmb.files import write_whole
from birdmb.topology.format_page import format_page
from birdmb.topology.schema import topology_schema


def run(markdown: bool, out: Path | None) -> None:
    """Print or write the schema, or the page that is made of it."""
    text = format_page() if markdown else f"{json.dumps(topology_schema(), indent=2)}\n"
    if out is None:
        typer.echo(text, nl=False)
        return
    typer.echo(f"wrote {write_whole(out, text.encode())}")
