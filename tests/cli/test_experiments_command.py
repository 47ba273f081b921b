"""The command `birdmb validate --experiments`: what it prints of cases, without computing them."""

import json

import pytest

from birdmb.studies.experiments.comparison import Comparison, Experiment


@pytest.fixture
def experiments(monkeypatch):
    def compare():
        others = {"a rival": 0.2}
        yield Comparison("Z", "thrust", "N", 1.5, {"quasi-steady": 2.0, "unsteady": 1.6}, others)
        yield Comparison("Z", "power", "W", 3.0, {"unsteady": 3.1}, failure="it fell.")

    def chosen(case=None):
        assert case in (None, "Z")
        return [Experiment("Z", "a wing", "A. Nobody 1900", compare)]

    monkeypatch.setattr("birdmb.cli.experiments.experiments", chosen)


@pytest.mark.usefixtures("experiments")
def test_experiments_are_printed_side_by_side(run):
    result = run("validate", "--experiments", "--case", "Z")
    assert result.exit_code == 0
    words = [line.split() for line in result.stdout.splitlines()]
    assert ["thrust,", "N", "1.5", "2", "-", "1.6"] in words
    assert "Z: a wing (A. Nobody 1900)" in result.stdout
    assert "thrust, a rival: 0.2" in result.stdout
    assert "power: it fell." in result.stdout
    assert "computing case Z" in result.stderr


@pytest.mark.usefixtures("experiments")
def test_experiments_are_a_list_for_other_programs(run):
    result = run("validate", "--experiments", "--json")
    assert result.exit_code == 0
    thrust, power = json.loads(result.stdout)
    assert thrust["case"] == "Z"
    assert thrust["quantity"] == "thrust"
    assert (thrust["measured"], thrust["quasi-steady"], thrust["unsteady"]) == (1.5, 2.0, 1.6)
    assert thrust["source"] == "A. Nobody 1900"
    assert thrust["others"] == {"a rival": 0.2}
    assert power["quasi-steady"] is None
    assert power["failure"] == "it fell."


def test_a_case_without_experiments_is_refused(run):
    result = run("validate", "--case", "A")
    assert result.exit_code == 2
    assert "give --experiments" in result.stderr
