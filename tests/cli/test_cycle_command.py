"""`birdmb cycle`: tables, JSON and files say the same as Python does."""

import json

import numpy as np
import pytest
import xarray as xr
from matplotlib.image import imread

from birdmb import RigidModel, find_limit_cycle, load_bird
from birdmb.cli.files import prepare

from .conftest import COMPLIANT, IBIS

FIGURES = ("states.png", "multipliers.png", "loads.png", "wing.png", "overview.png")


def test_json_has_the_promised_keys_and_pythons_numbers(flown):
    _, found, _ = flown
    bird = load_bird(IBIS).with_values({"wing.discretisation": 8})
    cycle = find_limit_cycle(RigidModel(bird))
    assert list(found["x0"]) == list(cycle.state_names)
    assert np.allclose(list(found["x0"].values()), cycle.x0, rtol=1e-12, atol=0)
    assert found["period"] == cycle.period
    assert found["residual"] < 1e-8
    multipliers = np.array([complex(*pair) for pair in found["multipliers"]])
    assert np.allclose(multipliers, cycle.multipliers, atol=1e-9)
    assert (np.diff(np.abs(multipliers)) <= 1e-12).all()
    assert len(found["multiplier_errors"]) == len(multipliers)
    for key in ("mean_speed", "mean_climb_rate", "power", "potential_power", "cost_of_transport"):
        assert found[key] == pytest.approx(getattr(cycle, key), rel=1e-9)
    assert found["joint_powers"] == pytest.approx(cycle.joint_powers)
    assert found["fingerprint"] == bird.fingerprint()
    assert found["stability"] == "unstable"


def test_progress_goes_to_stderr(flown):
    result, found, _ = flown
    assert result.stdout.startswith("{")
    assert result.stdout.endswith("}\n")
    lines = result.stderr.splitlines()
    assert lines[0] == "ibis, rigid model: 4 states, wingbeat of 0.25 s"
    assert sum(line.strip()[:1].isdigit() for line in lines) == found["iterations"] + 1


def test_netcdf_says_what_json_says(flown):
    _, found, directory = flown
    with xr.open_dataset(directory / "cycle.nc", engine="h5netcdf") as data:
        assert dict(zip(data.state.values, data.x0.values, strict=True)) == found["x0"]
        real = [pair[0] for pair in found["multipliers"]]
        assert np.array_equal(data.multiplier_real, real)
        assert data.attrs["mean_speed"] == found["mean_speed"]
        assert data.attrs["fingerprint"] == found["fingerprint"]


def test_figures_are_written_and_not_blank(flown):
    _, found, directory = flown
    assert sorted(found["files"]) == sorted(str(directory / n) for n in ("cycle.nc", *FIGURES))
    for name in FIGURES:
        image = imread(directory / name)
        assert min(image.shape[:2]) > 400
        assert image[..., :3].std() > 0.02


def test_other_files_are_left_alone(flown):
    _, found, directory = flown
    assert (directory / "notes.txt").read_text() == "mine"
    assert len(list(directory.iterdir())) == len(found["files"]) + 1


def test_directories_are_made(tmp_path):
    prepare(tmp_path / "new" / "results")
    assert list((tmp_path / "new" / "results").iterdir()) == []


def test_tables_and_verdict(run):
    result = run("cycle", COMPLIANT, "--set", "wing.discretisation=4", "--steps-per-beat", "24")
    assert result.exit_code == 0, result.stderr
    assert "ibis_compliant_shoulder, multibody model: 6 states" in result.stderr
    for text in (
        "shoulder.flap.rate",
        "rad/s",
        "Floquet multipliers",
        "cost of transport",
        "driver, W",
        "energy imbalance",
        "24 steps a beat",
        "the fastest-growing disturbance doubles in 0.",
    ):
        assert text in result.stdout
    tables, _ = result.stdout.split("unstable at ")
    assert max(map(len, tables.splitlines())) <= 80


@pytest.mark.long
def test_stiff_hinges_are_integrated_implicitly_and_it_is_said(run):
    tiny = "feathers.5.hinge={stiffness = 1, damping = 0.002, rest_deg = 6.1, mass = 5e-5}"
    values = ("--set", tiny, "--set", "wing.discretisation=4", "--steps-per-beat", "16")
    result = run("cycle", IBIS, *values)
    assert result.exit_code == 0, result.stderr
    assert "ibis, multibody model: 6 states" in result.stderr
    rows = [" ".join(line.split()) for line in result.stdout.splitlines()]
    assert "integration implicit 16 steps a beat of Radau IIA: stiff joints" in rows
    assert any(row.startswith("feathers.5.hinge.rate") for row in rows)
    # In the table of powers: dissipated by the damper, no work of a driver.
    assert any(row.startswith("feathers.5.hinge -0.0") for row in rows)


def test_options_reach_model_and_search(run):
    values = ("--set", "wing.discretisation=6", "--set", "body.mass=1.3")
    options = ("--segments", "2", "--damping", "levenberg-marquardt", "--tolerance", "1e-7")
    result = run(
        "cycle", IBIS, "--model", "rigid", *values, *options, "--steps-per-beat", "60", "--json"
    )
    assert result.exit_code == 0, result.stderr
    found = json.loads(result.stdout)
    bird = load_bird(IBIS).with_values({"wing.discretisation": 6, "body.mass": 1.3})
    cycle = find_limit_cycle(
        RigidModel(bird, steps_per_beat=60),
        segments=2,
        damping="levenberg-marquardt",
        tolerance=1e-7,
    )
    assert found["x0"] == pytest.approx(dict(zip(cycle.state_names, cycle.x0, strict=True)))
    assert found["iterations"] == len(cycle.iterations) - 1
    assert found["steps_per_beat"] == 60
    assert found["integrator"] == "explicit"


FIXED_WING = """
name = "fixed"
joints = []
gait = { frequency = 4.0 }
wing = { root = { x = 0.02, y = 0.01 } }
body = { mass = 0.02, inertia_yy = 3e-5 }
tail = { apex = { x = -0.05 }, chord = 0.06, opening_deg = 60 }
segments = { bar = { length = 0.2, mass = 0.001, inertia = [1e-6, 1e-8, 1e-6] } }
drag = { profile_coefficient = 0.02 }
sections = [
  { name = "root", bone = "bar", position = 0, chord = 0.06 },
  { name = "tip", bone = "bar", position = 1, chord = 0.04 },
]
"""


def test_a_wing_without_joints_is_reported(run, tmp_path):
    topology = tmp_path / "fixed.toml"
    topology.write_text(FIXED_WING, encoding="utf-8")
    done = run("cycle", str(topology), "--model", "rigid")
    assert done.exit_code == 0, done.output
    powers = done.stdout.partition("Joint power")[2].splitlines()
    assert [line.split() for line in powers if line.startswith("all")] == [["all"] + 4 * ["0.000"]]
