"""`birdmb show` writes what the ending says, of topologies and of saved cycles."""

import pytest

from .conftest import IBIS, IBIS_TAIL, QUICK

SHORT = ("--beats", "1", "--frames", "8")


def test_a_topology_becomes_a_page_of_its_name_here(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("show", IBIS, *QUICK, *SHORT)
    assert result.exit_code == 0, result.stderr
    assert result.stdout == "wrote ibis.html\n"
    assert "ibis, rigid model" in (tmp_path / "ibis.html").read_text(encoding="utf-8")


def test_two_birds_and_a_mode(run, tmp_path):
    out = tmp_path / "new" / "two.html"
    chosen = ("--mode", "1", "--scale", "0.1", "--colour", "load", "--view", "path")
    result = run("show", IBIS, IBIS_TAIL, *QUICK, *SHORT, *chosen, "--out", str(out))
    assert result.exit_code == 0, result.stderr
    page = out.read_text(encoding="utf-8")
    assert "ibis, rigid model; ibis_tail, rigid model" in page
    assert "at the start 0.1 of the states" in page
    assert "load, upwards (N" in page


def test_a_saved_cycle_is_not_searched_for(run, tmp_path, monkeypatch, rigid_cycle):
    path = rigid_cycle.save(tmp_path / "kept.nc")
    monkeypatch.setattr("birdmb.cli.show.found_flight", None)
    monkeypatch.chdir(tmp_path)
    result = run("show", str(path), *SHORT)
    assert result.exit_code == 0, result.stderr
    assert (tmp_path / "kept.html").stat().st_size > 1e6
    assert result.stderr == ""


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ((IBIS, "--out", "flight.mov"), "flight.mov: the file's ending must be one of .html"),
        ((IBIS, "--scale", "2"), "give --mode with it"),
        ((IBIS, *QUICK, "--mode", "9"), "has 4 modes, not 9"),
        ((IBIS, IBIS, IBIS), "Got unexpected extra argument"),
        (("cycle.nc", "--model", "rigid"), "--model is for topologies"),
        (("cycle.nc", "--set", "body.mass=1"), "--set is for topologies"),
        (("no_such_bird",), "no_such_bird"),
    ],
)
def test_what_cannot_be_shown_is_a_sentence(run, tmp_path, monkeypatch, arguments, sentence):
    monkeypatch.chdir(tmp_path)
    result = run("show", *arguments)
    assert result.exit_code == 2
    assert sentence in " ".join(result.stderr.split())
    assert "Traceback" not in result.stderr
    assert list(tmp_path.iterdir()) == []
