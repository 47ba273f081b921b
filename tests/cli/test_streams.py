"""Output that is not in UTF-8, closed, full or narrow, and settings of matplotlib, end nothing."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from birdmb.errors import OutputError

from .conftest import HANGS, IBIS, QUICK

PREAMBLE = "import sys; from birdmb.cli import main; sys.argv[0] = 'birdmb'; main()"


def birdmb(*arguments, cwd=None, stdout=subprocess.PIPE, shell="", **environment):
    command = [sys.executable, "-c", PREAMBLE, *arguments]
    if shell:
        command = ["sh", "-c", f'exec "$@" {shell}', "sh", *command]
    return subprocess.run(
        command,
        env={**os.environ, **environment},
        cwd=cwd,
        stdout=stdout,
        stderr=subprocess.PIPE,
        timeout=HANGS,
        check=False,
    )


@pytest.mark.long
def test_what_an_encoding_lacks_is_spelled_out():
    along = ("--parameter", "gait.frequency", "--from", "4", "--to", "4.01", "--max-points", "2")
    result = birdmb("branch", IBIS, *QUICK, *along, PYTHONIOENCODING="cp1252")
    assert result.returncode == 0, result.stderr
    assert b"|Lambda|max" in result.stdout
    assert "°".encode("cp1252") in result.stdout
    assert b"|Lambda|max" in result.stderr


def test_ascii_has_no_degrees():
    result = birdmb("check", IBIS, PYTHONIOENCODING="ascii")
    assert result.returncode == 0, result.stderr
    assert b"shoulder.flap" in result.stdout
    assert result.stdout.isascii()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="writes to /dev/full")
def test_a_full_disk_is_a_sentence():
    with open("/dev/full", "w") as full:  # noqa: PTH123
        result = birdmb("check", IBIS, stdout=full)
    assert result.returncode == 2
    assert result.stderr == (
        b"Error: standard output cannot be written (no space left on device).\n"
    )


@pytest.mark.skipif(os.name != "posix", reason="closes descriptors with a shell")
@pytest.mark.parametrize("closed", [">&-", "2>&-", ">&- 2>&-"])
def test_closed_streams_end_nothing(closed):
    result = birdmb("--version", shell=closed)
    assert (result.returncode, result.stderr) == (0, b"")


def test_a_reader_that_goes_is_no_traceback():
    read, write = os.pipe()
    os.close(read)
    result = birdmb("--version", stdout=write)
    os.close(write)
    assert result.returncode != 0
    assert result.stderr == b""


@pytest.mark.long
def test_pictures_are_drawn_by_settings_of_their_own(tmp_path):
    (tmp_path / "matplotlibrc").write_text("text.usetex: True\nfont.size: 40\n")
    result = birdmb(
        *("cycle", IBIS, *QUICK, "--set", 'name="a$b_{ [/oops]"', "--out", "out"),
        cwd=tmp_path,
        MPLBACKEND="nonsense",
    )
    assert result.returncode == 0, result.stderr
    assert b"unstable at " in result.stdout
    assert (tmp_path / "out" / "overview.png").stat().st_size > 10_000


def test_a_result_is_not_lost_with_its_files(run, monkeypatch, tmp_path):
    def full(*_):
        raise OutputError("--out: cycle.nc cannot be written (no space left on device).")

    monkeypatch.setattr("birdmb.cli.cycle.write_results", full)
    for form in ((), ("--json",)):
        result = run("cycle", IBIS, *QUICK, "--out", str(tmp_path), *form)
        assert result.exit_code == 2
        assert result.stderr.splitlines()[-1].startswith("Error: --out: cycle.nc cannot be")
        assert "unstable" in result.stdout
    assert json.loads(result.stdout)["error"].startswith("--out")


def test_damaged_settings_that_matplotlib_insists_on_are_a_sentence(tmp_path):
    (tmp_path / "matplotlibrc").write_bytes(b"\xff\xfe\xff")
    result = birdmb("check", IBIS, cwd=tmp_path)
    assert result.returncode == 2
    assert f"Error: {tmp_path / 'matplotlibrc'}: is no text in UTF-8".encode() in result.stderr
    assert b"Traceback" not in result.stderr
