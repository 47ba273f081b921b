"""The bird that a command line asks for."""

from collections.abc import Sequence
from pathlib import Path

from birdmb.cli.outcome import InputError
from birdmb.topology import Bird, load_bird, parse_assignment


def requested_bird(topology: Path, assignments: Sequence[str]) -> Bird:
    """The bird of a topology file with the values of `NAME=VALUE` assignments.

    Raises:
        TopologyError: the file, a name or a value is wrong.
        InputError: a name is assigned twice.
    """
    bird = load_bird(topology)
    values: dict[str, object] = {}
    for name, value in map(parse_assignment, assignments):
        if name in values:
            raise InputError(f"--set gives {name} twice; keep one of the two.")
        values[name] = value
    return bird.with_values(values) if values else bird
