"""The table of published against computed values."""

import pytest

import birdmb
from birdmb.studies.validation import Case, compare, published_cases


@pytest.fixture(scope="module")
def cases():
    return published_cases()


def test_every_case_names_its_command_and_its_numbers(cases):
    assert {case.source.split(",")[0] for case in cases} == {
        "chapter 5",
        "chapter 6",
        "chapter 7",
        "chapter 8",
        "appendix A",
    }
    assert all(case.command.startswith(("birdmb ", "python ")) for case in cases)


def test_the_published_discretisation_comes_close_to_the_thesis(cases):
    """Its first table was made with a coarser tolerance: u is 1 % off, the multipliers 0.015."""
    comparison = next(compare([cases[0]]))
    assert not comparison.failure
    gaps = {name: abs(comparison.difference(name)) for name in comparison.case.published}
    assert gaps["u, m/s"] < 0.2
    assert max(gap for name, gap in gaps.items() if "multiplier" in name) < 0.016


def test_the_tail_comes_close_to_the_thesis(cases):
    """Without the downwash, of which the published program lost most, the trim too."""
    corrected, as_published = compare([c for c in cases if c.source.startswith("chapter 6")])
    for comparison in (corrected, as_published):
        assert abs(comparison.difference("largest |multiplier|")) < 0.01
        assert abs(comparison.difference("power, W")) < 0.08 * 16.7
        assert abs(comparison.difference("speed, m/s")) < 0.2
    assert abs(as_published.difference("forearm.roll offset, deg")) < 0.5


def test_roessler(cases):
    for comparison in compare(cases[-2:]):
        assert abs(comparison.difference("period")) < 1e-6
        assert abs(comparison.difference("largest |multiplier|")) < 1e-6


def test_a_case_without_an_orbit_says_so():
    def fails():
        raise birdmb.StateError("nothing there.")

    comparison = next(compare([Case("nowhere", "birdmb", {"x": 1.0}, fails)]))
    assert comparison.failure == "nothing there."
