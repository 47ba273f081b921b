"""Where the models look for flights from, and that a full turn makes no other flight."""

from pathlib import Path

import numpy as np
import pytest

from birdmb import MultibodyModel, RigidModel, find_limit_cycles, load_bird
from birdmb.aerodynamics.prescribed import driver_motion_along
from birdmb.models.starts import steady_states

TOPOLOGIES = Path(__file__).parents[2] / "topologies"
COARSE = {"wing.discretisation": 6}


@pytest.fixture(scope="module")
def ibis():
    return load_bird(TOPOLOGIES / "ibis.toml").with_values(COARSE)


@pytest.fixture(scope="module")
def sprung():
    return load_bird(TOPOLOGIES / "ibis_compliant_shoulder.toml").with_values(COARSE)


def times_of(bird, count=17):
    return bird.period * np.arange(count) / count


def test_steady_flights_have_their_incidence_path_angle_and_speed(ibis):
    model = RigidModel(ibis)
    states = steady_states(model, (1.0, 2.0), (5.0,), (0.0, -20.0))
    u, w, q, theta = states.T
    assert np.allclose(np.degrees(np.arctan2(w, u)), 5.0)
    assert np.allclose(np.degrees(theta - np.arctan2(w, u)), [0, -20, 0, -20])
    assert (q == 0.0).all()
    speed = np.hypot(u, w)
    assert np.allclose(speed[2:], 2 * speed[:2])
    # A lift coefficient of 0.5 carries the weight.
    lift = 0.5 * model.aero.density * speed[0] ** 2 * 0.5 * model.wing_area
    assert lift == pytest.approx(ibis.body.mass * ibis.gravity)


def test_the_wing_area_is_that_of_the_outline(ibis):
    """Elements cover the area between the edges, whatever their number."""
    fine = RigidModel(ibis.with_values({"wing.discretisation": 40})).wing_area
    assert RigidModel(ibis).wing_area == pytest.approx(fine, rel=0.03)


def test_the_rigid_bird_starts_from_its_guess_then_all_over(ibis):
    model, times = RigidModel(ibis), times_of(ibis)
    paths = np.array(list(model.starting_paths(times)))
    assert paths.shape == (76, 17, 4)
    assert np.array_equal(paths[0], model.guess_along(times))
    assert np.ptp(paths[:, 0, 0]) > 15.0


def test_compliant_joints_start_on_their_drivers_and_swinging(sprung):
    model, times = MultibodyModel(sprung), times_of(sprung)
    paths = list(model.starting_paths(times))
    joint = [joint.name for joint in sprung.joints].index("shoulder.flap")
    driver = driver_motion_along(model.wing, times)[0][:, joint]
    on_driver = [np.allclose(path[:, 4], driver) for path in paths]
    assert on_driver[0]
    assert 0 < sum(on_driver) < len(paths)
    for path, follows in zip(paths, on_driver, strict=True):
        assert path.shape == (17, 6)
        assert np.isfinite(path).all()
        # The joint swings with the driver's period, whose sense the spring does not turn round.
        assert follows or np.corrcoef(path[:, 4], driver)[0, 1] > 0.5


def test_a_tethered_bird_starts_on_its_drivers_only(sprung):
    model = MultibodyModel(sprung, motion="held", body_state=[15.0, 0.0, 0.0, 0.0])
    (path,) = model.starting_paths(times_of(sprung))
    assert path.shape == (17, 2)
    assert np.isinf(model.state_periods).all()


def test_a_flight_after_a_loop_is_the_same(ibis):
    model = RigidModel(ibis)
    start = model.initial_guess()
    after_a_loop = start + np.array([0.0, 0.0, 0.0, 2 * np.pi])
    (found,) = find_limit_cycles(model, [start, after_a_loop], deflations=0)
    assert abs(found.mean_pitch) < 1.0
