"""Reading a bird from a topology file."""

from __future__ import annotations

from os import PathLike

from birdmb.topology.bird import Bird
from birdmb.topology.documents import read_document
from birdmb.topology.messages import validated


def load_bird(path: str | PathLike[str]) -> Bird:
    """Read and validate a topology file (TOML).

    Raises `TopologyError`, one sentence naming file, key, value and what would be right, if the
    file cannot be read or does not describe a possible bird.
    """
    _, document = read_document(path)
    return validated(Bird, document, str(path))
