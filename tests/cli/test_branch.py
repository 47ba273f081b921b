"""`birdmb branch`: lines, table, JSON and picture, and nothing lost when it is stopped."""

import json
import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from matplotlib.image import imread

from birdmb import load_branch

from .conftest import IBIS, QUICK

AMPLITUDE = "shoulder.flap.amplitude_deg"
FOLLOW = ("branch", IBIS, *QUICK, "--parameter", AMPLITUDE, "--from", "42", "--to", "44")
FOLLOW += ("--longest-step", "0.3")


@pytest.fixture(scope="module")
def followed(run, tmp_path_factory):
    """A branch with everything written: result of the run, its JSON object, its directory."""
    directory = tmp_path_factory.mktemp("branch")
    result = run(*FOLLOW, "--out", str(directory), "--json")
    assert result.exit_code == 0, result.stderr
    return result, json.loads(result.stdout), directory


def test_json_and_file_say_the_same(followed):
    _, found, directory = followed
    branch = load_branch(directory / "branch.nc")
    assert [point["parameter"] for point in found["points"]] == list(branch.parameters)
    assert found["points"][3]["x0"] == list(branch.points[3].points[0])
    assert found["points"][0]["mean_speed"] == branch.points[0].observables["mean_speed"]
    assert found["fingerprint"] == branch.settings["fingerprint"]
    assert (found["bird"], found["model"], found["from"]) == ("ibis", "RigidModel", 42.0)
    assert found["bifurcations"] == []
    assert found["stopped"] is None
    assert found["ending"] == f"The branch reached {AMPLITUDE} = 44, the end of the range."


def test_a_line_for_every_flight(followed):
    result, found, directory = followed
    lines = result.stderr.splitlines()
    assert lines[0] == f"ibis, rigid model: {AMPLITUDE} from 42 to 44"
    rows = [line.split() for line in lines if line.strip()[:1].isdigit()]
    assert [int(row[0]) for row in rows] == list(range(1, len(found["points"]) + 1))
    assert [float(row[1]) for row in rows] == pytest.approx(
        [point["parameter"] for point in found["points"]], rel=1e-7
    )
    assert {row[4] for row in rows} == {"unstable"}
    assert [int(row[7]) for row in rows] == [point["nodes"] for point in found["points"]]
    assert sorted(file.name for file in directory.iterdir()) == ["branch.nc", "branch.png"]
    assert imread(directory / "branch.png")[..., :3].std() > 0.02


def test_shooting_is_taken_where_it_is_asked_for(run):
    for asked in (("--method", "shooting"), ("--steps-per-beat", "24"), ("--segments", "2")):
        result = run(*FOLLOW, *asked, "--max-points", "2", "--json")
        assert result.exit_code == 0, result.stderr
        assert {point["method"] for point in json.loads(result.stdout)["points"]} == {"shooting"}
        assert [line.split()[-1] for line in result.stderr.splitlines()[2:4]] == ["shot", "shot"]


def test_the_table_fits(run):
    result = run(*FOLLOW, "--max-points", "2")
    assert result.exit_code == 0, result.stderr
    assert "ibis along shoulder.flap.amplitude_deg" in result.stdout
    assert "the number of points allowed was reached" in result.stdout
    assert max(map(len, result.stdout.splitlines()[:-1])) <= 80
    assert "…" not in result.stdout


@pytest.mark.long
@pytest.mark.skipif(os.name != "posix", reason="sends POSIX signals")
@pytest.mark.parametrize(("stop", "status"), [(signal.SIGINT, 130), (signal.SIGKILL, -9)])
def test_a_run_that_is_stopped_resumes_on_the_same_branch(run, followed, tmp_path, stop, status):
    store = tmp_path / "kept.nc"
    # A shell that runs tests in the background has them ignore Ctrl-C.
    script = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
        "from birdmb.cli import main; main()"
    )
    with subprocess.Popen(
        [sys.executable, "-c", script, *FOLLOW, "--store", str(store)],
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if line.strip().startswith("3 "):
                break
        process.send_signal(stop)
        rest = process.stderr.read()
        assert process.wait(60) == status
    if stop == signal.SIGINT:
        assert rest.splitlines()[-1] == "Interrupted."
        assert [file.name for file in tmp_path.iterdir()] == ["kept.nc"]
    begun = load_branch(store)
    assert begun.stopped is not None
    assert begun.stopped.reason == "the run was interrupted"
    result = run(*FOLLOW, "--store", str(store), "--resume")
    assert result.exit_code == 0, result.stderr
    assert f"going on after {len(begun.points)} points" in result.stderr
    whole, again = load_branch(followed[2] / "branch.nc"), load_branch(store)
    assert np.array_equal(again.parameters, whole.parameters)
    for one, other in zip(again.points, whole.points, strict=True):
        assert np.array_equal(one.points, other.points)
        assert np.array_equal(one.multipliers, other.multipliers)


def sentence(result, status=2):
    assert result.exit_code == status, result.stderr
    return result.stderr.splitlines()[-1]


def test_an_older_branch_is_not_overwritten(run, followed):
    words = sentence(run(*FOLLOW, "--out", str(followed[2])))
    assert "branch.nc exists: --resume goes on with it, or remove it." in words


def test_another_bird_is_not_resumed(run, followed):
    _, _, directory = followed
    options = ("--set", "body.mass=1.3", "--resume", "--out", str(directory))
    words = sentence(run(*FOLLOW, *options))
    assert "the branch to resume is of another ibis: a value other than" in words


def test_mistakes_are_one_sentence(run, tmp_path):
    assert "--resume needs the file" in sentence(run(*FOLLOW, "--resume"))
    (tmp_path / "notes.nc").write_text("mine")
    store = ("--store", str(tmp_path / "notes.nc"))
    assert "notes.nc holds no branch" in sentence(run(*FOLLOW, *store, "--resume"))
    words = sentence(run(*FOLLOW, "--store", str(tmp_path / "notes.nc" / "below.nc")))
    assert words.startswith("Error: --store: ")
    unknown = ("branch", IBIS, "--parameter", "body.mas", "--from", "1", "--to", "2")
    assert "the nearest: body.mass" in sentence(run(*unknown))
    text = ("branch", IBIS, "--parameter", "name", "--from", "1", "--to", "2")
    assert "name is not a real number" in sentence(run(*text))


def test_no_flight_to_start_from(run):
    heavy = ("branch", IBIS, *QUICK, "--parameter", "body.mass", "--from", "60", "--to", "50")
    result = run(*heavy, "--steps-per-beat", "24", "--json")
    assert result.exit_code == 1
    assert json.loads(result.stdout)["error"]
