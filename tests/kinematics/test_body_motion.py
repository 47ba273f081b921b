"""Birds that fly and turn, with markers on the body."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import birdmb

from .flights import NOISE, points_of, without
from .test_round_trip import z_scores

PLACES = {
    "back": [0.08, 0.0, -0.03],
    "rump": [-0.08, 0.02, -0.03],
    "left": [0.0, -0.03, -0.01],
    "keel": [0.02, 0.0, 0.04],
}
MARKERS = {name: {"body": place} for name, place in PLACES.items()}


@pytest.fixture(scope="module")
def flight(flown_pigeon):
    """Points in the axes of a room while the pigeon flies by, pitching and rolling."""
    clean = points_of(flown_pigeon, noise=0.0)
    times, root = clean["time"], flown_pigeon.wing.root
    beat = 2.0 * np.pi * flown_pigeon.gait.frequency * times
    angles = [0.3 * np.sin(3 * times), 0.2 + 0.2 * np.sin(beat + 1.0), 0.1 * np.sin(4 * times)]
    turn = Rotation.from_euler("zyx", np.column_stack(angles)).as_matrix()
    path = np.column_stack([9.0 * times, 0.4 * times**2, 1.0 - 0.02 * np.sin(beat)])
    shoulder = np.array([root.x, root.y, root.z])
    placed = {k: v + shoulder for k, v in without(clean, "time").items()}
    placed |= {k: np.tile(place, (len(times), 1)) for k, place in PLACES.items()}
    random = np.random.default_rng(2)
    return {"time": times} | {
        name: np.einsum("nij,nj->ni", turn, points)
        + path
        + NOISE * random.standard_normal(path.shape)
        for name, points in placed.items()
    }


def test_markers_on_the_body_take_its_motion_off(flight, flown_pigeon, pigeon):
    fit = birdmb.fit_kinematics(flight, pigeon, markers=MARKERS)
    scores = z_scores(fit, flown_pigeon)
    assert max(map(abs, scores.values())) < 4.5
    assert np.sqrt(np.mean(np.square(list(scores.values())))) < 1.5
    assert np.degrees(fit.joints["shoulder.flap"].amplitude_errors[0]) < 0.5


def test_the_shoulder_may_be_hidden(flight, flown_pigeon, pigeon):
    fit = birdmb.fit_kinematics(without(flight, "shoulder"), pigeon, markers=MARKERS)
    assert max(map(abs, z_scores(fit, flown_pigeon).values())) < 4.5


def test_left_handed_axes_are_noticed(flight, pigeon):
    mirrored = {k: v if k == "time" else v * (1.0, 1.0, -1.0) for k, v in flight.items()}
    with pytest.raises(birdmb.KinematicsError, match="left-handed"):
        birdmb.fit_kinematics(mirrored, pigeon, markers=MARKERS)


def test_markers_on_a_line_tell_no_attitude(flight, pigeon):
    line = {name: {"body": [0.1 * i, 0.0, 0.0]} for i, name in enumerate(PLACES)}
    with pytest.raises(birdmb.KinematicsError, match="not on a line"):
        birdmb.fit_kinematics(flight, pigeon, markers=line)
