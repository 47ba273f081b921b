"""The tutorial's commands run, one after the other, and print what the page says."""

import math
import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from birdmb.cli.app import app

PAGE = Path(__file__).parents[1] / "docs" / "tutorial.md"
NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
ROUND_OFF = 1e-12


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE.read_text("utf-8"), re.S | re.M)


def commands() -> list[tuple[str, list[str]]]:
    """Each command with the lines that it is said to print."""
    found = []
    for block in blocks("console"):
        for command in re.split(r"^\$ ", block, flags=re.M)[1:]:
            line, *printed = command.splitlines()
            found.append((line, printed))
    return found


def said(line: str) -> tuple[str, list[float]]:
    """The words of a line and its numbers, in so many digits as are no round-off or bound."""
    words = re.sub("─+", "─", NUMBER.sub("#", " ".join(line.split())))
    return words, [float(n) for n in NUMBER.findall(line)]


def agree(told: str, printed: str) -> bool:
    words, numbers = said(told)
    others, found = said(printed)
    # Bounds of errors and what is zero but for round-off may be anything as small.
    return words == others and all(
        math.isclose(a, b, rel_tol=2e-3, abs_tol=1e-6 if abs(a) < 1e-6 else ROUND_OFF)
        for a, b in zip(numbers, found, strict=True)
    )


def in_order(told: list[str], printed: list[str]) -> str | None:
    """The first line of the page that is not printed after those before it."""
    at = 0
    for line in told:
        if line.strip() == "..." or not line.strip():
            continue
        place = next((i for i in range(at, len(printed)) if agree(line, printed[i])), None)
        if place is None:
            return line
        at = place + 1
    return None


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    return tmp_path_factory.mktemp("tutorial")


@pytest.mark.long
def test_what_the_page_says_is_printed(place, monkeypatch, capsys):
    monkeypatch.chdir(place)
    for line, told in commands():
        program, *arguments = shlex.split(line)
        assert program == "birdmb"
        ran = CliRunner().invoke(app, arguments, env={"COLUMNS": "120", "TERM": "dumb"})
        assert ran.exit_code == 0, (line, ran.output)
        missing = in_order(told, [*ran.stdout.splitlines(), *ran.stderr.splitlines()])
        assert missing is None, (line, missing, ran.output)
    assert (place / "results" / "gust.nc").exists()

    (script,) = blocks("python")
    exec(compile(script, str(PAGE), "exec"), {})
    text = PAGE.read_text("utf-8").partition(script)[2]
    told = text.split("```")[2].strip().splitlines()
    assert len(told) == 4
    assert in_order(told, capsys.readouterr().out.splitlines()) is None


def test_the_comparison_can_fail():
    line = "unstable at 17.99 m/s: doubles in 0.49 s"
    assert agree(line, "unstable at  18.00 m/s: doubles in 0.49 s")
    assert not agree(line, "unstable at 18.2 m/s: doubles in 0.49 s")
    assert not agree(line, "stable at 17.99 m/s: doubles in 0.49 s")
    assert in_order(["a 1", "...", "b"], ["b", "a 1"]) == "b"
    assert len(commands()) == 7
