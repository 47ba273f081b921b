"""The command `birdmb validate`: what it prints of cases, without computing them all."""

import json

import pytest

from birdmb.errors import StateError
from birdmb.reproduction.published import Case, Published


def lost():
    raise StateError("the flight diverged.")


def case(printed, compute=lambda: {"u": 17.5}):
    return Case("9", "chapter 9", "birdmb cycle ibis.toml", compute, (printed,))


@pytest.fixture
def validated(run, monkeypatch):
    def validated(cases, *options):
        def published_cases(_chapter, *, long):
            assert not long
            return cases

        monkeypatch.setattr("birdmb.cli.validate.published_cases", published_cases)
        return run("validate", *options)

    return validated


def test_each_case_is_printed_with_its_command_difference_and_reason(validated):
    explained = Published("u", "m/s", 18.0, 0.05, "differs", "a coarser wing")
    unexplained = Published("u", "m/s", 18.0, 0.05, "differs", "not known")
    result = validated([case(explained), case(unexplained, lost)])
    assert result.exit_code == 0
    words = [line.split() for line in result.stdout.splitlines()]
    assert ["u,", "m/s", "18", "17.500", "-0.5", "0.05", "differs"] in words
    assert "  birdmb cycle ibis.toml" in result.stdout
    assert "  a coarser wing" in result.stdout
    assert "nothing computed: the flight diverged." in result.stdout
    assert "2 numbers: 0 pass, 2 differs, 0 contradicts" in result.stdout
    assert "computing 2 published cases" in result.stderr


def test_what_should_agree_and_does_not_makes_the_exit_status(validated):
    assert validated([case(Published("u", "m/s", 17.6, 0.2))]).exit_code == 0
    for compute in (lambda: {"u": 17.5}, lost):
        result = validated([case(Published("u", "m/s", 17.6, 0.05), compute)])
        assert result.exit_code == 1
        assert "should agree: chapter 9, u" in result.stdout


def test_json_carries_every_number(validated):
    printed = Published("u", "m/s", 18.0, 0.05, "contradicts", "printed twice")
    result = validated([case(printed)], "--json")
    document = json.loads(result.stdout)
    assert document["agrees"] is True
    (row,) = document["comparisons"]
    assert row["difference"] == pytest.approx(-0.5)
    assert (row["verdict"], row["reason"], row["unit"]) == ("contradicts", "printed twice", "m/s")


def test_an_unknown_chapter_is_named(run):
    result = run("validate", "--chapter", "12")
    assert result.exit_code == 2
    assert "no printed numbers of chapter '12'" in result.stderr
