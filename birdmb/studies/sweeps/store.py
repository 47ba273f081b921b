"""The file that a study is kept in: SQLite, one transaction for each point."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import version
from os import PathLike
from pathlib import Path
from typing import Any

from birdmb.studies.sweeps.errors import SweepError
from birdmb.studies.sweeps.grid import Grid, Place
from birdmb.studies.sweeps.point import Outcome
from birdmb.studies.sweeps.settings import difference

_APPLICATION = 0x62697264  # "bird": tells a study from any other SQLite file
_FORMAT = 3
# Packages whose version may change the last bits of a result.
_SOFTWARE = ("birdmb", "exudyn", "numba", "numpy", "scipy")
_TABLES = (
    "create table study (key text primary key, value text not null)",
    "create table runs (run integer primary key, started text not null, software text not null)",
    """create table points (
        place text primary key, parameters text not null, status text not null,
        reason text not null, start text not null, result text, seconds real not null,
        finished text not null, run integer not null references runs
    )""",
)


@dataclass(frozen=True)
class Contents:
    """What a store holds: what it was made of, its grid, and the points finished so far."""

    identity: dict[str, Any]
    grid: Grid
    points: dict[Place, Outcome]


def place_text(place: Place) -> str:
    """A place as the store writes it: `[3, 1]`."""
    return json.dumps(place)


class Store:
    """A store open for writing, by one process at a time."""

    def __init__(self, path: Path, connection: sqlite3.Connection, contents: Contents) -> None:
        self._path, self._connection = path, connection
        self.contents = contents
        with self._transaction():
            software = {name: version(name) for name in _SOFTWARE}
            self._run = connection.execute(
                "insert into runs (started, software) values (?, ?)", (_now(), json.dumps(software))
            ).lastrowid

    @classmethod
    @contextmanager
    def opened(
        cls, path: str | PathLike[str], identity: Mapping[str, Any], grid: Grid
    ) -> Iterator[Store]:
        """The store of a study, made if there is none; values that the grid appends are added.

        Raises:
            SweepError: the file is no study, is one of another bird, of other settings or another
                grid, or cannot be written.
        """
        path = Path(path)
        with _told(path), closing(sqlite3.connect(path, isolation_level=None)) as connection:
            with connection:
                connection.execute("begin immediate")
                if not _tables(connection):
                    _create(connection, identity, grid)
                contents = _contents(path, connection)
                _refuse_another(path, contents, identity, grid)
                _put(connection, "grid", grid.parameters)
            connection.execute("pragma journal_mode = wal")  # others can read meanwhile
            connection.execute("pragma synchronous = full")
            yield cls(path, connection, contents)

    def add(self, grid: Grid, place: Place, outcome: Outcome) -> None:
        """Keep a finished point; when this returns, it survives whatever happens.

        Raises:
            SweepError: the point is there already, because another sweep fills the same store.
        """
        row = (
            place_text(place),
            json.dumps(grid.values(place)),
            "failed" if outcome.result is None else "found",
            outcome.reason,
            outcome.start,
            None if outcome.result is None else json.dumps(outcome.result),
            outcome.seconds,
            _now(),
            self._run,
        )
        try:
            with self._transaction():
                self._connection.execute(f"insert into points values ({','.join('?' * 9)})", row)
        except sqlite3.IntegrityError as error:
            raise SweepError(
                f"{self._path}: another sweep is filling this store; let it finish, or end it."
            ) from error

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        with _told(self._path), self._connection:
            self._connection.execute("begin immediate")
            yield


def read(path: str | PathLike[str]) -> Contents:
    """What a store holds now; a sweep may be filling it meanwhile.

    Raises:
        SweepError: there is no such file, or it is no study.
    """
    path = Path(path)
    if not path.is_file():
        raise SweepError(f"{path}: there is no such study.")
    # Not read-only, which would leave the files of the write-ahead log behind.
    uri = f"{path.absolute().as_uri()}?mode=rw"
    with _told(path), closing(sqlite3.connect(uri, uri=True)) as connection:
        return _contents(path, connection)


@contextmanager
def _told(path: Path) -> Iterator[None]:
    try:
        yield
    except sqlite3.IntegrityError:
        raise
    except sqlite3.Error as error:
        raise SweepError(f"{path} cannot be used as the store of a study ({error}).") from error


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def _tables(connection: sqlite3.Connection) -> set[str]:
    return {name for (name,) in connection.execute("select name from sqlite_master")}


def _create(connection: sqlite3.Connection, identity: Mapping[str, Any], grid: Grid) -> None:
    connection.execute(f"pragma application_id = {_APPLICATION}")
    connection.execute(f"pragma user_version = {_FORMAT}")
    for table in _TABLES:
        connection.execute(table)
    _put(connection, "identity", identity)
    _put(connection, "grid", grid.parameters)


def _put(connection: sqlite3.Connection, key: str, value: Mapping[str, Any]) -> None:
    connection.execute("insert or replace into study values (?, ?)", (key, json.dumps(value)))


def _contents(path: Path, connection: sqlite3.Connection) -> Contents:
    application, form = (
        connection.execute(f"pragma {name}").fetchone()[0]
        for name in ("application_id", "user_version")
    )
    if application != _APPLICATION:
        raise SweepError(f"{path} is no study; give the store another name.")
    if form != _FORMAT:
        raise SweepError(f"{path} is of format {form}; this birdmb reads format {_FORMAT}.")
    study = {key: json.loads(value) for key, value in connection.execute("select * from study")}
    grid = Grid({name: tuple(values) for name, values in study["grid"].items()})
    rows = connection.execute("select place, result, reason, start, seconds from points")
    points = {
        tuple(json.loads(place)): Outcome(result and json.loads(result), reason, start, seconds)
        for place, result, reason, start, seconds in rows
    }
    return Contents(study["identity"], grid, points)


def _refuse_another(
    path: Path, contents: Contents, identity: Mapping[str, Any], grid: Grid
) -> None:
    # What has been through JSON once is compared: tuples are lists there.
    apart = difference(contents.identity, json.loads(json.dumps(identity)))
    if apart is not None:
        raise SweepError(f"{path} holds another study: {apart}; give this one another store.")
    if grid.extends(contents.grid):
        return
    stored, asked = contents.grid.parameters, grid.parameters
    if list(stored) != list(asked):
        raise SweepError(
            f"{path} holds another study: it varies {', '.join(stored)}, in this order, not "
            f"{', '.join(asked)}; give this one another store."
        )
    name = next(n for n, values in stored.items() if asked[n][: len(values)] != values)
    listed = ", ".join(map(str, stored[name]))
    raise SweepError(
        f"{path} holds another grid: the values of {name} there are {listed}; more may be appended "
        f"to them, but they must stay, and first."
    )
