"""`birdmb trim`, `birdmb gust`, `birdmb tail-study` and `birdmb scale`."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import birdmb

from .conftest import IBIS, TOPOLOGIES

TAIL = str(TOPOLOGIES / "ibis_tail.toml")
COARSE = ("--set", "wing.discretisation.elements=8")


def test_trim_writes_the_bird_that_it_found(run, tmp_path):
    out = tmp_path / "trimmed.toml"
    done = run(
        "trim", TAIL, "--model", "rigid", "--speed", "13", "--out", str(out),
        "--set", "tail.opening_deg=20", *COARSE,
    )  # fmt: skip
    assert done.exit_code == 0, done.stderr
    assert "speed 13.0000 m/s" in done.stdout
    assert "stable" in done.stdout
    bird = birdmb.load_bird(out).with_values({"wing.discretisation.elements": 8})
    cycle = birdmb.find_limit_cycle(birdmb.RigidModel(bird))
    assert cycle.mean_speed == pytest.approx(13.0, abs=1e-5)
    assert cycle.mean_climb_rate == pytest.approx(0.0, abs=1e-5)


def test_trim_keeps_the_file_and_what_was_set_for_the_bird(run, tmp_path):
    """How finely the search computed is none of the bird's values."""
    out = tmp_path / "trimmed.toml"
    done = run(
        "trim", TAIL, "--model", "rigid", "--out", str(out), "--set", "tail.opening_deg=20", *COARSE
    )  # fmt: skip
    assert done.exit_code == 0, done.stderr
    assert "not the wing.discretisation.elements=8 of this search" in done.stdout
    before = (TOPOLOGIES / "ibis_tail.toml").read_text().splitlines()
    about, after = out.read_text().splitlines()[:3], out.read_text().splitlines()[3:]
    roll = birdmb.load_bird(out).value("forearm.roll.offset_deg")
    assert about == [
        f"# Trimmed to climb rate 0 m/s (rigid model): forearm.roll.offset_deg = {roll:.6g}.",
        "# Set before: tail.opening_deg=20.",
        "# Found with wing.discretisation.elements=8, which is not kept.",
    ]
    opening, offset = (line for line, old in zip(after, before, strict=True) if line != old)
    assert opening == "opening_deg = 20.0              # angle between its sides, 0 if furled"
    key, _, value = offset.removesuffix("  # levels the flight").partition(" = ")
    assert key == "offset_deg"
    assert float(value) == pytest.approx(roll, rel=1e-14)
    assert birdmb.load_bird(out).wing.discretisation == "converged"


def test_trim_as_json_has_values_flight_and_files(run, tmp_path):
    out = tmp_path / "trimmed.toml"
    set_to = "--set", "tail.opening_deg=20", *COARSE
    arguments = "trim", TAIL, "--model", "rigid", "--speed", "13", *set_to, "--json"
    done = run(*arguments, "--out", str(out))
    assert done.exit_code == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["trim"]["residual"] < 1e-5
    bird = birdmb.load_bird(out)
    assert len(found["trim"]["values"]) == 2
    for name, value in found["trim"]["values"].items():
        assert value == pytest.approx(bird.value(name), rel=1e-14)
    assert found["mean_speed"] == pytest.approx(13.0, abs=1e-5)
    assert found["files"] == [str(out)]
    unwritten = run(*arguments, "--out", str(tmp_path / "trimmed.toml" / "in_a_file.toml"))
    assert unwritten.exit_code != 0
    lost = json.loads(unwritten.stdout)  # what was found is told nevertheless
    assert lost["trim"] == found["trim"]
    assert "in_a_file.toml" in lost["error"]


def test_no_trim_is_a_sentence(run):
    done = run("trim", TAIL, "--model", "rigid", "--by", "forearm.roll.offset_deg=10:12", *COARSE)
    assert done.exit_code == 1
    assert "no trim to climb rate 0 m/s" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--by", "forearm.roll.offset_deg=3"), "NAME=LOWEST:HIGHEST"),
        (("--by", "forearm.rol.offset_deg=-3:3"), "no value is called"),
        (("--by", "forearm.roll.offset_deg=-3:3", "--speed", "13"), "2 parameter(s), not 1"),
    ],
)
def test_wrong_bounds(run, arguments, said):
    done = run("trim", TAIL, *arguments)
    assert done.exit_code == 2
    assert said in " ".join(done.stderr.split())


