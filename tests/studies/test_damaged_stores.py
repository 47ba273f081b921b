"""Stores of studies: durable, whole by points, and refused in a sentence when damaged."""

import json
import shutil
import sqlite3
from contextlib import closing

import numpy as np
import pytest

import birdmb
from birdmb.studies.sweeps import Study, SweepError
from birdmb.studies.sweeps.grid import Grid
from birdmb.studies.sweeps.settings import Search, identity
from birdmb.studies.sweeps.store import Store, read
from birdmb.studies.sweeps.study import _BY_MULTIPLIER, _NUMBERS
from birdmb.studies.sweeps.tasks import Outcome

from .sweeping import MASS, QUICK, coarse_bird

PLACES = [(0,), (1,), (2,)]
STATES = ("u", "w", "q", "theta")


def outcome(value):
    """A made-up flight."""
    result = dict.fromkeys(_NUMBERS, value) | dict.fromkeys(_BY_MULTIPLIER, [value] * 4)
    result |= {"x0": dict.fromkeys(STATES, value), "monodromy": np.eye(4).tolist()}
    result["multiplier_mode"] = ["longitudinal"] * 4
    result |= {"stability": "stable", "integrator": "explicit", "trimmed": {}, "warning": ""}
    result |= {"flight": "forwards", "sensitivity": {}, "state_scale": [10.0, 2.0, 1.0, 0.2]}
    result |= {"orbit": None, "method": "shooting", "method_reason": "asked for"}
    return Outcome(result, "", "cold", 0.5)


def whose():
    """What a study of the coarse bird is made of."""
    return identity(coarse_bird(), QUICK, Search(1e-9, 1e-7, 50, None, "auto", "line-search"), None)


GRID = Grid({MASS: (1.1, 1.2, 1.3)})


def fill(path, places=PLACES):
    with Store.opened(path, whose(), GRID) as store:
        for place in places:
            store.add(GRID, place, outcome(0.5 + place[0]))


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "study.db"
    fill(path)
    return path


def refusals(path):
    """The sentences of reading the store and of going on with it; `None` where it is believed."""
    return [refusal(Study.open, path), refusal(fill, path, ())]


def refusal(use, path, *arguments):
    try:
        use(path, *arguments)
    except SweepError as error:
        return str(error)
    return None


STATEMENTS = [
    *(f"drop table {name}" for name in ("study", "points", "digests")),
    *(f"delete from {name}" for name in ("study", "digests")),
    *(f"delete from study where key = '{key}'" for key in ("identity", "grid")),
    *(
        f"update study set value = '{value}' where key = '{key}'"
        for key in ("identity", "grid")
        for value in ("", "{", "{}", "[]", "null", "1", "NaN", '"text"', "[" * 9999)
    ),
    *(
        f"update points set place = '{place}' where place = '[1]'"
        for place in ("[-1]", "[3]", "[0, 0]", "[]", "1", "[1.0]", "[true]", '["1"]', "null", "{}")
    ),
    *(
        f"update points set {column} = {value} where place = '[1]'"
        for column in ("result", "parameters", "seconds", "reason", "start", "status", "run")
        for value in ("'more'", "'{'", "'{}'", "'lost'", "x'ff00'", "-1", "1e999", "7")
    ),
    "update points set result = null where place = '[1]'",
    "update points set result = replace(result, '1.5', '1.6') where place = '[1]'",
    "update points set status = 'failed' where place = '[1]'",
    "update digests set digest = '' where row = 'point [1]'",
    "alter table points drop column seconds",
    "alter table points rename column result to outcome",
    "pragma user_version = 2",
    "pragma user_version = 4",
    "pragma application_id = 7",
]


def test_stores_whose_rows_are_changed_are_refused(whole, tmp_path):
    path = tmp_path / "study.db"
    for statement in STATEMENTS:
        shutil.copy(whole, path)
        with closing(sqlite3.connect(path)) as connection, connection:
            connection.execute(statement)
        for sentence in refusals(path):
            assert sentence is not None, statement
            assert str(path) in sentence
            assert "\n" not in sentence
    assert len(STATEMENTS) > 80


