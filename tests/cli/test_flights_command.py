"""`birdmb flights` lists every flight; `birdmb cycle` leads on where its own guess does not."""

import json

import numpy as np
import pytest
import xarray as xr

from birdmb import RigidModel, find_limit_cycle, load_bird

from .conftest import IBIS, QUICK
from .pigeon import TRIMMED, written

RIGID = ("--model", "rigid")
SPRUNG = (
    "--set", "shoulder.flap.mode=compliant",
    "--set", "shoulder.flap.stiffness=3",
    "--set", "shoulder.flap.damping=0.01",
)  # fmt: skip


def flights_of(result):
    """Speeds, climb rates and largest multipliers of what is a flight, in the order listed."""
    return [
        (each["mean_speed"], each["mean_climb_rate"], np.hypot(*each["multipliers"][0]))
        for each in json.loads(result.stdout)
        if each["why_no_flight"] is None
    ]


@pytest.fixture(scope="module")
def pigeon(tmp_path_factory):
    return written(tmp_path_factory.mktemp("pigeon"))


@pytest.fixture(scope="module")
def listed(run, pigeon, tmp_path_factory):
    """The rigid pigeon's flights: result and directory."""
    directory = tmp_path_factory.mktemp("flights")
    result = run("flights", pigeon, *RIGID, *TRIMMED, "--json", "--out", str(directory))
    assert result.exit_code == 0, result.stderr
    return result, directory


def test_both_flights_of_the_pigeon(listed):
    result, directory = listed
    level, dive = flights_of(result)
    # As shooting from hand-picked starts found them.
    assert level == pytest.approx((16.23, 0.668, 0.9746), abs=0.01)
    assert dive == pytest.approx((23.02, -5.94, 1.410), abs=0.01)
    found = json.loads(result.stdout)
    assert "flight" in result.stderr
    written_files = sorted(path.name for path in directory.iterdir())
    assert written_files == [f"flight_{i}.nc" for i in range(1, len(found) + 1)]
    with xr.open_dataset(directory / "flight_2.nc", engine="h5netcdf") as data:
        assert data.attrs["mean_speed"] == found[1]["mean_speed"]
        assert found[1]["files"] == [str(directory / "flight_2.nc")]


def test_what_is_no_flight_comes_last_and_says_why(listed):
    found = json.loads(listed[0].stdout)
    why = [each["why_no_flight"] for each in found]
    assert why[:2] == [None, None]
    assert len(why) > 2
    for each in found[2:]:
        assert each["why_no_flight"]
        assert each["verdict"].startswith("not ")


def test_the_table(run):
    result = run("flights", IBIS, *QUICK)
    assert result.exit_code == 0, result.stderr
    rows = [" ".join(line.split()) for line in result.stdout.splitlines()]
    bird = load_bird(IBIS).with_values({"wing.discretisation": 8})
    cycle = find_limit_cycle(RigidModel(bird))
    (row,) = [each for each in rows if each.startswith("1 ")][:1]
    assert row.split()[:4] == [
        "1",
        f"{cycle.mean_speed:.2f}",
        f"{cycle.mean_climb_rate:+.2f}",
        f"{np.degrees(cycle.mean_pitch):+.0f}",
    ]
    assert "unstable" in row
    assert max(map(len, result.stdout.splitlines())) <= 100


def test_a_sprung_pigeon_has_a_stable_and_an_unstable_flight(run, pigeon):
    result = run("flights", pigeon, *TRIMMED, *SPRUNG, "--json")
    assert result.exit_code == 0, result.stderr
    slow, fast = flights_of(result)
    # A search and a sweep reported one of them each, with the other discretisation of the roll.
    assert slow == pytest.approx((13.83, 1.23, 0.982), abs=0.01)
    assert fast == pytest.approx((20.40, -2.80, 1.131), abs=0.01)
    # Either way `cycle` knows of the other.
    found = json.loads(run("cycle", pigeon, *TRIMMED, *SPRUNG, "--json").stdout)
    (other,) = found["other_flights"]
    speeds = sorted([found["mean_speed"], other["mean_speed"]])
    assert speeds == pytest.approx([slow[0], fast[0]], abs=1e-3)


