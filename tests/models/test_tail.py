"""The bird with tail and drags: both models, energy, work, and the published case."""

import numpy as np
import pytest

import birdmb
from birdmb.models.energy import work_by_sign

BONES = ("humerus", "forearm", "hand")


def test_the_case_of_chapter_6(tail_cycle):
    """Program: |Lambda| 0.963; level near 14 m/s. 16.1 W with the tail's errors mended."""
    assert tail_cycle.mean_climb_rate == pytest.approx(0.0, abs=1e-3)
    assert tail_cycle.mean_speed == pytest.approx(14.0, abs=0.1)
    assert np.abs(tail_cycle.multipliers).max() == pytest.approx(0.963, abs=0.01)
    assert tail_cycle.power == pytest.approx(16.1, rel=0.08)
    assert tail_cycle.stability == "stable"


def test_energy_balance(ibis_tail, tail_cycle):
    assert tail_cycle.energy_imbalance < 1e-6
    multibody = birdmb.find_limit_cycle(birdmb.MultibodyModel(ibis_tail))
    assert multibody.energy_imbalance < 1e-6


def test_what_the_air_takes_is_what_the_wings_and_gravity_give(tail_cycle, ibis_tail):
    """In a flight that climbs too."""
    for cycle in (
        tail_cycle,
        birdmb.find_limit_cycle(
            birdmb.RigidModel(ibis_tail.with_values({"forearm.roll.offset_deg": 0}))
        ),
    ):
        lost = cycle.dissipation
        assert sum(lost.values()) == pytest.approx(cycle.corrected_power, rel=1e-6)
        assert all(power > 0 for power in lost.values())


def test_components_are_switched_off_one_by_one(ibis_tail):
    bare = ibis_tail.with_values(
        {"tail.opening_deg": 0, "drag.profile_coefficient": 0, "drag.body": False}
    )
    without = birdmb.RigidModel(bare.model_copy(update={"tail": None}))
    x = without.initial_guess()
    furled = birdmb.RigidModel(bare).loads(0.03, x)
    assert furled.tail is None
    np.testing.assert_array_equal(furled.force, without.loads(0.03, x).force)
    np.testing.assert_array_equal(furled.moment, without.loads(0.03, x).moment)
    np.testing.assert_array_equal(furled.body_force, 0.0)
    np.testing.assert_array_equal(furled.right.profile_drag, 0.0)


def test_multibody_goes_to_rigid_with_the_wings_mass(ibis_tail, tail_cycle):
    """At first order; states in units of their scale."""
    apart = []
    for mass in (1e-5, 1e-6):
        light = {f"segments.{bone}.mass": mass for bone in BONES}
        points = {f"segments.{bone}.inertia": [0.0] * 3 for bone in BONES}
        model = birdmb.MultibodyModel(ibis_tail.with_values(light | points))
        cycle = birdmb.find_limit_cycle(model, tail_cycle.x0)
        states = np.abs((cycle.x0 - tail_cycle.x0) / cycle.state_scale).max()
        multipliers = np.abs(np.abs(cycle.multipliers) - np.abs(tail_cycle.multipliers)).max()
        apart.append(max(states, multipliers))
    assert apart[1] < 1e-4
    assert apart[0] / apart[1] == pytest.approx(10, rel=0.05)


def test_loads_agree_with_the_right_hand_side(ibis_tail, tail_cycle):
    """The loads that users see against those that both models integrate."""
    x, t = tail_cycle.x0 + np.array([0.5, 0.3, 0.2, 0.05]), 0.03
    u, w, q, theta = x
    rigid = birdmb.RigidModel(ibis_tail)
    loads, rates = rigid.loads(t, x), rigid.rhs(t, x)
    m, g = ibis_tail.body.mass, ibis_tail.gravity
    assert loads.force[0] == pytest.approx(m * (rates[0] + q * w + g * np.sin(theta)))
    assert loads.force[2] == pytest.approx(m * (rates[1] - q * u - g * np.cos(theta)))
    assert loads.moment[1] == pytest.approx(ibis_tail.body.inertia_yy * rates[2])
    light = {f"segments.{bone}.mass": 1e-9 for bone in BONES} | {
        f"segments.{bone}.inertia": [0.0] * 3 for bone in BONES
    }
    multibody = birdmb.MultibodyModel(ibis_tail.with_values(light))
    np.testing.assert_allclose(multibody.rhs(t, x), rates, rtol=1e-5)