def test_truncated_and_flipped_stores_are_refused_or_as_they_were(whole, tmp_path):
    path, content, right = tmp_path / "study.db", whole.read_bytes(), Study.open(whole)
    chance = np.random.default_rng(0)
    damaged = [content[: len(content) * share // 12] for share in range(1, 12)]
    damaged += [b"mine, and no database at all " * 40, b"SQLite format 3\0", bytes(4096)]
    for place in chance.integers(0, len(content), 40):
        flipped = bytes([content[place] ^ 1 << int(chance.integers(8))])
        damaged.append(content[:place] + flipped + content[place + 1 :])
    for number, each in enumerate(damaged):
        path.write_bytes(each)
        if refusals(path)[0] is None:  # a byte that nothing depends on
            found = Study.open(path)
            assert found.parameters == right.parameters, number
            assert found.identity == right.identity, number
            assert found.outcomes.items() <= right.outcomes.items(), number
        for name in ("-wal", "-shm", "-journal"):
            path.with_name(f"study.db{name}").unlink(missing_ok=True)


def test_logs_that_are_empty_or_of_others_do_no_harm(whole, tmp_path):
    path = tmp_path / "study.db"
    for content in (b"", b"mine", bytes(9000)):
        shutil.copy(whole, path)
        path.with_name("study.db-wal").write_bytes(content)
        assert len(Study.open(path).outcomes) == 3


def test_places_that_are_no_stores(tmp_path):
    (tmp_path / "empty.db").touch()
    with pytest.raises(SweepError, match="is no study"):
        Study.open(tmp_path / "empty.db")
    for use in (Study.open, fill):
        with pytest.raises(SweepError, match=r"is a directory|unable to open"):
            use(tmp_path)


def test_another_programs_empty_database_is_left_alone(tmp_path):
    path = tmp_path / "other.db"
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("pragma user_version = 12")
    with pytest.raises(SweepError, match="is no study"):
        fill(path)


def test_memory_is_the_name_of_a_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    fill(":memory:")
    assert len(Study.open(":memory:").outcomes) == 3
    assert [file.name for file in tmp_path.iterdir()] == [":memory:"]


def test_a_store_on_a_read_only_disk_is_read(whole, monkeypatch):
    monkeypatch.setattr("birdmb.studies.sweeps.store.os.access", lambda *_: False)
    assert len(read(whole).points) == 3
    assert [file.name for file in whole.parent.iterdir()] == ["study.db"]


def test_another_version_of_birdmb_is_not_filled_but_read(whole, monkeypatch):
    monkeypatch.setattr("birdmb.studies.sweeps.settings.version", lambda _: "99.0")
    with pytest.raises(SweepError, match=r"the version of birdmb is .* there and 99\.0 here"):
        fill(whole)
    assert Study.open(whole).identity["birdmb"] != "99.0"


def test_points_of_a_version_that_kept_less(tmp_path):
    less = outcome(0.5)
    del less.result["power"]
    with Store.opened(tmp_path / "study.db", whose(), GRID) as store:
        store.add(GRID, (0,), less)
    with pytest.raises(SweepError, match="without power, which this one"):
        Study.open(tmp_path / "study.db")


def test_a_bird_of_another_version(tmp_path):
    other = whose()
    other["bird"] = {"name": "ibis", "wings": 2}
    with Store.opened(tmp_path / "study.db", other, GRID):
        pass
    with pytest.raises(SweepError, match=r"that this one, .*, cannot read"):
        Study.open(tmp_path / "study.db")


def test_points_are_on_the_disk_when_add_returns(tmp_path, monkeypatch):
    """SQLite waits for the disk at every commit only when `synchronous` is full (2) or more."""
    connections, connect = [], sqlite3.connect

    def recorded(*arguments, **options):
        connections.append(connect(*arguments, **options))
        return connections[-1]

    monkeypatch.setattr(sqlite3, "connect", recorded)
    path = tmp_path / "study.db"
    with Store.opened(path, whose(), GRID) as store:
        (connection,) = connections
        for i, place in enumerate(PLACES):
            store.add(GRID, place, outcome(1.0))
            assert not connection.in_transaction
            assert connection.execute("pragma synchronous").fetchone()[0] >= 2
            assert connection.execute("pragma journal_mode").fetchone()[0] == "wal"
            assert len(read(path).points) == i + 1


def test_a_point_is_stored_whole_or_not_at_all(tmp_path):
    path = tmp_path / "study.db"
    fill(path, [(0,)])
    with closing(sqlite3.connect(path)) as connection, connection:
        connection.execute(
            "create trigger fails before insert on digests when new.row like 'point%' "
            "begin select raise(abort, 'the disk is full'); end"
        )
    with pytest.raises(SweepError, match="the disk is full"):
        fill(path, [(1,)])
    with closing(sqlite3.connect(path)) as connection:
        kept = connection.execute("select place from points").fetchall()
    assert [json.loads(place) for (place,) in kept] == [[0]]
    assert len(read(path).points) == 1


def test_what_is_stored_is_what_was_computed(whole):
    found = Study.open(whole)
    assert found.outcomes == {place: outcome(0.5 + place[0]) for place in PLACES}
    assert found.bird.fingerprint() == coarse_bird().fingerprint()
    assert isinstance(found.bird, birdmb.Bird)
