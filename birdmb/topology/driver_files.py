"""Samples of drivers from CSV files that a topology file names."""

from __future__ import annotations

import csv
import io
import math
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from birdmb.errors import TopologyError
from birdmb.topology.joints import SIDES
from birdmb.topology.messages import shown

_LARGEST = 1_000_000  # bytes
_CLOSED = 0.02  # of the range: within it, the end of a beat repeats its beginning
_LARGEST_ANGLE = 1e3  # rad
_TIMES = ("time", "time_s", "t", "t_s")


class _Wanted(NamedTuple):
    """A driver whose samples are in a file: its table, and who asks for it."""

    table: dict[str, Any]
    where: str  # topology file and key, for errors
    columns: tuple[str, ...]  # names of the angle's column, in rad, those to look for first


def with_driver_files(document: dict[str, Any], topology: Path) -> dict[str, Any]:
    """A document of a bird in which the samples stand that the file named by `file` holds.

    Raises:
        TopologyError: a file cannot be read or holds no samples.
    """
    for wanted in _wanted(document, str(topology)):
        where, named = wanted.where, wanted.table.pop("file")
        if not (isinstance(named, str) and named and named.isprintable()):
            raise TopologyError(f"{where}: must be the path of a CSV file, not {shown(named)}")
        for key in ("samples", "samples_deg", "sample_phases"):
            if key in wanted.table:
                raise TopologyError(
                    f"{where}: file and {key} do not go together; the file gives the samples"
                )
        path = topology.parent / named
        wanted.table.update(_samples(f"{where}: {path}", _rows(where, path), wanted.columns))
    return document


def move_driver_files(document: dict[str, Any], origin: Path, target: Path) -> None:
    """Let a document name the same files from another topology file's folder."""
    for wanted in _wanted(document, str(origin)):
        named = wanted.table["file"]
        if isinstance(named, str) and origin.resolve().parent != target.resolve().parent:
            there = os.path.relpath(origin.resolve().parent / named, target.resolve().parent)
            wanted.table["file"] = Path(there).as_posix()


def _wanted(document: Mapping[str, Any], topology: str) -> Iterator[_Wanted]:
    # What is no list of tables is for the validation to complain about.
    joints = document.get("joints")
    for joint in joints if isinstance(joints, list) else ():
        if not isinstance(joint, dict):
            continue
        name = str(joint.get("name"))
        if "file" in joint:
            yield _Wanted(joint, f"{topology}: {name}.file", (name, "angle"))
        for side in SIDES:
            own = joint.get(side)
            if isinstance(own, dict) and "file" in own:
                yield _Wanted(
                    own, f"{topology}: {name}.{side}.file", (f"{name}.{side}", name, "angle")
                )


def _rows(where: str, path: Path) -> list[tuple[int, list[str]]]:
    """The rows of a CSV file that are not empty, with the numbers of their lines."""
    try:
        with path.open("rb") as file:
            content = file.read(_LARGEST + 1)
        if len(content) > _LARGEST:
            raise TopologyError(f"{where}: {path} is larger than 1 MB; one beat has a few kB")
        reader = csv.reader(io.StringIO(content.decode("utf-8-sig")))
        rows = [(reader.line_num, [cell.strip() for cell in row]) for row in reader if any(row)]
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "no text in UTF-8"
        raise TopologyError(f"{where}: {path} cannot be read ({reason.lower()})") from error
    except csv.Error as error:
        raise TopologyError(f"{where}: {path} is no CSV file: {error}") from error
    if not rows:
        raise TopologyError(f"{where}: {path} is empty; it must have a header and rows of numbers")
    return rows


def _samples(
    origin: str, rows: list[tuple[int, list[str]]], columns: tuple[str, ...]
) -> dict[str, list[float]]:
    """The keys of a joint that say what is in the rows of a file."""
    line, header = rows[0]
    named = [each for column in columns for each in (f"{column}_deg", column) if each in header]
    if not named:
        wanted = ", ".join(each for column in columns for each in (f"{column}_deg", column))
        semicolons = "; commas must separate the columns" if ";" in "".join(header) else ""
        raise TopologyError(
            f"{origin}, line {line}: no column of angles; the header must have one of {wanted}"
            f"{semicolons}"
        )
    for column in (named[0], "phase"):
        if header.count(column) > 1:
            raise TopologyError(f"{origin}, line {line}: two columns are called {column}; keep one")
    if named[0].endswith("_deg") and named[0].removesuffix("_deg") in named:
        raise TopologyError(
            f"{origin}, line {line}: has both {named[0]} and {named[0].removesuffix('_deg')}; keep "
            "one"
        )
    in_degrees = named[0].endswith("_deg")
    largest = math.degrees(_LARGEST_ANGLE) if in_degrees else _LARGEST_ANGLE
    angles = _column(origin, rows, named[0], largest)
    found = {"samples_deg" if in_degrees else "samples": angles}
    times = [column for column in header if column.lower() in _TIMES]
    if times and "phase" not in header:
        # Even samples over the beat are what would be taken instead, without a word.
        raise TopologyError(
            f"{origin}, line {line}: samples have no {times[0]} but a phase, the part of the beat "
            "from 0 to 1; give that, or leave the column out if they are even"
        )
    if "phase" in header:
        found["sample_phases"] = _phases(origin, rows, angles)
    return found


def _column(
    origin: str, rows: list[tuple[int, list[str]]], name: str, largest: float
) -> list[float]:
    header = rows[0][1]
    numbers = []
    for line, row in rows[1:]:
        if len(row) != len(header):
            raise TopologyError(
                f"{origin}, line {line}: has {len(row)} cells, the header has {len(header)}"
            )
        cell = row[header.index(name)]
        try:
            number = float(cell)
        except ValueError:
            number = math.nan
        if not abs(number) <= largest:
            raise TopologyError(
                f"{origin}, line {line}: {name} must be a number from {-largest:.6g} to "
                f"{largest:.6g}, not {shown(cell)}"
            )
        numbers.append(number)
    return numbers


def _phases(origin: str, rows: list[tuple[int, list[str]]], angles: list[float]) -> list[float]:
    """Phases below 1; the end of the beat leaves `angles` where it repeats the beginning."""
    phases = _column(origin, rows, "phase", 1.0)
    lines = [line for line, _ in rows[1:]]
    for k, phase in enumerate(phases):
        if phase < 0.0 or (k > 0 and phase <= phases[k - 1]):
            raise TopologyError(
                f"{origin}, line {lines[k]}: phases must ascend from 0 to 1, not be {phase:g} here"
            )
    if not phases or phases[-1] < 1.0:
        return phases
    if phases[0] > 0.0:
        angles.insert(0, angles.pop())
        return [0.0, *phases[:-1]]
    if abs(angles[-1] - angles[0]) > _CLOSED * (max(angles) - min(angles)):
        raise TopologyError(
            f"{origin}, line {lines[-1]}: the angle at phase 1 is {angles[-1]:g}, that at phase 0 "
            f"{angles[0]:g}; a beat must end as it begins"
        )
    angles.pop()
    return phases[:-1]