def test_gust(run, tmp_path):
    gust = ("gust", TAIL, "--model", "rigid", "--vertical", "0.5", "--beats", "4", *COARSE)
    done = run(*gust, "--axes", "body", "--out", str(tmp_path / "out"), "--json")
    assert done.exit_code == 0, done.stderr
    found = json.loads(done.stdout)
    assert [Path(name).name for name in found["files"]] == [
        "gust.nc",
        "gust.png",
        "gust_states.png",
    ]
    assert all(Path(name).stat().st_size > 1000 for name in found["files"])
    assert found["gust"] == {
        "kind": "gaussian", "axes": "body", "vertical": 0.5, "horizontal": 0.0, "lateral": 0.0,
        "time": 0.25, "width": 0.05,
    }  # fmt: skip
    with xr.open_dataset(tmp_path / "out" / "gust.nc") as data:
        largest = np.abs(data.deviation).max("time")
        expected = dict(zip(data.state.values, largest.values, strict=True))
    assert found["largest_deviation"] == pytest.approx(expected)
    in_world = json.loads(run(*gust, "--json").stdout)
    assert in_world["largest_deviation"] != found["largest_deviation"]
    slow = found["modes"][0]
    assert slow["period"] == pytest.approx(
        0.25 * 2 * np.pi / np.angle(complex(*slow["multiplier"]))
    )


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((), "give the gust a strength"),
        (("--lateral", "1"), 'motion="free"'),
        (("--kind", "step", "--vertical", "1", "--length", "1"), "--length has no effect"),
        (("--vertical", "nan"), "--vertical must be"),
    ],
)
def test_impossible_gusts(run, arguments, said):
    done = run("gust", TAIL, "--model", "rigid", *arguments, *COARSE)
    assert done.exit_code == 2
    assert said in " ".join(done.stderr.split())


def test_a_flight_that_a_gust_ends_is_no_success(run):
    blown = ("--kind", "step", "--vertical", "1e3")
    done = run("gust", TAIL, "--model", "rigid", *blown, *COARSE, "--json")
    assert done.exit_code == 1
    assert json.loads(done.stdout)["failure"]


@pytest.mark.long
def test_tail_study(run, tmp_path):
    store = tmp_path / "tail.db"
    out = tmp_path / "figures"
    done = run(
        "tail-study", TAIL, "--store", str(store), "--every", "24", "--out", str(out), *COARSE
    )
    assert done.exit_code == 0, done.stderr
    assert "fly level" in done.stdout
    names = {path.name for path in out.iterdir()}
    figures = ("manifold", "envelope", "pareto", "stability_opening")
    assert names == {"tail.nc"} | {f"tail_{name}.png" for name in figures}


@pytest.mark.parametrize(
    ("limit", "said"),
    [
        ("mean_yaw=3", "flights are not described by it"),
        ("mean_pitch", "NAME=LARGEST"),
        ("mean_pitch=-1", "NAME=LARGEST"),
    ],
)
def test_impossible_limits_are_told_before_anything_is_flown(run, tmp_path, limit, said):
    store = tmp_path / "x.db"
    done = run("tail-study", TAIL, "--store", str(store), "--limit", limit)
    assert done.exit_code == 2
    assert said in " ".join(done.stderr.split())
    assert not store.exists()


def test_tail_study_needs_a_tail(run, tmp_path):
    done = run("tail-study", IBIS, "--store", str(tmp_path / "x.db"))
    assert done.exit_code == 2
    assert "ibis has no tail" in done.stderr


@pytest.mark.long
def test_sweep_of_trimmed_flights(run, tmp_path):
    store = tmp_path / "level.db"
    done = run(
        "sweep", TAIL, "--model", "rigid", "--vary", "shoulder.flap.amplitude_deg=42,40",
        "--set", "tail.opening_deg=10", "--trim", "forearm.roll.offset_deg=-30:30",
        "--store", str(store), "--workers", "1", *COARSE,
    )  # fmt: skip
    assert done.exit_code == 0, done.stderr
    data = birdmb.Study.open(store).to_xarray()
    assert abs(data.mean_climb_rate).max() < 1e-6
    assert data["forearm.roll.offset_deg"].notnull().all()
    other = run(
        "sweep", TAIL, "--model", "rigid", "--vary", "shoulder.flap.amplitude_deg=42,40",
        "--set", "tail.opening_deg=10", "--store", str(store), *COARSE,
    )  # fmt: skip
    assert other.exit_code == 2
    assert "the trim is" in " ".join(other.stderr.split())


def test_speed_without_parameters(run, tmp_path):
    done = run(
        "sweep", TAIL, "--vary", "shoulder.flap.amplitude_deg=42,40", "--speed", "13",
        "--store", str(tmp_path / "x.db"),
    )  # fmt: skip
    assert done.exit_code == 2
    assert "--trim" in done.stderr


def test_scale(run, tmp_path):
    printed = run("scale", "--mass", "0.4")
    assert printed.exit_code == 0
    assert printed.stdout.startswith("# A bird of 0.4 kg")
    out = tmp_path / "small.toml"
    assert run("scale", "--mass", "0.4", "--out", str(out)).exit_code == 0
    assert out.read_text() == printed.stdout
    assert birdmb.load_bird(out).total_mass == pytest.approx(0.4)
    assert run("check", str(out)).exit_code == 0


def test_scale_by_no_mass(run):
    done = run("scale", "--mass", "-1")
    assert done.exit_code == 2
    assert "--mass must be 1e-09 to 100000, not" in done.stderr
