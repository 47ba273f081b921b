"""What is wrong with a measured motion: a sentence that names file, column and what to do."""

import sys
import types

import numpy as np
import pytest
import xarray as xr

import birdmb

from .flights import angles_of, in_frame, points_of, scaled, without, written

PERMUTED = {
    "right-forward-down": [[0, 1, 0], [1, 0, 0], [0, 0, 1]],
    "forward-down-right": [[1, 0, 0], [0, 0, 1], [0, 1, 0]],
    "forward-left-down": [[1, 0, 0], [0, -1, 0], [0, 0, 1]],
    "backward-right-down": [[-1, 0, 0], [0, 1, 0], [0, 0, 1]],
    "forward-left-up": [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
}


@pytest.fixture(scope="module")
def points(flown_pigeon):
    return points_of(flown_pigeon)


@pytest.mark.parametrize("axes", PERMUTED)
def test_swapped_axes_are_noticed_and_the_right_ones_named(points, pigeon, axes):
    data = in_frame(points, np.array(PERMUTED[axes], dtype=float))
    with pytest.raises(birdmb.KinematicsError, match=f"{axes}.*check --frame"):
        birdmb.fit_kinematics(data, pigeon, frame="body")


def test_up_for_down_is_a_mirrored_wing_and_a_remark(points, pigeon):
    """A wing of sweeping joints mirrored in its plane is a wing too, of another gait."""
    data = in_frame(points, np.diag([1.0, 1.0, -1.0]))
    fit = birdmb.fit_kinematics(data, pigeon, frame="body")
    assert any("forward-right-up" in remark for remark in fit.remarks)


def test_millimetres_for_metres(points, pigeon):
    for lengths in (False, True):
        with pytest.raises(
            birdmb.KinematicsError, match=r"if they are in mm, say so \(--unit mm\)"
        ):
            birdmb.fit_kinematics(scaled(points, 1e3), pigeon, frame="body", lengths=lengths)
    told = birdmb.fit_kinematics(scaled(points, 1e3), pigeon, frame="body", unit="mm")
    assert told.bird == birdmb.fit_kinematics(points, pigeon, frame="body").bird


def test_degrees_for_radians(flown_ibis, ibis):
    data = scaled(angles_of(flown_ibis), 180.0 / np.pi)
    with pytest.raises(
        birdmb.KinematicsError, match=r"if it is in degrees, call it shoulder\.\w+_deg"
    ):
        birdmb.fit_kinematics(data, ibis)
    small = {k if k == "time" else f"{k}_deg": v for k, v in angles_of(flown_ibis).items()}
    assert any("radians" in remark for remark in birdmb.fit_kinematics(small, ibis).remarks)


def test_bones_of_other_lengths_are_told_and_taken(points, pigeon):
    data = scaled(without(points, *(f"feathers.{f.name}" for f in pigeon.feathers)), 1.3)
    fit = birdmb.fit_kinematics(data, pigeon, frame="body")
    assert sum("--lengths" in remark for remark in fit.remarks) == 3
    fitted = birdmb.fit_kinematics(data, pigeon, frame="body", lengths=True)
    assert fitted.bird.segments["humerus"].length == pytest.approx(1.3 * 0.047, rel=0.01)
    assert fitted.remarks == ()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: {k: v[:25] for k, v in d.items()}, "less than one beat"),
        (lambda d: {k: v[:5] for k, v in d.items()}, "has 5 frames"),
        (lambda d: {**d, "time": d["time"][::-1]}, "time of frame 2 is not after"),
        (lambda d: without(d, "time"), "no column"),
        (lambda d: without(d, "shoulder"), "no marker shoulder"),
        (lambda d: {**d, "nose": d["elbow"]}, 'place of the marker "nose" is not known'),
        (lambda d: {**d, "wrist.swep": d["time"]}, r"nearest joints: wrist\.sweep"),
        (lambda d: {**d, "elbow": d["wrist"], "wrist": d["elbow"]}, "which marker is which"),
        (lambda d: {"time": d["time"]}, "no markers"),
        (lambda d: {k: v if k == "time" else 0 * v + v[0] for k, v in d.items()}, "nothing moves"),
        (
            lambda d: {
                k: v if k == "time" else 0.1 * np.random.default_rng(i).standard_normal(v.shape)
                for i, (k, v) in enumerate(d.items())
            },
            "no periodic motion",
        ),
        (
            lambda d: {k: v if k == "time" else np.where(np.arange(len(v))[:, None] < 6, v, np.nan)
                       for k, v in d.items()},
            "6 of 179 frames",
        ),
    ],
)  # fmt: skip
def test_what_tells_no_gait_is_refused(points, pigeon, change, message):
    with pytest.raises(birdmb.KinematicsError, match=message):
        birdmb.fit_kinematics(change(points), pigeon, frame="body")


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({}, birdmb.KinematicsError, "say where the axes"),
        ({"frame": "up-up-left"}, birdmb.KinematicsError, "forward-left-up"),
        ({"frame": "body", "rate": 240.0}, birdmb.KinematicsError, "keep one"),
        ({"frame": "body", "unit": "inch"}, birdmb.KinematicsError, "one of m, cm, mm"),
        ({"frame": "body", "frequency": -1.0}, birdmb.ArgumentError, "positive"),
        ({"frame": "body", "harmonics": 0}, birdmb.ArgumentError, "1 harmonic or more"),
        ({"frame": "body", "harmonics": 99}, birdmb.KinematicsError, "harmonics, not 99"),
        ({"frame": "body", "markers": {"toe": {"body": [0, 0, 0]}}}, birdmb.KinematicsError, "toe"),
        (
            {"frame": "body", "markers": {"elbow": {"segment": "femur"}}},
            birdmb.KinematicsError,
            "there are humerus, forearm, hand",
        ),
    ],
)
def test_options_that_cannot_be(points, pigeon, options, error, message):
    with pytest.raises(error, match=message):
        birdmb.fit_kinematics(points, pigeon, **options)


