"""Reading the store of a study, and believing nothing in it that is not as it was written.

SQLite notices a file that is cut short or out of order, but not a digit that has changed. A digest
of each row, in a table of its own, does.
"""

from __future__ import annotations

import hashlib
import json
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from birdmb.studies.sweeps.errors import SweepError
from birdmb.studies.sweeps.grid import Grid, Place
from birdmb.studies.sweeps.tasks import Outcome
from birdmb.text import on_one_line

APPLICATION = 0x62697264  # "bird": tells a study from any other SQLite file
FORMAT = 6
COLUMNS = "place, parameters, status, reason, start, result, seconds, finished, run"
_IDENTITY = {"birdmb", "fingerprint", "bird", "model", "search", "trim", "keep_to_sheet"}


@dataclass(frozen=True)
class Contents:
    """What a store holds: what it was made of, its grid, and the points finished so far."""

    identity: dict[str, Any]
    grid: Grid
    points: dict[Place, Outcome]


def digest(row: tuple[Any, ...]) -> str:
    """Digest of the values of a row, in the order of its columns."""
    return hashlib.sha256(json.dumps(row).encode()).hexdigest()


def contents(path: Path, connection: sqlite3.Connection) -> Contents:
    """All that a store holds.

    Raises:
        SweepError: it is no study, one of another format, or damaged.
    """
    application, form = (_pragma(connection, name) for name in ("application_id", "user_version"))
    if application != APPLICATION:
        raise SweepError(f"{path} is no study; give the store another name.")
    if form != FORMAT:
        raise SweepError(
            f"{path} is of format {form}; this birdmb reads and fills studies of format {FORMAT}: "
            f"give this one another store."
        )
    with _damage_told(path):
        if _pragma(connection, "quick_check(1)") != "ok":
            raise ValueError("its pages are out of order")
        digests = dict(connection.execute("select row, digest from digests"))
        study = {
            row[0]: json.loads(row[1])
            for row in _sound(connection, digests, "study", "select key, value from study")
        }
        grid = _grid(study["grid"])
        identity = study["identity"]
        if not identity.keys() >= _IDENTITY:
            raise ValueError("it does not say what it was made of")
        rows = _sound(connection, digests, "point", f"select {COLUMNS} from points")
        points = dict(_point(row, grid) for row in rows)
    return Contents(identity, grid, points)


def digest_key(kind: str, key: str) -> str:
    """Name of the digest of a row of the study ("study") or of a point ("point")."""
    return f"{kind} {key}"


@contextmanager
def _damage_told(path: Path) -> Iterator[None]:
    try:
        yield
    except (
        ArithmeticError,
        AttributeError,
        LookupError,
        RecursionError,
        TypeError,
        ValueError,
        sqlite3.Error,
    ) as error:
        reason = on_one_line(str(error)) or type(error).__name__
        raise SweepError(
            f"{path} is damaged ({reason}): restore it from a copy, or give the study another "
            f"store."
        ) from error


def _pragma(connection: sqlite3.Connection, name: str) -> Any:
    return connection.execute(f"pragma {name}").fetchone()[0]


def _sound(
    connection: sqlite3.Connection, digests: Mapping[str, str], kind: str, query: str
) -> Iterator[tuple[Any, ...]]:
    for row in connection.execute(query):
        if digests.get(digest_key(kind, row[0])) != digest(row):
            raise ValueError(f"{row[0]} is not as it was written")
        yield row


def _grid(parameters: Mapping[str, list[Any]]) -> Grid:
    grid = Grid({name: tuple(values) for name, values in parameters.items()})
    if not grid.parameters or 0 in grid.shape:
        raise ValueError("its grid is empty")
    return grid


def _point(row: tuple[Any, ...], grid: Grid) -> tuple[Place, Outcome]:
    place = tuple(json.loads(row[0]))
    inside = len(place) == len(grid.shape) and all(
        type(i) is int and 0 <= i < n for i, n in zip(place, grid.shape, strict=True)
    )
    if not inside or json.loads(row[1]) != grid.values(place):
        raise ValueError(f"{row[0]} is no place of its grid")
    _, _, status, reason, start, result, seconds, _, _ = row
    if (status == "found") != (result is not None):
        raise ValueError(f"{row[0]} is {status}, and its result says otherwise")
    return place, Outcome(result and json.loads(result), reason, start, seconds)
