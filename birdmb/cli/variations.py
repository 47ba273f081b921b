"""What `--vary` and `--trim` ask for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from birdmb.cli.outcome import InputError
from birdmb.quantities import BY_NAME, IN_DEGREES
from birdmb.studies.sweeps.grid import MOST_POINTS
from birdmb.studies.sweeps.settings import Trimming
from birdmb.topology import Bird, parse_assignment

_RANGE_PARTS = 3


def requested_variations(texts: Sequence[str]) -> dict[str, list[Any]]:
    """Values by dotted name of `NAME=FIRST:LAST:COUNT` and `NAME=VALUE,VALUE,...`.

    Raises:
        TopologyError: name, `=` or values are missing.
        InputError: a range is none or too long, or a name is given twice.
    """
    variations: dict[str, list[Any]] = {}
    for text in texts:
        name, _, listed = text.partition("=")
        name = name.strip()
        values = _range(text, listed) if ":" in listed else _list(name, listed)
        if name in variations:
            raise InputError(f"--vary gives {name} twice; keep one of the two.")
        variations[name] = values
    return variations


def requested_trim(
    bird: Bird, texts: Sequence[str], climb_rate: float, speed: float | None
) -> Trimming | None:
    """What `--trim`, `--climb-rate` and `--speed` ask for; `None` without a `--trim`.

    Raises:
        TopologyError, InputError: as `requested_bounds`; or a speed without parameters.
    """
    if not texts:
        if speed is not None:
            raise InputError("--speed needs two parameters to --trim the flight by.")
        return None
    return Trimming(requested_bounds(bird, texts, speed, "--trim"), climb_rate, speed)


def requested_bounds(
    bird: Bird, texts: Sequence[str], speed: float | None, option: str
) -> dict[str, tuple[float, float]]:
    """Bounds by dotted name of `NAME=LOWEST:HIGHEST`: one, or two if a speed is wanted.

    Raises:
        TopologyError: the bird has no value of that name.
        InputError: bounds are none, or there are not as many parameters as targets.
    """
    bounds: dict[str, tuple[float, float]] = {}
    for text in texts:
        name, _, listed = text.partition("=")
        bird.value(name.strip())
        if name.strip() in bounds:
            raise InputError(f"{option} gives {name.strip()} twice; keep one of the two.")
        try:
            low, high = map(float, listed.split(":"))
        except ValueError:
            low = high = math.nan
        if not -math.inf < low < high < math.inf:
            raise InputError(
                f'{option} "{text}" must read NAME=LOWEST:HIGHEST, as in '
                "shoulder.pitch.offset_deg=-12:12."
            )
        bounds[name.strip()] = (low, high)
    targets = 1 if speed is None else 2
    if len(bounds) != targets:
        wanted = "a climb rate" if targets == 1 else "a climb rate and a speed"
        raise InputError(f"{option}: {wanted} needs {targets} parameter(s), not {len(bounds)}.")
    return bounds


def requested_limits(texts: Sequence[str]) -> dict[str, float]:
    """Largest moduli by name of `NAME=LARGEST`, in SI units and rad; of `_deg` in degrees.

    Raises:
        InputError: a limit is none, or a name is given twice.
    """
    limits: dict[str, float] = {}
    for text in texts:
        name, _, listed = (part.strip() for part in text.partition("="))
        try:
            largest = float(listed)
        except ValueError:
            largest = math.nan
        if not 0.0 <= largest < math.inf or name in limits:
            raise InputError(
                f'--limit "{text}" must read NAME=LARGEST, each name once, as in mean_pitch=6.'
            )
        in_rad = name in BY_NAME and BY_NAME[name].unit in IN_DEGREES
        limits[name] = math.radians(largest) if in_rad else largest
    return limits


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
    if count > MOST_POINTS:
        raise InputError(f'--vary "{text}": give {MOST_POINTS} values or fewer.')
    return list(np.linspace(first, last, count).tolist())
