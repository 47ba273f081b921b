"""What drivers do over a beat: of a wing that flaps as one plate, in closed form."""

import re

import numpy as np
import pytest

from birdmb.studies.driven_motion import is_still, motion_warnings, tip_height
from birdmb.topology import SIDES
from birdmb.wing.outline import span_and_area

AMPLITUDE = 0.7


@pytest.fixture(scope="module")
def plate(ibis):
    """All joints at zero but the one that flaps."""
    still = {f"{joint}.{key}": 0.0 for joint in ibis.joint_names for key in ("offset", "amplitude")}
    return ibis.with_values(still | {"shoulder.flap.amplitude": AMPLITUDE})


@pytest.fixture(scope="module")
def reach(plate):
    """From the shoulder's axis to the tip of the wing, m."""
    return 0.5 * span_and_area(plate)[0] - plate.wing.root.y


def test_height_of_the_tip(plate, reach):
    assert tip_height(plate) == pytest.approx(2 * reach * np.sin(AMPLITUDE), rel=1e-4)
    wider = plate.with_values({"shoulder.flap.left.amplitude": 0.9})
    assert tip_height(wider) == pytest.approx(2 * reach * np.sin(0.9), rel=1e-4)


@pytest.mark.parametrize(("factor", "told"), [(0.99, False), (1.01, True)])
def test_tips_faster_than_a_third_of_sound(plate, reach, factor, told):
    frequency = factor * 100.0 / (2 * np.pi * AMPLITUDE * reach)
    warnings = list(motion_warnings(plate.with_values({"gait.frequency": frequency})))
    assert len(warnings) == told
    assert not told or "reach 101 m/s by flapping" in warnings[0]


def test_a_bird_whose_drivers_only_stand_is_still(plate):
    assert not is_still(plate)
    still = plate.with_values({"shoulder.flap.amplitude": 0.0, "shoulder.pitch.offset": 0.2})
    assert is_still(still)
    assert list(motion_warnings(still)) == []
    for side in SIDES:
        assert not is_still(still.with_values({f"wrist.sweep.{side}.amplitude": 0.1}))


def test_a_ripple_of_a_high_harmonic_is_rough(plate, monkeypatch):
    """One of a fiftieth at order 30 is accelerated 18 times as much as the beat itself."""
    assert list(motion_warnings(plate)) == []
    orders = {1: AMPLITUDE, 30: AMPLITUDE / 50}

    def with_ripple(_, times):
        angles, rates, accelerations = np.zeros((3, times.size, len(plate.angle_names)))
        for order, amplitude in orders.items():
            omega = order * 2 * np.pi * plate.gait.frequency
            angles[:, 1] += amplitude * np.sin(omega * times)
            accelerations[:, 1] -= omega**2 * amplitude * np.sin(omega * times)
        return angles, rates, accelerations

    monkeypatch.setattr("birdmb.studies.driven_motion.driver_motion_along", with_ripple)
    (warning,) = motion_warnings(plate)
    found = re.search(r"shoulder.flap is accelerated ([\d.]+) times", warning)
    assert 17.0 < float(found[1]) < 19.0
