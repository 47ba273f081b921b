"""Reading a bird from a topology file."""

from __future__ import annotations

from os import PathLike

from birdmb.arguments import checked
from birdmb.topology.bird import Bird
from birdmb.topology.documents import read_document
from birdmb.topology.messages import validated
from birdmb.topology.shipped import topology_file


@checked
def load_bird(bird: str | PathLike[str]) -> Bird:
    """Read and validate a topology file (TOML), or a bird of the package by its name.

    `load_bird("ibis")` is the ibis, wherever birdmb is installed (`bird_names` lists all), if there
    is no file of that name. Raises `TopologyError`, one sentence naming file, key, value and what
    would be right, if the file cannot be read or does not describe a possible bird.
    """
    _, document = read_document(topology_file(bird))
    return validated(Bird, document, str(bird))
