"""Gaits that are known, back from points of them."""

import numpy as np
import pytest

import birdmb
from birdmb.topology import Bird

from .flights import NOISE, angles_of, in_frame, points_of, without

BACK = np.diag([1.0, -1.0, -1.0])  # from axes forward, left, up


def z_scores(fit: birdmb.KinematicsFit, flown: Bird) -> dict[str, float]:
    """Errors of all that is stated, in standard errors."""
    found = {"frequency": (fit.frequency - flown.gait.frequency) / fit.frequency_error}
    for name, motion in fit.joints.items():
        driver = flown.joint(name).driver
        found[f"{name}.offset"] = (motion.offset - driver.mean) / motion.offset_error
        for i, amplitude in enumerate(motion.amplitudes):
            true = driver.amplitudes[i] if i < len(driver.amplitudes) else 0.0
            found[f"{name}.amplitude {i + 1}"] = (amplitude - true) / motion.amplitude_errors[i]
            if (name, i) != (fit.reference, 0) and true:
                phase = np.arctan2(driver.cosine[i], driver.sine[i])
                off = np.remainder(motion.phases[i] - phase + np.pi, 2.0 * np.pi) - np.pi
                found[f"{name}.phase {i + 1}"] = off / motion.phase_errors[i]
    return found


@pytest.mark.long
@pytest.mark.parametrize("which", ["flown_ibis", "flown_pigeon"])
def test_a_gait_comes_back_within_the_errors_that_it_states(request, which, ibis, pigeon):
    """1 mm, 240 frames a second: the scatter of the results is the one that is stated."""
    flown = request.getfixturevalue(which)
    like = ibis if which == "flown_ibis" else pigeon
    scores = []
    for seed in range(8):
        fit = birdmb.fit_kinematics(points_of(flown, seed=seed), like, frame="body")
        assert fit.undetermined == ()
        own = z_scores(fit, flown)
        scores += own.values()
        assert max(map(abs, own.values())) < 4.5
        assert fit.bird.gait.frequency == pytest.approx(fit.frequency, abs=1e-6)
    assert len(scores) > 120
    assert 0.75 < np.sqrt(np.mean(np.square(scores))) < 1.2
    for marker in fit.markers.values():
        assert marker.residual == pytest.approx(NOISE, rel=0.15)


def test_the_bird_that_comes_back_moves_as_the_measured_one(flown_ibis, ibis):
    fit = birdmb.fit_kinematics(points_of(flown_ibis), ibis, frame="body")
    phases = np.arange(50) / 50.0
    for name in ibis.joint_names:
        own, true = fit.bird.joint(name).driver, flown_ibis.joint(name).driver
        assert np.degrees(np.abs(own.at(phases) - true.at(phases)).max()) < 0.25
        assert fit.joints[name].at(phases) == pytest.approx(own.at(phases), abs=1e-7)
    assert len(fit.joints["shoulder.flap"].amplitudes) == 2


def test_a_bar_on_one_joint_turns_by_the_angle_of_its_end():
    """By hand: about [-1, 0, 0] the end of a bar is at (0, L cos q, -L sin q)."""
    length, rate = 0.3, 3.0
    bar = birdmb.Bird.model_validate(
        {
            "name": "bar",
            "gait": {"frequency": 2.0},
            "body": {"mass": 0.3, "inertia_yy": 1e-3},
            "wing": {"root": {"x": 0, "y": 0.02, "z": 0}},
            "segments": {"bar": {"length": length, "mass": 0.01, "inertia": [1e-5, 0, 1e-5]}},
            "joints": [{"name": "root.flap", "segment": "bar", "axis": [-1, 0, 0]}],
            "sections": [
                {"name": "in", "bone": "bar", "position": 0, "chord": 0.1},
                {"name": "out", "bone": "bar", "position": 1, "chord": 0.1},
            ],
        }
    )
    times = np.arange(500) / 200.0
    angle = (
        0.2 + 0.5 * np.sin(2.0 * np.pi * rate * times) + 0.1 * np.cos(4.0 * np.pi * rate * times)
    )
    end = length * np.column_stack([np.zeros_like(angle), np.cos(angle), -np.sin(angle)])
    data = {"time": times, "shoulder": np.zeros((500, 3)), "bar.end": end}
    fit = birdmb.fit_kinematics(data, bar, frame="body", harmonics=3)
    motion = fit.joints["root.flap"]
    assert fit.frequency == pytest.approx(rate, abs=1e-7)
    assert motion.offset == pytest.approx(0.2, abs=1e-7)
    assert motion.amplitudes == pytest.approx([0.5, 0.1, 0.0], abs=1e-7)
    # t = 0 is in the middle of the downstroke; sin has its own there half a beat later.
    assert motion.phases[0] == pytest.approx(np.pi)
    assert np.mod(motion.phases[1], 2.0 * np.pi) == pytest.approx(0.5 * np.pi, abs=1e-6)
    assert fit.start == pytest.approx(0.5 / rate, abs=1e-7)


