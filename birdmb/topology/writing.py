"""Writing a bird as a topology file."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import Any

import tomli_w

from birdmb.files import write_whole
from birdmb.text import on_one_line
from birdmb.topology.bird import Bird
from birdmb.topology.parts import Part

_DIGITS = 12
_OFF_DIAGONAL = [(i, j) for i in range(3) for j in range(3) if i != j]
_NUMBERS = re.compile(r"\[\n([-+\d.e,\s]+)\]")


def bird_text(bird: Bird, about: Sequence[str] = ()) -> str:
    """A bird as TOML that `load_bird` reads as the same bird; what it left to defaults is left out.

    `about` are lines of comment to put before it, each on one line whatever it holds. Angles
    are in degrees where that is exact.
    """
    comments = "".join(f"# {on_one_line(line)}".rstrip() + "\n" for line in about)
    return f"{comments}\n{_NUMBERS.sub(_on_one_line, tomli_w.dumps(_table(bird)))}"


def _on_one_line(found: re.Match[str]) -> str:
    return f"[{', '.join(found[1].replace(',', ' ').split())}]"


def write_bird(bird: Bird, path: str | PathLike[str], about: Sequence[str] = ()) -> Path:
    """Write `bird_text` into a file; return its path.

    Raises:
        OutputError: the file cannot be written.
    """
    return write_whole(path, bird_text(bird, about).encode())


def _table(part: Part) -> dict[str, Any]:
    dumped = part.model_dump(exclude_unset=True)
    table: dict[str, Any] = {}
    for key, plain in dumped.items():
        value = getattr(part, key)
        if value is None:
            continue
        if key in part.angles:
            table |= _angle(key, value)
        elif key == "inertia" and all(plain[i][j] == 0.0 for i, j in _OFF_DIAGONAL):
            table[key] = [plain[i][i] for i in range(3)]
        elif isinstance(value, Part):
            table[key] = _table(value)
        elif isinstance(value, tuple) and value and isinstance(value[0], Part):
            table[key] = [_table(item) for item in value]
        else:
            table[key] = plain
    return table


def _angle(key: str, value: float | tuple[float, ...]) -> dict[str, float | list[float]]:
    if isinstance(value, tuple):
        each = [_degrees(angle) for angle in value]
        if all(degrees is not None for degrees in each):
            return {f"{key}_deg": [degrees for degrees in each if degrees is not None]}
        return {key: list(value)}
    degrees = _degrees(value)
    return {key: value} if degrees is None else {f"{key}_deg": degrees}


def _degrees(angle: float) -> float | None:
    """An angle in degrees, of few digits; None where these are not exactly the angle."""
    degrees = float(f"{math.degrees(angle):.{_DIGITS}g}")
    return degrees if math.radians(degrees) == angle else None