def test_tail_angle_counts_pitch_rate_and_downwash(ibis_tail, tail_cycle):
    model, x = birdmb.RigidModel(ibis_tail), tail_cycle.x0
    tail = model.loads(0.03, x).tail
    u, w, q, _ = x
    # The plate's own frame: 2 deg leading edge up; its centre 0.2 m behind the apex along it.
    tilt = np.radians(2)
    tx, tz = -0.3 - 0.2 * np.cos(tilt), 0.2 * np.sin(tilt)
    np.testing.assert_allclose(tail.position, [tx, 0, tz], atol=1e-15)
    up, ahead = w - q * tx - tail.downwash, u + q * tz
    assert tail.angle_of_attack == pytest.approx(np.arctan2(up, ahead) + tilt, abs=1e-12)
    down = [loads.tail.downwash for loads in tail_cycle.beat.loads[:-1]]
    assert np.mean(down) > 0  # in the downstroke it is upwards for a while: the load is outboard


def test_validity_of_the_tail(ibis_tail, tail_cycle):
    found = birdmb.assess_validity(tail_cycle)
    assert np.degrees(found.largest_tail_angle) < 5
    assert not any("tail" in warning for warning in found.warnings)
    strict = birdmb.assess_validity(tail_cycle, largest_tail_angle=np.radians(1))
    (excess,) = [x for x in strict.excesses if x.quantity == "tail angle of attack"]
    assert excess.value == found.largest_tail_angle
    at = np.searchsorted(tail_cycle.beat.times, excess.time)
    assert abs(tail_cycle.beat.tail_angle[at]) == excess.value
    assert "deg" in str(excess)
    assert np.isnan(birdmb.assess_validity(without_tail(ibis_tail)).largest_tail_angle)


def without_tail(bird):
    return birdmb.find_limit_cycle(birdmb.RigidModel(bird.model_copy(update={"tail": None})))


def test_work_by_sign_of_a_sine():
    """1 + 2 sin: positive from -pi/6 to 7 pi/6; of fourth order."""
    exact = (4 * np.pi / 3 + 2 * np.sqrt(3)) / (2 * np.pi)
    errors = []
    for n in (20, 40):
        t = np.linspace(0.0, 0.25, n + 1)
        work = work_by_sign(t, 1 + 2 * np.sin(2 * np.pi * t / 0.25))
        assert work.net() == pytest.approx(1.0, abs=1e-5)
        errors.append(abs(work.positive - exact))
    assert errors[0] / errors[1] == pytest.approx(16, rel=0.3)
    assert work_by_sign(t, np.full(t.size, 3.0)) == pytest.approx((3.0, 0.0))


def test_recovery_of_negative_work(tail_cycle):
    work = tail_cycle.driver_work
    assert all(each.positive >= 0 >= each.negative for each in work.values())
    for name, each in work.items():
        assert each.net() == pytest.approx(tail_cycle.driver_powers[name], abs=1e-4)
    all_of_it, none = tail_cycle.muscle_power(1.0), tail_cycle.muscle_power(0.0)
    assert none == pytest.approx(sum(each.positive for each in work.values()))
    assert tail_cycle.muscle_power(0.5) == pytest.approx((all_of_it + none) / 2)
    weight = tail_cycle.model.mass * 9.81
    assert tail_cycle.transport_cost(none) == pytest.approx(none / weight / tail_cycle.mean_speed)
    with pytest.raises(ValueError, match="recover"):
        tail_cycle.muscle_power(1.5)