def test_a_cell_that_is_no_number_is_found(points, pigeon, tmp_path):
    path = tmp_path / "points.csv"
    written(points, path)
    lines = path.read_text().splitlines()
    lines[3] = lines[3].replace(lines[3].split(",")[5], "abc", 1)
    path.write_text("# a comment\n" + "\n".join(lines))
    with pytest.raises(birdmb.KinematicsError, match=r'line 5, column elbow_y: "abc" is no number'):
        birdmb.fit_kinematics(path, pigeon, frame="body")
    path.write_text("\n".join([*lines[:2], lines[2] + ",1"]))
    with pytest.raises(birdmb.KinematicsError, match="line 3 has 26 cells, the header 25"):
        birdmb.fit_kinematics(path, pigeon, frame="body")
    with pytest.raises(birdmb.KinematicsError, match="cannot be read"):
        birdmb.fit_kinematics(tmp_path / "none.csv", pigeon, frame="body")


def test_all_formats_tell_the_same(points, pigeon, tmp_path, monkeypatch):
    given = birdmb.fit_kinematics(points, pigeon, frame="body")
    names = list(without(points, "time"))
    dataset = xr.Dataset(
        {n: (("time", "axis"), 1e3 * points[n], {"units": "mm"}) for n in names},
        {"time": points["time"]},
    )
    dataset.to_netcdf(tmp_path / "points.nc", engine="h5netcdf")
    assert birdmb.fit_kinematics(tmp_path / "points.nc", pigeon, frame="body").bird == given.bird
    (tmp_path / "points.c3d").touch()
    monkeypatch.setitem(sys.modules, "ezc3d", None)
    with pytest.raises(birdmb.KinematicsError, match=r"pip install 'birdmb\[c3d\]'"):
        birdmb.fit_kinematics(tmp_path / "points.c3d", pigeon, frame="body")
    stacked = np.stack([1e3 * points[n].T for n in names], axis=1)
    content = {
        "parameters": {
            "POINT": {
                "LABELS": {"value": names}, "RATE": {"value": [240.0]}, "UNITS": {"value": ["mm"]}
            }
        },
        "data": {"points": np.concatenate([stacked, np.ones((1, *stacked.shape[1:]))])},
    }  # fmt: skip
    reader = types.SimpleNamespace(c3d=lambda _: content)
    monkeypatch.setitem(sys.modules, "ezc3d", reader)
    assert birdmb.fit_kinematics(tmp_path / "points.c3d", pigeon, frame="body").bird == given.bird


def test_wings_of_two_gaits_are_not_fitted(points, pigeon):
    uneven = pigeon.with_values({"shoulder.flap.left.amplitude_deg": 30.0})
    with pytest.raises(birdmb.ArgumentError, match="of its own on a side"):
        birdmb.fit_kinematics(points, uneven, frame="body")
