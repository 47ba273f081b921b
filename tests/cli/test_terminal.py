"""Terminals that are narrow or know ASCII alone, JSON in place of tables, names at the Tab key."""

import io
import json
import re

import numpy as np
import pytest
from rich.console import Console
from typer.main import get_command
from typer.testing import CliRunner

import birdmb
from birdmb.cli.app import app
from birdmb.cli.branch import _Lines
from birdmb.cli.completion import assigned_names, birds_and_files, dotted_names
from birdmb.cli.console import fit_help
from birdmb.cli.progress import Progress
from birdmb.cli.streams import _spelled_out
from birdmb.cli.tables import table_of
from birdmb.orbits import Iteration

from .conftest import COMPLIANT, HINGED, IBIS, QUICK, TOPOLOGIES

COMMANDS = sorted(get_command(app).commands)
NUMBER = re.compile(r"(?<![\w.])[+-]?\d+(?:\.\d+)?(?:e[+-]\d+)?")


def printed(columns, *arguments):
    environment = {"COLUMNS": str(columns), "TERM": "dumb"}
    result = CliRunner().invoke(app, arguments, env=environment)
    assert result.exit_code == 0, result.stderr
    return result.stdout


def fitting(text, columns):
    return [line for line in text.splitlines() if len(line.rstrip()) > columns]


@pytest.fixture(scope="module")
def wide():
    return {
        command: printed(160, *command)
        for command in (
            ("check", COMPLIANT),
            ("check", HINGED),
            ("birds",),
            ("cycle", IBIS, *QUICK),
        )
    }


@pytest.mark.parametrize("columns", [40, 80])
def test_every_number_of_a_wide_table_is_in_a_narrow_one(wide, columns):
    for command, text in wide.items():
        narrow = printed(columns, *command)
        assert fitting(narrow, columns) == []
        assert "…" not in narrow
        assert sorted(NUMBER.findall(narrow)) == sorted(NUMBER.findall(text))


def shown(table, width):
    console = Console(file=io.StringIO(), width=width)
    console.print(table)
    return [line.rstrip() for line in console.file.getvalue().splitlines()]


def test_rows_of_a_table_that_does_not_fit_are_written_one_below_the_other():
    table = table_of("Flight", "quantity", "value", "unit", "", numbers=(1,))
    table.add_row("speed", "17.994", "m/s", "")
    table.add_row("cost of transport", "0.0178", "", "power / (weight x speed)")
    assert shown(table, 60)[1] == "quantity             value   unit"
    assert shown(table, 40) == [
        *("Flight", "speed: 17.994 m/s", "cost of transport: 0.0178"),
        "    power / (weight x speed)",
    ]


def test_rows_that_numbers_begin_have_their_heading():
    table = table_of("Multipliers", "Re", "modulus", "a disturbance", numbers=(0, 1))
    table.add_row("1.427243", "1.427243", "doubles in 0.49 s")
    assert shown(table, 32)[1:] == [
        "Re 1.427243",
        "    modulus        1.427243",
        "    a disturbance  doubles in",
        "    0.49 s",
    ]


def test_lines_of_a_search_leave_out_what_does_not_fit():
    headings = {}
    for width in (40, 80):
        console = Console(file=io.StringIO(), width=width)
        Progress(console).iteration(
            Iteration(
                number=0,
                residual=1.0,
                step_length=0.0,
                damping=1.0,
                x=np.zeros(1),
                period=1.0,
                nodes=25,
            )
        )
        headings[width] = console.file.getvalue().splitlines()[0].split()
    assert headings[80] == ["iteration", "residual", "step", "damping", "nodes"]
    assert headings[40] == ["iteration", "residual", "nodes"]


def test_lines_of_a_branch_leave_out_what_does_not_fit():
    for width in (40, 160):
        lines = _Lines(Progress(Console(file=io.StringIO(), width=width)), "gait.frequency")
        assert {"gait.frequency", "|Λ|max", "stability"} <= set(lines._widths)
        assert ("nodes" in lines._widths) == (width == 160)


def test_a_check_is_one_object(run):
    result = run("check", COMPLIANT, "--json")
    assert result.exit_code == 0, result.stderr
    found, bird = json.loads(result.stdout), birdmb.load_bird(COMPLIANT)
    assert found["mass"] == bird.total_mass
    assert found["fingerprint"] == bird.fingerprint()
    assert list(found["joints"]) == list(bird.joint_names)
    flap = found["joints"]["shoulder.flap"]
    assert (flap["mode"], flap["stiffness"]) == ("compliant", 20.0)
    assert flap["highest"] == pytest.approx(bird.joint("shoulder.flap").amplitude)
    assert list(found["oscillations"]) == ["shoulder.flap"]
    assert found["segments"]["hand"]["length"] == bird.segments.hand.length
    assert any("plane of symmetry" in warning for warning in found["warnings"])


def test_a_check_that_fails_is_an_object_too(run):
    result = run("check", IBIS, "--set", "body.mass=-1", "--json")
    assert result.exit_code == 2
    assert "body.mass" in json.loads(result.stdout)["error"]


@pytest.mark.parametrize("columns", [40, 80])
def test_help_of_every_command_cuts_no_words(columns, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(columns))
    monkeypatch.setattr(app, "rich_markup_mode", app.rich_markup_mode)
    monkeypatch.setattr(app.info, "context_settings", dict(app.info.context_settings))
    fit_help(app)
    for command in ([], *([name] for name in COMMANDS)):
        text = printed(columns, *command, "--help")
        assert fitting(text, columns) == []
        assert "…" not in text


def test_help_says_how_the_shell_completes():
    assert "--install-completion" in printed(100, "--help")


def test_signs_lines_and_accents_have_a_spelling_in_ascii():
    def spelled(text):
        return "".join(
            c if c.isascii() else _spelled_out(UnicodeEncodeError("ascii", c, 0, 1, "no"))[0]
            for c in text
        )

    assert spelled("|Λ|max 1.4 ± 0.1, −7 °, café … ─│╭ ⠋ █ 鳥") == (
        "|Lambda|max 1.4 +- 0.1, -7 deg, cafe ... -|+ * # ?"
    )


class Line:
    """What the shell has on its line so far."""

    def __init__(self, **params):
        self.params = params


def test_birds_and_files_are_offered(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ibises").mkdir()
    (tmp_path / "ibises" / "mine.toml").touch()
    (tmp_path / "ibis.txt").touch()
    assert list(birds_and_files("ibis_t")) == ["ibis_tail", "ibis_thesis_ch8"]
    assert "ibises/" in list(birds_and_files("ibis"))
    assert "ibis.txt" not in list(birds_and_files("ibis"))
    assert list(birds_and_files("ibises/")) == ["ibises/mine.toml"]
    assert list(birds_and_files(f"{TOPOLOGIES}/pig")) == [f"{TOPOLOGIES}/pigeon.toml"]
    assert list(birds_and_files("/no/such/folder/")) == []


def test_dotted_names_of_the_bird_on_the_line_are_offered():
    pigeon = birdmb.load_bird("pigeon")
    wanted = [name for name in pigeon.value_names() if name.startswith("body.m")]
    assert list(dotted_names(Line(topology="pigeon"), "body.m")) == wanted == ["body.mass"]
    assert list(assigned_names(Line(topology="pigeon"), "body.m")) == ["body.mass="]
    assert list(assigned_names(Line(topology="pigeon"), "body.mass=")) == []
    assert list(dotted_names(Line(), "gait.f")) == ["gait.frequency"]
    assert list(dotted_names(Line(topology="no_such_bird"), "gait")) == []
