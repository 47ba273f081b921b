"""What `--vary` asks for."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from birdmb.cli.outcome import InputError
from birdmb.topology import Bird, parse_assignment

_RANGE_PARTS = 3


def requested_variations(bird: Bird, texts: Sequence[str]) -> dict[str, list[Any]]:
    """Values by dotted name of `NAME=FIRST:LAST:COUNT` and `NAME=VALUE,VALUE,...`.

    Raises:
        TopologyError: the bird has no value of that name, or name, `=` or values are missing.
        InputError: a range is none, or a name is given twice.
    """
    variations: dict[str, list[Any]] = {}
    for text in texts:
        name, _, listed = text.partition("=")
        name = name.strip()
        values = _range(text, listed) if ":" in listed else _list(name, listed)
        bird.value(name)
        if name in variations:
            raise InputError(f"--vary gives {name} twice; keep one of the two.")
        variations[name] = values
    return variations


def _list(name: str, listed: str) -> list[Any]:
    return [parse_assignment(f"{name}={value}")[1] for value in listed.split(",")]


def _range(text: str, listed: str) -> list[Any]:
    parts = listed.split(":")
    try:
        first, last, count = float(parts[0]), float(parts[1]), int(parts[2])
    except (ValueError, IndexError):
        count = 0
    if count < 2 or len(parts) != _RANGE_PARTS or not math.isfinite(last - first):
        raise InputError(
            f'--vary "{text}" must read NAME=FIRST:LAST:COUNT, with two values or more, as in '
            "shoulder.flap.stiffness=5:60:24."
        )
    return list(np.linspace(first, last, count).tolist())
