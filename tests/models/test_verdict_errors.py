"""What the verdict on a flight counts: the integration's error and the program's own checks."""

import re
from dataclasses import replace

import numpy as np
import pytest

import birdmb
from birdmb.orbits.multipliers import verdict
from tests.models.test_rigid_cycle import sorted_like


@pytest.fixture(scope="module")
def coarse(ibis):
    return ibis.with_values({"wing.discretisation": 4})


def shot(model, guess=None, **options):
    return birdmb.find_limit_cycle(model, guess, method="shooting", **options)


def missed(cycle, finer):
    return np.abs(np.subtract(*sorted_like(cycle.multipliers, finer.multipliers))).max()


@pytest.mark.parametrize("kind", [birdmb.RigidModel, birdmb.MultibodyModel])
def test_the_bars_hold_against_many_more_steps(coarse, kind):
    exact = shot(kind(coarse, steps_per_beat=60))
    for steps in (5, 6, 8, 12):
        cycle = shot(kind(coarse, steps_per_beat=steps), exact.x0)
        distance = missed(cycle, exact)
        assert distance > 10 * cycle.multiplier_errors.max()
        assert distance <= cycle.verdict_errors.min()
        if steps > 6:
            assert cycle.verdict_errors.max() < 10 * distance
            assert cycle.stability == verdict(cycle.multipliers, cycle.verdict_errors)


@pytest.mark.long
def test_the_bars_hold_where_a_spring_has_two_sides(coarse):
    """Its kink leaves an error that twice the steps hardly lessen."""
    bird = coarse.with_joint("elbow.sweep", stiffness=10, damping=0.05, stiffness_below=20)
    model = birdmb.MultibodyModel(bird, steps_per_beat=40, integrator="explicit")
    assert model.has_kinks
    assert not birdmb.MultibodyModel(bird.with_joint("elbow.sweep", stiffness_below=10)).has_kinks
    cycle = shot(model)
    fine = shot(model.with_steps(160), cycle.x0, jacobian_guess=cycle.segment_jacobians)
    distance = missed(cycle, fine)
    assert distance > 1e-6
    assert distance <= cycle.verdict_errors.min()


def test_without_an_orbit_nearby_nothing_is_decided(coarse, monkeypatch):
    cycle = shot(birdmb.RigidModel(coarse, steps_per_beat=30))
    assert cycle.stability == "unstable"
    other = coarse.with_values({"body.mass": 1.6})
    lost = replace(cycle)
    monkeypatch.setattr(
        birdmb.RigidModel, "with_steps", lambda *_: birdmb.RigidModel(other, steps_per_beat=12)
    )
    monkeypatch.setattr("birdmb.models.stepped_cycle._NEWTON_STEPS", 1)
    assert np.isinf(lost.multiplier_integration_errors).all()
    assert lost.stability == "undecided"


def test_checks_that_fail_come_with_the_flight(coarse):
    cycle = shot(birdmb.RigidModel(coarse, steps_per_beat=4))
    assert any("energy imbalance" in check for check in cycle.failed_checks)
    assert cycle.stability == "undecided"
    dataset = cycle.to_xarray()
    assert "energy imbalance" in dataset.attrs["failed_checks"]
    assert dataset.attrs["stability"] == "undecided"
    well = shot(birdmb.RigidModel(coarse, steps_per_beat=30))
    assert well.failed_checks == ()


@pytest.mark.parametrize(
    ("state", "why"),
    [
        ((12.0, -1.0, 0.0, 0.1), None),
        ((12.0, -1.0, 0.0, 0.1 + 2 * np.pi), None),
        ((-5.0, 1.0, 0.0, 0.1), "moves backwards"),
        ((3.0, 6.0, 0.0, np.radians(104)), r"stands on its tail .*104 deg"),
        ((3.0, 6.0, 0.0, np.radians(-120)), "lies on its back"),
        ((2.0, -9.0, 0.0, np.radians(60)), "it moves backwards"),
        ((-1.0, 9.0, 0.0, np.radians(60)), "the body moves backwards"),
    ],
)
def test_what_is_no_flight(rigid_cycle, state, why):
    cycle = replace(rigid_cycle)
    vars(cycle)["_states_of_beat"] = np.linspace(0.0, 0.25, 5), np.tile(state, (5, 1))
    if why is None:
        assert cycle.why_no_flight is None
    else:
        assert re.search(why, cycle.why_no_flight)


def test_the_verdict_on_a_tethered_bird_counts_its_steps_too(ibis_compliant):
    bird = ibis_compliant.with_values({"wing.discretisation": 4})
    model = birdmb.MultibodyModel(
        bird,
        motion="held",
        body_state=[18.0, -2.0, 0.0, -0.1],
        steps_per_beat=60,
        integrator="explicit",
    )
    cycle = shot(model)
    assert (cycle.verdict_errors > cycle.multiplier_errors).all()


def test_the_rigid_model_keeps_to_its_limit_of_steps(coarse, monkeypatch):
    """Of 1000; what is left of the error is told by the cycle."""
    monkeypatch.setattr(birdmb.RigidModel, "_error_of", lambda *_: 1.0)
    assert birdmb.RigidModel(coarse).steps_per_beat == 960