def test_axes_may_point_anywhere(flown_pigeon, pigeon):
    data = points_of(flown_pigeon)
    body = birdmb.fit_kinematics(data, pigeon, frame="body")
    for name in ("forward-left-up", "+x-y-z"):
        fit = birdmb.fit_kinematics(in_frame(data, BACK), pigeon, frame=name)
        assert fit.bird == body.bird


def test_gaps_cost_no_more_than_their_samples(flown_pigeon, pigeon):
    data = points_of(flown_pigeon, beats=6.0)
    random = np.random.default_rng(3)
    for name in without(data, "time"):
        data[name][random.random(len(data["time"])) < 0.3] = np.nan
    data["wrist"][40:80] = np.nan
    fit = birdmb.fit_kinematics(data, pigeon, frame="body")
    scores = list(z_scores(fit, flown_pigeon).values())
    assert max(map(abs, scores)) < 4.5
    assert fit.markers["wrist"].missing >= 40


def test_without_the_elbow_the_feathers_tell_it(flown_pigeon, pigeon):
    fit = birdmb.fit_kinematics(without(points_of(flown_pigeon), "elbow"), pigeon, frame="body")
    assert fit.undetermined == ()
    assert max(map(abs, z_scores(fit, flown_pigeon).values())) < 4.5


def test_joints_that_nothing_tells_keep_their_drivers(flown_pigeon, pigeon):
    data = points_of(flown_pigeon, feathers=False)
    fit = birdmb.fit_kinematics(without(data, "hand_tip"), pigeon, frame="body")
    assert fit.undetermined == ("forearm.roll", "wrist.sweep")
    for name in fit.undetermined:
        assert fit.bird.joint(name) == pigeon.joint(name)
    elbow = birdmb.fit_kinematics(without(data, "hand_tip", "wrist"), pigeon, frame="body")
    assert set(elbow.joints) < {"shoulder.pitch", "shoulder.flap", "shoulder.sweep"}
    assert "shoulder.flap" in elbow.joints


def test_angles_are_read_as_well(flown_ibis, ibis):
    data = angles_of(flown_ibis)
    fit = birdmb.fit_kinematics(data, ibis)
    assert max(map(abs, z_scores(fit, flown_ibis).values())) < 4.5
    degrees = {k if k == "time" else f"{k}_deg": v for k, v in data.items()}
    degrees |= {k: np.degrees(v) for k, v in degrees.items() if k != "time"}
    assert birdmb.fit_kinematics(degrees, ibis).bird == fit.bird
    some = birdmb.fit_kinematics({k: data[k] for k in ("time", "shoulder.flap")}, ibis)
    assert some.undetermined == tuple(n for n in ibis.joint_names if n != "shoulder.flap")
    assert some.bird.joint("wrist.sweep") == ibis.joint("wrist.sweep")


def test_one_averaged_beat_is_enough_where_its_frequency_is_known(flown_ibis, ibis):
    data = angles_of(flown_ibis, beats=1.0)
    fit = birdmb.fit_kinematics(data, ibis, frequency=4.13)
    assert (fit.frequency, fit.frequency_error) == (4.13, 0.0)
    assert any("no two whole beats" in remark for remark in fit.remarks)


def test_beats_that_differ_widen_the_errors(ibis):
    """Amplitudes that change from beat to beat by 2 degrees, and little noise."""
    times = np.arange(1200) / 200.0
    beat = np.floor(4.0 * times).astype(int)
    swing = np.radians(40.0 + 2.0 * np.random.default_rng(5).standard_normal(30))
    angle = swing[beat] * np.sin(8.0 * np.pi * times)
    fit = birdmb.fit_kinematics({"time": times, "shoulder.flap": angle}, ibis, harmonics=1)
    motion = fit.joints["shoulder.flap"]
    error = np.std(swing[:24], ddof=1) / np.sqrt(24)
    assert motion.amplitude_errors[0] == pytest.approx(error, rel=0.3)
    assert motion.scatter == pytest.approx(np.std(swing[:24]) / np.sqrt(2.0), rel=0.3)
    assert abs(motion.amplitudes[0] - swing[:24].mean()) < 0.2 * error
    assert fit.beats == 24
