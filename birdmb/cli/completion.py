"""What the shell offers at the Tab key: birds, files, dotted names.

It runs at every key, so that nothing is imported that computes.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import typer

from birdmb.errors import BirdmbError


def birds_and_files(incomplete: str) -> Iterator[str]:
    """Birds of the package, and topology files and directories below the path that was begun."""
    from birdmb.topology.shipped import bird_names  # noqa: PLC0415 - slow to import

    yield from (name for name in bird_names() if name.startswith(incomplete))
    folder, _, _ = incomplete.rpartition("/")
    if folder or not incomplete.startswith("/"):
        yield from _files(Path(folder or "."), f"{folder}/" if folder else "", incomplete)


def _files(folder: Path, prefix: str, incomplete: str) -> Iterator[str]:
    try:
        found = sorted(folder.iterdir())
    except OSError:
        return
    for path in found:
        text = f"{prefix}{path.name}"
        if not text.startswith(incomplete) or path.name.startswith("."):
            continue
        if path.is_dir():
            yield f"{text}/"
        elif path.suffix == ".toml":
            yield text


def dotted_names(context: typer.Context, incomplete: str) -> Iterator[str]:
    """Dotted names of the bird that stands before on the line, or else of the ibis."""
    from birdmb.topology import load_bird  # noqa: PLC0415 - slow to import

    topology = context.params.get("topology") or "ibis"
    try:
        names = load_bird(topology).value_names()
    except BirdmbError:
        return
    yield from (name for name in names if name.startswith(incomplete))


def assigned_names(context: typer.Context, incomplete: str) -> Iterator[str]:
    """As `dotted_names`, each with the equals sign that a value follows."""
    if "=" not in incomplete:
        yield from (f"{name}=" for name in dotted_names(context, incomplete))
