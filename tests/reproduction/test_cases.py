"""The printed numbers: what is declared of them, and the verdicts on the quick ones."""

import pytest

from birdmb.errors import StateError
from birdmb.reproduction.cases import published_cases
from birdmb.reproduction.published import Case, Comparison, Published, compare

CASES = published_cases(long=True)
QUICK = published_cases()


def test_every_case_names_its_command_and_every_exception_its_reason():
    for case in CASES:
        assert case.command.startswith(("birdmb ", "python ")), case.source
        for number in case.published:
            assert number.tolerance > 0.0
            assert number.expected == "pass" or number.reason, (case.source, number.quantity)
    assert len({case.source for case in CASES}) == len(CASES)


@pytest.mark.long
@pytest.mark.parametrize("case", QUICK, ids=lambda case: case.source)
def test_what_should_agree_does_and_exceptions_are_some(case):
    compared = compare(case)
    assert [one for one in compared if one.fails or one.failure] == []


def test_verdicts():
    def verdict(computed, expected="pass", tolerance=0.1):
        made = Comparison("5", "", "u", "m/s", 1.0, computed, tolerance, "birdmb", expected)
        return made.verdict, made.fails

    assert verdict(1.05) == ("pass", False)
    assert verdict(1.2) == ("differs", True)
    assert verdict(None) == ("differs", True)
    assert verdict(1.2, "differs") == ("differs", False)
    assert verdict(1.2, "contradicts") == ("contradicts", False)
    assert verdict(1.05, "contradicts") == ("pass", False)


def test_a_case_without_an_orbit_says_so():
    def fails():
        raise StateError("nothing\nthere.")

    (one,) = compare(Case("9", "nowhere", "birdmb", fails, (Published("x", "", 1.0, 0.1),)))
    assert one.computed is None
    assert one.difference is None
    assert one.failure == "nothing there."
