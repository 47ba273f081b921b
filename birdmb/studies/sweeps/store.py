"""The file that a study is kept in: SQLite, one transaction for each point."""

from __future__ import annotations

import json
import os
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from datetime import UTC, datetime
from os import PathLike
from pathlib import Path
from typing import Any

from birdmb.provenance import software
from birdmb.studies.sweeps.contents import (
    APPLICATION,
    COLUMNS,
    FORMAT,
    Contents,
    contents,
    digest,
    digest_key,
)
from birdmb.studies.sweeps.errors import SweepError
from birdmb.studies.sweeps.grid import Grid, Place
from birdmb.studies.sweeps.settings import difference
from birdmb.studies.sweeps.tasks import Outcome

_TABLES = (
    "create table study (key text primary key, value text not null)",
    "create table runs (run integer primary key, started text not null, software text not null)",
    """create table points (
        place text primary key, parameters text not null, status text not null,
        reason text not null, start text not null, result text, seconds real not null,
        finished text not null, run integer not null references runs
    )""",
    "create table digests (row text primary key, digest text not null)",
)


def place_text(place: Place) -> str:
    """A place as the store writes it: `[3, 1]`."""
    return json.dumps(place)


class Store:
    """A store open for writing, by one process at a time."""

    def __init__(self, path: Path, connection: sqlite3.Connection, held: Contents) -> None:
        self._path, self._connection = path, connection
        self.contents = held
        with self._transaction():
            self._run = connection.execute(
                "insert into runs (started, software) values (?, ?)",
                (_now(), json.dumps(software())),
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
        with _told(path), closing(_connection(path, "rwc")) as connection:
            with connection:
                connection.execute("begin immediate")
                if _is_new(connection):
                    _create(connection, identity, grid)
                held = contents(path, connection)
                _refuse_another(path, held, identity, grid)
                _put(connection, "grid", grid.parameters)
            connection.execute("pragma journal_mode = wal")  # others can read meanwhile
            connection.execute("pragma synchronous = full")
            yield cls(path, connection, held)

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
        with self._transaction():
            if self._connection.execute("select 1 from points where place = ?", row[:1]).fetchone():
                raise SweepError(
                    f"{self._path}: another sweep is filling this store; let it finish, or end it."
                )
            self._connection.execute(
                f"insert into points ({COLUMNS}) values ({','.join('?' * 9)})", row
            )
            _seal(self._connection, digest_key("point", row[0]), row)

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
    with _told(path):
        if path.is_dir():
            raise SweepError(f"{path} is a directory, no study.")
        if not path.exists():
            raise SweepError(f"{path}: there is no such study.")
        with closing(_connection(path, _reading_mode(path))) as connection:
            return contents(path, connection)


def _connection(path: Path, mode: str) -> sqlite3.Connection:
    """A connection to the file of that name: to SQLite, `:memory:` would mean something else."""
    uri = f"{path.absolute().as_uri()}?mode={mode}"
    return sqlite3.connect(uri, uri=True, isolation_level=None)


def _reading_mode(path: Path) -> str:
    if os.access(path, os.W_OK) and os.access(path.absolute().parent, os.W_OK):
        # Not read-only, which would leave the files of the write-ahead log behind.
        return "rw"
    log = path.with_name(f"{path.name}-wal")
    return "ro" if log.exists() else "ro&immutable=1"  # a log needs a file beside it to be read


@contextmanager
def _told(path: Path) -> Iterator[None]:
    try:
        yield
    except sqlite3.Error as error:
        raise SweepError(f"{path} cannot be used as the store of a study ({error}).") from error


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def _is_new(connection: sqlite3.Connection) -> bool:
    """Whether there is nothing in the file, not even the mark of another program."""
    marks = (
        connection.execute(f"pragma {name}").fetchone()[0]
        for name in ("application_id", "user_version")
    )
    return not any(marks) and not connection.execute("select 1 from sqlite_master").fetchone()


def _create(connection: sqlite3.Connection, identity: Mapping[str, Any], grid: Grid) -> None:
    connection.execute(f"pragma application_id = {APPLICATION}")
    connection.execute(f"pragma user_version = {FORMAT}")
    for table in _TABLES:
        connection.execute(table)
    _put(connection, "identity", identity)
    _put(connection, "grid", grid.parameters)


def _put(connection: sqlite3.Connection, key: str, value: Mapping[str, Any]) -> None:
    row = (key, json.dumps(value))
    connection.execute("insert or replace into study values (?, ?)", row)
    _seal(connection, digest_key("study", key), row)


def _seal(connection: sqlite3.Connection, key: str, row: tuple[Any, ...]) -> None:
    connection.execute("insert or replace into digests values (?, ?)", (key, digest(row)))


def _refuse_another(path: Path, held: Contents, identity: Mapping[str, Any], grid: Grid) -> None:
    # What has been through JSON once is compared: tuples are lists there.
    apart = difference(held.identity, json.loads(json.dumps(identity)))
    if apart is not None:
        raise SweepError(f"{path} holds another study: {apart}; give this one another store.")
    if grid.extends(held.grid):
        return
    stored, asked = held.grid.parameters, grid.parameters
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
