"""`birdmb kinematics`, from a table of points to multipliers."""

import json

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import birdmb

from ..cli.conftest import run  # noqa: F401 - a fixture
from .flights import angles_of, points_of, written


def test_from_points_to_multipliers(run, flown_pigeon, pigeon_file, tmp_path):  # noqa: F811
    """The file keeps all but the gait, and the bird that flew those multipliers."""
    points = written(points_of(flown_pigeon, beats=8.0), tmp_path / "points.csv")
    mine, figure = tmp_path / "mine.toml", tmp_path / "fit.png"
    done = run(
        "kinematics", points, "--like", str(pigeon_file), "--frame", "body", "-o", str(mine),
        "--figure", str(figure),
    )  # fmt: skip
    assert done.exit_code == 0, done.stderr
    assert "8 whole beats" in done.stdout or "7 whole beats" in done.stdout
    assert f"wrote {mine}" in done.stdout.replace("\n", "")
    assert figure.read_bytes().startswith(b"\x89PNG")
    levelled = ("--model", "rigid", "--set", "forearm.roll.offset_deg=-10", "--json")
    cycle = run("cycle", str(mine), *levelled)
    assert cycle.exit_code == 0, cycle.stderr
    true = tmp_path / "true.toml"
    flown_pigeon.save(true)
    expected = json.loads(run("cycle", str(true), *levelled).stdout)
    found = json.loads(cycle.stdout)
    assert found["mean_speed"] == pytest.approx(expected["mean_speed"], rel=0.01)
    moduli = [np.abs([complex(*m) for m in each["multipliers"]]) for each in (found, expected)]
    assert moduli[0] == pytest.approx(moduli[1], abs=0.02)


def test_comments_stay_and_only_the_gait_changes(run, ibis, tmp_path):  # noqa: F811
    flown = ibis.with_values({"shoulder.flap.amplitude_deg": 35.0, "gait.frequency": 4.4})
    angles = written(angles_of(flown), tmp_path / "angles.csv")
    mine = tmp_path / "mine.toml"
    done = run("kinematics", angles, "--like", "ibis", "-o", str(mine), "--json")
    assert done.exit_code == 0, done.stderr
    said = json.loads(done.stdout)
    assert said["undetermined"] == []
    assert said["frequency"] == pytest.approx(4.4, abs=5.0 * said["frequency_error"])
    before = birdmb.topology.shipped.topology_file("ibis").read_text().splitlines()
    after = mine.read_text().splitlines()
    assert after[0].startswith("# Gait fitted to angles.csv: ")
    changed = [new for new, old in zip(after[1:], before, strict=True) if new != old]
    keys = {line.split("=")[0].strip() for line in changed}
    assert keys <= {
        "frequency", "offset", "amplitude", "offset_deg", "amplitude_deg", "phase_deg"
    }  # fmt: skip
    assert "# wingbeats per second" in next(line for line in changed if "frequency" in line)
    assert birdmb.load_bird(mine).joint("shoulder.flap").amplitude == pytest.approx(
        said["joints"]["shoulder.flap"]["amplitudes"][0], abs=1e-7
    )


def test_what_is_wrong_is_one_sentence(run, tmp_path):  # noqa: F811
    path = tmp_path / "points.csv"
    path.write_text("time,elbow_x,elbow_y\n" + "".join(f"{i},0,0\n" for i in range(10)))
    done = run("kinematics", str(path), "--like", "ibis", "--frame", "body")
    assert done.exit_code == 2
    assert "the marker elbow has no column elbow_z" in done.stderr.replace("\n", " ")
    assert "Traceback" not in done.stderr


def test_the_figure_shows_what_was_measured_and_fitted(flown_pigeon, pigeon):
    fit = birdmb.fit_kinematics(points_of(flown_pigeon), pigeon, frame="body")
    figure = fit.plot()
    FigureCanvasAgg(figure).draw()
    shown = [axes for axes in figure.axes if axes.get_visible()]
    assert len(shown) == len(pigeon.joints) + len(fit.markers)
    wrist = next(axes for axes in shown if axes.get_ylabel() == "wrist (mm)")
    dots = wrist.get_lines()[0].get_ydata()
    assert dots == pytest.approx(1e3 * fit.measured[:, fit.column("wrist")])
    off = fit.measured - fit.fitted
    assert np.sqrt(np.mean(off**2)) == pytest.approx(1e-3, rel=0.15)


@pytest.mark.parametrize(
    "driver",
    [
        "amplitude_deg = 50\nphase_deg = 180\ndownstroke_fraction = 0.6",
        "samples_deg = [0, -40, 10, 45, 20]\ngain = 0.9",
        'file = "flap.csv"',
        "amplitude_deg = 50\nphase_deg = 180\nharmonics = [{ order = 2, sine_deg = 3 }]",
    ],
)
def test_whatever_the_driver_was_given_by_goes(pigeon_file, flown_pigeon, tmp_path, driver):
    """The joint that is told gets its harmonics in place of samples, strokes and files."""
    (tmp_path / "flap.csv").write_text("phase,angle_deg\n0,0\n0.25,-40\n0.5,5\n0.75,45\n")
    text = pigeon_file.read_text().replace("amplitude_deg = 50\nphase_deg = 180", driver, 1)
    like = tmp_path / "like.toml"
    like.write_text(text)
    fit = birdmb.fit_kinematics(points_of(flown_pigeon), like, frame="body")
    flap = birdmb.load_bird(fit.write(tmp_path / "mine.toml")).joint("shoulder.flap")
    assert (flap.samples, flap.downstroke_fraction, flap.gain, flap.harmonics) == (
        None,
        None,
        1,
        (),
    )
    assert np.degrees(flap.amplitude) == pytest.approx(44.0, abs=0.3)
