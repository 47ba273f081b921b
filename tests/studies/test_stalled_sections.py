"""Which sections of a bird are stalled when, and what that costs."""

import numpy as np
import pytest

import birdmb

pytestmark = pytest.mark.long

# Heavy and slow: attached flow would need 22 degrees.
PUSHED = {
    "body.mass": 2.0,
    "gait.frequency": 3.0,
    "air.wake": "unsteady",
    "air.wake_points": 6,
    "wing.discretisation": 12,
}
STALL = {"angle_deg": 14.0, "width_deg": 4.0}


def cycle_of(bird):
    return birdmb.find_limit_cycle(birdmb.RigidModel(bird), method="shooting")


@pytest.fixture(scope="module")
def stalling(ibis_massless):
    return cycle_of(ibis_massless.with_values({**PUSHED, "wing.profile.stall": STALL}))


def test_a_bird_beyond_15_degrees_flies_on_and_says_what_is_stalled(stalling):
    validity = birdmb.assess_validity(stalling)
    assert not any("angle of attack" in warning for warning in validity.warnings)
    assert not any("reduced frequency" in warning for warning in validity.warnings)
    assert [section.point for section in validity.stalled] == [4, 5, 6]
    names = stalling.state_names
    for section in validity.stalled:
        assert len(section.phases) == 1
        start, end = section.phases[0]
        beats = np.linspace(0.0, 1.0, 2001)
        share = stalling.trajectory(beats * stalling.period).states[
            :, names.index(f"wake.attached_share.{section.point}")
        ]
        below = beats[share < 0.5]
        assert (start, end) == pytest.approx((below[0], below[-1]), abs=2e-3)
        assert section.largest_separation == pytest.approx(1.0 - share.min(), abs=1e-3)
        assert f"{section.span_fraction:.0%} of the half-span in phases" in validity.stall


def test_attached_flow_would_warn_instead(ibis_massless):
    validity = birdmb.assess_validity(cycle_of(ibis_massless.with_values(PUSHED)))
    assert validity.largest_angle_of_attack > np.radians(20.0)
    assert "has no stall" in " ".join(validity.warnings)
    assert not validity.stalled
    assert not validity.stall


def test_energy_is_where_lift_and_drag_leave_it(stalling):
    """What drivers and gravity deliver, the wake and the separated flow take."""
    lost = stalling.dissipation
    assert stalling.energy_imbalance < 1e-6
    assert sum(lost.values()) == pytest.approx(stalling.corrected_power, rel=1e-6)
    assert lost["profile"] > 1.0


def test_a_push_beyond_the_stall_separates_all_sections_and_is_flown_on_from(stalling):
    """8 m/s upwards on a flight of 18: the shares tell which sections let go, and when."""
    model = stalling.model
    start = stalling.x0.copy()
    start[1] += 8.0
    flight = model.trajectory(start, 0.0, 2.0 * stalling.period)
    shares = flight.states[:, 4 + model.wake.shares]
    assert np.isfinite(flight.states).all()
    assert (shares.min(axis=0) < 0.5).all()
    assert (stalling.beat.states[:, 4 + model.wake.shares].min(axis=0) > 0.5).sum() == 3
