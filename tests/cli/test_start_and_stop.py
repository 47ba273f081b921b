"""How the command line starts, stops and talks about compiling, as a process of its own."""

import io
import os
import re
import signal
import subprocess
import sys
import time
from importlib.metadata import version
from pathlib import Path
from types import SimpleNamespace

import pytest
from rich.console import Console

from birdmb._kernel_files import cache_folders
from birdmb.cli.progress import Progress, _Compilation

from .conftest import COMPLIANT, HANGS, IBIS

HEAVY = ("exudyn", "numba", "matplotlib", "scipy", "xarray")


def birdmb(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "birdmb", *arguments],
        capture_output=True,
        text=True,
        timeout=HANGS,
        check=False,
    )


def test_version():
    result = birdmb("--version")
    assert (result.returncode, result.stdout) == (0, f"birdmb {version('birdmb')}\n")


@pytest.mark.parametrize("command", [(), ("cycle",), ("check",)])
def test_help(command):
    result = birdmb(*command, "--help")
    assert result.returncode == 0
    assert "Example" in result.stdout


def test_help_and_wrong_birds_wait_for_nothing_heavy():
    script = (
        "import sys; from typer.testing import CliRunner; from birdmb.cli.app import app; "
        "CliRunner().invoke(app, sys.argv[1:]); "
        f"print([name for name in {HEAVY} if name in sys.modules])"
    )
    for arguments in (["cycle", "--help"], ["cycle", IBIS, "--set", "body.mass=-1"]):
        run = [sys.executable, "-c", script, *arguments]
        assert subprocess.check_output(run, text=True) == "[]\n"


def test_a_mistake_is_no_traceback():
    result = birdmb("cycle", IBIS, "--set", "body.mass=-1")
    assert result.returncode == 2
    assert result.stdout == ""
    assert result.stderr.startswith("Error: ibis (with body.mass = -1): body.mass: must be more")
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.skipif(os.name != "posix", reason="sends a POSIX signal")
def test_ctrl_c_while_exudyn_integrates(tmp_path):
    # A shell that runs tests in the background has them ignore Ctrl-C.
    script = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
        "from birdmb.cli import main; main()"
    )
    with subprocess.Popen(
        [sys.executable, "-c", script, "cycle", COMPLIANT, "--out", str(tmp_path), "--json"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stderr is not None
        begun = False
        for line in process.stderr:
            begun = begun or line.startswith("ibis_compliant_shoulder, multibody model")
            if line.split()[:1] == ["0"]:  # the guess has been flown, and the search goes on
                break
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=HANGS)
    assert begun
    assert process.returncode == 130
    assert output == ""
    assert errors.splitlines()[-1] == "Interrupted."
    assert "Traceback" not in errors
    assert not list(Path(tmp_path).iterdir())


def test_a_terminal_shows_what_is_going_on_and_for_how_long(monkeypatch):
    shown = io.StringIO()
    console = Console(file=shown, force_terminal=True, width=100)
    progress = Progress(console)
    later = SimpleNamespace(monotonic=lambda: time.monotonic() + 65.0)
    monkeypatch.setattr("birdmb.cli.progress.time", later)
    with progress.shown():
        progress.doing("flying [/oops]")
    seconds = re.search(r"flying \[/oops\], (\d+) s", shown.getvalue())
    assert seconds is not None
    assert int(seconds[1]) >= 65


@pytest.mark.parametrize(
    ("cached", "says"), [(False, "once per installation"), (True, "new or have changed")]
)
def test_compiling_is_announced_once(tmp_path, capsys, monkeypatch, cached, says):
    monkeypatch.setattr("numba.core.config.CACHE_DIR", str(tmp_path))
    (folder,) = cache_folders()
    folder.mkdir()
    if cached:
        (folder / "line.point.kernel").touch()
    listener = _Compilation(Progress(Console(stderr=True)))
    events = [
        SimpleNamespace(
            data={
                "dispatcher": SimpleNamespace(
                    py_func=SimpleNamespace(__module__=module, __name__="kernel")
                )
            }
        )
        for module in ("numba.np.linalg", "birdmb.wing.line", "birdmb.wing.line")
    ]
    for event in events:
        listener.on_start(event)
        listener.on_end(event)
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert says in lines[0]
