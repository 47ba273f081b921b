"""`birdmb birds`, `birdmb new` and birds by their names, from any directory."""

import json
import tomllib

import pytest

import birdmb
from birdmb.topology.shipped import topology_file

from .conftest import TOPOLOGIES


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """A directory without a checkout in or above it."""
    monkeypatch.chdir(tmp_path)


def test_all_topologies_are_listed(run):
    listed = json.loads(run("birds", "--json").stdout)
    assert [bird["name"] for bird in listed] == sorted(p.stem for p in TOPOLOGIES.glob("*.toml"))
    assert birdmb.bird_names() == tuple(bird["name"] for bird in listed)
    ibis = next(bird for bird in listed if bird["name"] == "ibis")
    assert ibis["mass"] == pytest.approx(1.26)
    assert ibis["frequency"] == 4.0
    assert ibis["summary"].startswith("A northern bald ibis in flapping flight")
    assert all(bird["summary"].endswith(".") for bird in listed)
    printed = run("birds")
    assert printed.exit_code == 0
    for bird in listed:
        assert f"\n{bird['name']}  " in f"\n{printed.stdout}"


def test_a_bird_is_loaded_by_its_name():
    assert birdmb.load_bird("ibis") == birdmb.load_bird(TOPOLOGIES / "ibis.toml")


def test_a_file_of_that_name_goes_before_the_bird(tmp_path):
    birdmb.load_bird("ibis").with_values({"name": "mine"}).save(tmp_path / "ibis")
    assert birdmb.load_bird("ibis").name == "mine"


def test_a_directory_of_that_name_does_not(tmp_path):
    (tmp_path / "ibis").mkdir()
    assert birdmb.load_bird("ibis").name == "ibis"


def test_commands_take_names(run):
    assert "ibis_tail" in run("check", "ibis_tail").stdout


def test_an_unknown_name_is_told_with_the_nearest(run):
    done = run("check", "ibbis")
    assert done.exit_code == 2
    assert done.stderr.startswith('Error: "ibbis" is no file, and no bird of this package; ')
    assert "the nearest: ibis (" in done.stderr
    with pytest.raises(birdmb.TopologyError, match="no such file"):
        birdmb.load_bird("ibbis.toml")


def test_new_copies_a_bird_with_its_comments(run, tmp_path):
    done = run("new", "mine.toml", "--like", "ibis")
    assert done.exit_code == 0, done.stderr
    made = (tmp_path / "mine.toml").read_text(encoding="utf-8").splitlines()
    typed = topology_file("ibis").read_text(encoding="utf-8").splitlines()
    changed = [pair for pair in zip(typed, made, strict=True) if pair[0] != pair[1]]
    assert changed == [('name = "ibis"', 'name = "mine"')]
    assert birdmb.load_bird("mine.toml").with_values({"name": "ibis"}) == birdmb.load_bird("ibis")


def test_new_copies_a_file_of_the_users(run, tmp_path):
    (tmp_path / "a.toml").write_bytes(topology_file("ibis_tail").read_bytes())
    assert run("new", "b.toml", "--like", "a.toml").exit_code == 0
    assert tomllib.loads((tmp_path / "b.toml").read_text(encoding="utf-8"))["name"] == "b"


def test_new_overwrites_nothing(run, tmp_path):
    (tmp_path / "mine.toml").write_text("mine")
    done = run("new", "mine.toml", "--like", "ibis")
    assert done.exit_code == 2
    assert "mine.toml is there already" in done.stderr
    assert (tmp_path / "mine.toml").read_text() == "mine"


def test_new_asks_what_from(run):
    done = run("new", "mine.toml")
    assert done.exit_code == 2
    assert "--like one of flapping_robot, gull_glider, " in " ".join(done.stderr.split())
