"""`birdmb sweep` and `birdmb plot`, as processes that are killed and interrupted, and in here."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import xarray as xr
from rich.console import Console

from birdmb.cli.sweep import SweepProgress, _line
from birdmb.studies.sweeps import Finished, Study
from birdmb.studies.sweeps.tasks import Outcome

from .conftest import HANGS, IBIS, IBIS_TAIL

VARY = (
    *("--vary", "shoulder.flap.amplitude_deg=42:38:5"),
    *("--vary", "body.mass=1.1,1.15,1.2,1.25,1.3,1.35"),
)
COARSE = ("--model", "rigid", "--set", "wing.discretisation=8", "--steps-per-beat", "30")


def start(store, workers="2"):
    # A shell that runs tests in the background has them ignore Ctrl-C.
    script = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
        "from birdmb.cli import main; main()"
    )
    command = ("sweep", IBIS, *VARY, *COARSE, "--store", str(store), "--workers", workers)
    return subprocess.Popen(
        [sys.executable, "-c", script, *command],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def children(process):
    path = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    return [Path("/proc") / pid for pid in path.read_text().split()]


def wait_until_gone(processes):
    deadline = time.monotonic() + HANGS
    while any(path.exists() for path in processes):
        assert time.monotonic() < deadline, "workers outlive the sweep"
        time.sleep(0.02)


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="looks for orphans in /proc")
def test_killed_and_interrupted_sweeps_keep_what_they_told_and_leave_no_workers(tmp_path, run):
    store = tmp_path / "study.db"
    with start(store) as killed:
        told = [killed.stderr.readline() for _ in range(3)]
        workers = children(killed)
        killed.kill()
        killed.communicate()
    assert len(workers) >= 2
    wait_until_gone(workers)
    kept = Study.open(store).outcomes
    assert told[-1].startswith("3/30  shoulder.flap.amplitude_deg=")
    assert 3 <= len(kept) < 30

    with start(store) as interrupted:
        first = interrupted.stderr.readline()
        workers = children(interrupted)
        os.killpg(interrupted.pid, signal.SIGINT)  # as a terminal sends it: to the workers, too
        output, errors = interrupted.communicate(timeout=HANGS)
    assert interrupted.returncode == 130
    assert first.startswith(f"{len(kept) + 1}/30  ")
    assert output == ""
    assert errors.splitlines()[-1] == "Interrupted."
    assert "Traceback" not in errors
    wait_until_gone(workers)
    more = Study.open(store).outcomes
    assert kept.items() < more.items()

    with start(store, workers="1") as last:
        output, errors = last.communicate(timeout=HANGS)
    assert last.returncode == 0, errors
    assert len(errors.splitlines()) == 30 - len(more)
    counted, verdict = output.splitlines()
    assert counted == f"{store}: 30 points, 30 with a limit cycle, 0 without."
    assert re.fullmatch(
        r"  30 unstable: 1\d\.\d+ to \d+\.\d+ m/s, climbing -\S+ to \S+ m/s", verdict
    )

    result = run("plot", str(store), "--out", str(tmp_path / "figures"))
    assert result.exit_code == 0, result.stderr
    assert sorted(path.name for path in (tmp_path / "figures").iterdir()) == [
        "study.nc",
        "study.png",
    ]
    data = xr.load_dataset(tmp_path / "figures" / "study.nc")
    assert (data.status == "found").all()
    result = run(
        "plot", str(store), "--at", "body.mass=1.2", "--quantity", "power", "--out", str(tmp_path)
    )
    assert result.exit_code == 0, result.stderr
    assert (tmp_path / "study_power.png").stat().st_size > 10_000

    result = run("sweep", IBIS, *VARY, "--model", "rigid", "--store", str(store))
    assert result.exit_code == 2
    assert result.stderr.startswith(f"Error: {store} holds another study: the model is ")
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.parametrize(
    ("vary", "says"),
    [
        ("body.mass=1:2", "must read NAME=FIRST:LAST:COUNT"),
        ("body.mass=1:2:1", "must read NAME=FIRST:LAST:COUNT"),
        ("body.mass=1:2:many", "must read NAME=FIRST:LAST:COUNT"),
        ("body.mass=", "must read NAME=VALUE"),
        ("body.mass=1,,2", "must read NAME=VALUE"),
        ("body.mas=1,2", "the nearest: body.mass"),
        ("body.mass=1,1", "body.mass is to be 1 twice"),
    ],
)
def test_wrong_variations_are_told_in_a_sentence(tmp_path, run, vary, says):
    store = tmp_path / "study.db"
    result = run("sweep", IBIS, "--vary", vary, "--store", str(store))
    assert result.exit_code == 2
    assert says in result.stderr
    assert len(result.stderr.splitlines()) == 1
    assert not store.exists()


def test_nothing_to_plot(tmp_path, run):
    result = run("plot", str(tmp_path / "study.db"))
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == f"Error: {tmp_path / 'study.db'}: there is no such study.\n"


def test_terminal_shows_rate_failures_and_time_left():
    console = Console(force_terminal=True, width=160, record=True, file=open(os.devnull, "w"))  # noqa: PTH123, SIM115
    failed = Outcome(None, "too heavy", "cold", 0.1)
    found = Outcome(
        {
            "stability": "stable",
            "multiplier_real": [0.5],
            "multiplier_imag": [0.0],
            "mean_speed": 13.8,
            "mean_climb_rate": -0.25,
            "flight": "forwards",
        },
        "",
        "cold",
        0.1,
    )
    with console.file, SweepProgress(console) as progress:
        progress.update(Finished({}, None, 10, 40))
        progress.update(Finished({"body.mass": 99.0}, failed, 11, 40))
        progress.update(Finished({"body.mass": 1.0}, found, 12, 40))
    shown = console.export_text()
    assert "11/40  body.mass=99  failed: too heavy" in shown
    assert "12/40  body.mass" not in shown
    told = _line(Finished({"body.mass": 1.0}, found, 12, 40))
    assert told == "12/40  body.mass=1  stable, |Λ|max 0.5000, 13.80 m/s, climb -0.25 m/s  0.10 s"
    last = shown.splitlines()[-1]
    assert "12/40" in last
    assert "points/s, 1 failed, 0:00:0" in last
    assert last.rstrip().endswith("left")


def test_lateral_modes_are_swept_in_space(tmp_path, run):
    store = tmp_path / "study.db"
    coarse = ("--set", "wing.discretisation=6")
    grid = ("--vary", "shoulder.flap.offset_deg=-4,4", "--store", str(store), *coarse)
    result = run("sweep", IBIS_TAIL, "--model", "rigid", "--motion", "free", *grid)
    assert result.exit_code == 0
    data = Study.open(store).to_xarray()
    spiral = (data.multiplier_mode == "spiral").values
    assert spiral.sum(axis=-1).tolist() == [1, 1]
    low, high = data.multiplier_real.values[spiral]
    assert low > high > 1  # dihedral steadies the spiral
    other = run("sweep", IBIS_TAIL, "--model", "rigid", *grid)
    assert other.exit_code == 2
    assert "the model is RigidModel(motion='free') there and RigidModel here" in other.stderr
    trimmed = run(
        "sweep", IBIS_TAIL, "--model", "rigid", "--motion", "free", *grid[:2], *coarse,
        "--store", str(tmp_path / "trim.db"), "--trim", "forearm.roll.offset_deg=-20:10",
    )  # fmt: skip
    assert "a trim is that of a symmetric flight" in trimmed.stderr
