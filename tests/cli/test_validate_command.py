"""The command `birdmb validate`: what it prints of cases, without computing them all."""

import pytest

from birdmb.errors import StateError
from birdmb.studies.validation import Case


def lost():
    raise StateError("the flight diverged.")


@pytest.fixture
def cases(monkeypatch):
    def published_cases():
        return [
            Case("chapter 9", "birdmb cycle ibis.toml", {"u, m/s": 18.0}, lambda: {"u, m/s": 17.5}),
            Case("chapter 10", "birdmb cycle lost.toml", {"u, m/s": 18.0}, lost),
        ]

    monkeypatch.setattr("birdmb.cli.validate.published_cases", published_cases)


@pytest.mark.usefixtures("cases")
def test_each_case_is_printed_with_its_command_and_difference(run):
    result = run("validate")
    assert result.exit_code == 0
    words = [line.split() for line in result.stdout.splitlines()]
    assert ["u,", "m/s", "18", "17.5", "-0.5"] in words
    assert "  birdmb cycle ibis.toml" in result.stdout
    assert "nothing computed: the flight diverged." in result.stdout
    assert "computing 2 published cases" in result.stderr