def test_cycle_names_the_other_flight(run, pigeon):
    result = run("cycle", pigeon, *RIGID, *TRIMMED)
    assert result.exit_code == 0, result.stderr
    text = " ".join(result.stdout.split())
    assert "This bird has another flight, at 23.02 m/s, climbing -5.94 m/s (unstable)" in text


def test_a_bird_with_one_flight_has_no_other(flown):
    _, found, _ = flown
    assert found["other_flights"] == []


def test_where_there_is_no_flight_it_says_what_to_do_next(run, pigeon):
    """Below -8.57 deg of roll a branch of flights folds back, and there is none beyond."""
    for command in ("cycle", "flights"):
        result = run(command, pigeon, *RIGID, "--json")
        assert result.exit_code == 1
        assert "birdmb trim" in result.stderr.splitlines()[-1]
        assert "Traceback" not in result.stderr
        found = json.loads(result.stdout)
        cycles = found if command == "flights" else [found]
        for each in cycles:
            assert "error" in each or each["verdict"].startswith("not ")


def test_a_saved_flight_is_a_guess(run, pigeon, listed):
    dive = str(listed[1] / "flight_2.nc")
    result = run("cycle", pigeon, *RIGID, *TRIMMED, "--guess", dive, "--json")
    assert result.exit_code == 0, result.stderr
    found = json.loads(result.stdout)
    assert found["mean_speed"] == pytest.approx(23.02, abs=0.01)
    assert [each["mean_speed"] for each in found["other_flights"]] == [
        pytest.approx(16.23, abs=0.01)
    ]
    assert f"Starting from the cycle in {dive}." in result.stderr
    # A guess of another model: what it lacks is the model's own.
    sprung = run("cycle", pigeon, *TRIMMED, *SPRUNG, "--guess", dive, "--json")
    assert json.loads(sprung.stdout)["mean_speed"] == pytest.approx(20.40, abs=0.01)
    shot = run("cycle", pigeon, *RIGID, *TRIMMED, "--guess", dive, "--segments", "3", "--json")
    assert json.loads(shot.stdout)["mean_speed"] == pytest.approx(23.02, abs=0.01)


@pytest.fixture(scope="module")
def branch(run, tmp_path_factory):
    store = tmp_path_factory.mktemp("branch") / "branch.nc"
    result = run(
        "branch", IBIS, *QUICK, "--parameter", "body.mass", "--from", "1.2", "--to", "1.25",
        "--store", str(store), "--json",
    )  # fmt: skip
    assert result.exit_code == 0, result.stderr
    return store


def test_a_point_of_a_branch_is_a_guess(run, branch):
    options = (*QUICK, "--set", "body.mass=1.25", "--guess", str(branch))
    result = run("cycle", IBIS, *options, "--point", "-1", "--json")
    assert result.exit_code == 0, result.stderr
    assert "body.mass = 1.25" in result.stderr
    found = json.loads(result.stdout)
    first_residual = float(result.stderr.splitlines()[3].split()[1])
    # On the very flight: the first point of the branch would be further off.
    assert first_residual < 1e-2
    assert found["iterations"] <= 6


def test_guesses_that_are_none(run, branch, tmp_path):
    text = tmp_path / "notes.nc"
    text.write_text("no NetCDF")
    empty = tmp_path / "empty.nc"
    xr.Dataset({"x": ("a", [1.0])}).to_netcdf(empty, engine="h5netcdf")
    cases = {
        ("--guess", str(tmp_path / "none.nc")): "no such file",
        ("--guess", str(text)): "cannot be read as NetCDF",
        ("--guess", str(empty)): "holds no limit cycle of a bird",
        ("--guess", str(branch)): "say which with --point",
        ("--guess", str(branch), "--point", "99"): "there is no --point 99",
        ("--guess", str(branch), "--point", "0"): "there is no --point 0",
        ("--guess", str(empty), "--point", "1"): "--point is of a branch",
        ("--point", "1"): "give its file with --guess",
    }
    for options, says in cases.items():
        result = run("cycle", IBIS, *QUICK, *options)
        assert result.exit_code == 2, result.stderr
        assert says in result.stderr
        assert len(result.stderr.splitlines()) == 1
        assert result.stdout == ""
