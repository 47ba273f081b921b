"""The same studies of the multibody bird."""

import numpy as np
import pytest

import birdmb
from birdmb.studies import (
    assess_validity,
    perturbed_flight,
    trim_flight,
    tunnel_and_free_flight,
)

AMPLITUDE = "shoulder.flap.amplitude_deg"
BONES = ("humerus", "forearm", "hand")


@pytest.mark.long
def test_bird_of_light_wings_trims_like_the_rigid_one(coarse):
    light = {f"segments.{bone}.mass": 1e-6 for bone in BONES}
    light |= {f"segments.{bone}.inertia": [1e-9, 1e-9, 1e-9] for bone in BONES}
    bird = coarse.with_values(light)
    rigid = trim_flight(bird, {AMPLITUDE: (35.0, 55.0)})
    near = rigid.values[AMPLITUDE] + np.array([-0.5, 0.7])
    multibody = trim_flight(
        bird, {AMPLITUDE: tuple(near)}, model=birdmb.MultibodyModel, tolerance=1e-5
    )
    assert multibody.values[AMPLITUDE] == pytest.approx(rigid.values[AMPLITUDE], abs=1e-3)


@pytest.mark.long
def test_bird_with_a_compliant_shoulder(ibis_compliant):
    coarse = ibis_compliant.with_values({"wing.discretisation.elements": 8})
    cycle = birdmb.find_limit_cycle(birdmb.MultibodyModel(coarse))
    # In the tunnel the joints move as in free flight.
    tunnel = tunnel_and_free_flight(cycle).sel(mount="tunnel").isel(time=9)
    x = cycle.beat.states[9].copy()
    x[:4] = tunnel.body_state
    np.testing.assert_allclose(tunnel.force, cycle.model.loads(cycle.beat.times[9], x).force)
    # The tip goes where the compliant joint is, not its driver.
    found = assess_validity(cycle)
    assert found.reduced_frequency == pytest.approx(0.09, abs=0.02)
    assert 0.1 < found.strouhal_number < 0.3
    flight = perturbed_flight(cycle, periods=1, amplitude=1e-3)
    assert list(flight.state.values) == list(cycle.state_names)
    unstable = flight.deviation[0, -1] / flight.deviation[0, 0]
    np.testing.assert_allclose(unstable[:4], cycle.multipliers[0].real, rtol=0.02)
