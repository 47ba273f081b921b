"""The birds that chapter 8 may mean."""

import numpy as np
import pytest

import birdmb
from birdmb.reproduction import chapter8_birds as birds


def test_the_flap_may_go_first(ibis):
    swapped = birds.flap_first(ibis)
    assert swapped.joint_names[:2] == ("shoulder.flap", "shoulder.pitch")
    assert sorted(swapped.joint_names) == sorted(ibis.joint_names)
    assert birds.flap_first(swapped) == ibis


def test_readings_differ_in_what_they_are_named_after():
    readings = birds.readings()
    assert len({one.fingerprint() for one in readings.values()}) == len(readings)
    for about, moment in (("point masses", 0.0), ("0.0033 kg m2", 0.0033)):
        segments = readings[about].segments
        for name in segments.names:
            np.testing.assert_array_equal(np.diag(segments[name].inertia), [moment] * 3)


def test_a_sprung_flight_is_that_of_the_bird_with_the_spring():
    coarse = birdmb.load_bird("ibis_compliant_shoulder").with_values({"wing.discretisation": 8})
    flight = birds.sprung_flight(coarse, 15.0, 0.1)
    joint = flight.model.bird.joint("shoulder.flap")
    assert (joint.stiffness, joint.damping) == (15.0, 0.1)
    again = birds.sprung_flight(coarse, 15.0, 0.1, flight.x0)
    assert abs(again.multipliers[0]) == pytest.approx(abs(flight.multipliers[0]), abs=1e-6)
