"""docs/thesis.md has a row for everything that is drawn and for every printed number."""

import re
from pathlib import Path

import pytest

from birdmb.reproduction.cases import published_cases
from birdmb.reproduction.figures import DRAWINGS
from birdmb.reproduction.page import as_markdown, start_of_row
from birdmb.reproduction.published import Comparison

PAGE = (Path(__file__).parents[2] / "docs" / "thesis.md").read_text(encoding="utf-8")


def test_every_drawing_has_a_row():
    rows = re.findall(r"^\| `--(figure|table) (\S+)` \|", PAGE, re.MULTILINE)
    assert [" ".join(row) for row in rows] == list(DRAWINGS)


@pytest.mark.parametrize("case", published_cases(long=True), ids=lambda case: case.source)
def test_every_printed_number_has_a_row_with_its_verdict(case):
    lines = PAGE.splitlines()
    for number in case.published:
        start = start_of_row(case.source, number, number.value)
        (row,) = [line for line in lines if line.startswith(start)]
        verdict = re.split(r"(?<!\\)\|", row)[5].strip()
        assert verdict in {"pass", number.expected}


def test_rows():
    one = Comparison(
        "5", "gait", "|Λ|", "", 1.4, 1.5, 0.01, "birdmb", "contradicts", "printed twice"
    )
    lines = as_markdown([one]).splitlines()
    assert lines[0] == "### Chapter 5"
    assert lines[-1] == r"| gait | \|Λ\| | 1.4 | 1.500 | contradicts | printed twice |"
