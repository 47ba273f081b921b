"""Flights of birds whose drivers are given by something else than amplitude and phase."""

import numpy as np
import pytest

import birdmb
from birdmb.models.natural_oscillation import joint_oscillations

FLAP = "shoulder.flap"
GIVEN_BY_SAMPLES = {"amplitude": 0.0, "phase": 0.0, "offset": 0.0}


@pytest.fixture(scope="module")
def coarse(ibis):
    return ibis.with_values({"wing.discretisation": 8})


def sampled(bird, count=16):
    """The bird with samples of each driver instead of its amplitude and phase."""
    phases = np.arange(count) / count
    for joint in bird.joints:
        angles = joint.driver.at(phases)
        bird = bird.with_joint(joint.name, samples=angles, **GIVEN_BY_SAMPLES)
    return bird


def test_a_sampled_sine_flies_as_the_sine(coarse):
    plain, same = (
        birdmb.find_limit_cycle(birdmb.RigidModel(bird)) for bird in (coarse, sampled(coarse))
    )
    assert same.nodes == plain.nodes
    np.testing.assert_allclose(same.x0, plain.x0, rtol=0, atol=1e-10)
    np.testing.assert_allclose(same.multipliers, plain.multipliers, rtol=0, atol=1e-10)


def test_collocation_and_shooting_agree_on_a_rich_motion(coarse):
    bird = coarse.with_joint(
        FLAP, harmonics=[{"order": 2, "amplitude_deg": 4.0}, {"order": 3, "cosine_deg": 1.0}]
    )
    cycle = birdmb.find_limit_cycle(birdmb.RigidModel(bird))
    model = birdmb.RigidModel(bird, steps_per_beat=240)
    shot = birdmb.find_limit_cycle(model, cycle.x0, method="shooting")
    np.testing.assert_allclose(shot.x0, cycle.x0, atol=1e-7)
    np.testing.assert_allclose(
        np.sort_complex(shot.multipliers), np.sort_complex(cycle.multipliers), atol=1e-7
    )
    plain = birdmb.find_limit_cycle(birdmb.RigidModel(coarse))
    assert abs(plain.mean_speed - cycle.mean_speed) > 0.01


def test_the_inertia_is_that_at_the_mean_of_the_samples(ibis_compliant):
    moved = ibis_compliant.with_joint("elbow.sweep", offset_deg=55.0)
    same = joint_oscillations(sampled(moved))[FLAP].inertia
    assert same == pytest.approx(joint_oscillations(moved)[FLAP].inertia, rel=1e-12)
    assert same != pytest.approx(joint_oscillations(ibis_compliant)[FLAP].inertia, rel=0.01)
