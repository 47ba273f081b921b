"""Birds whose wings are not driven or sprung alike."""

import numpy as np
import pytest

import birdmb
from birdmb.topology import SIDES

STATE = np.array([17.0, 0.8, -1.5, 0.4, 0.3, -0.5, 0.2, 0.1])
MIRROR = np.array([1, -1, 1, -1, 1, -1, -1, 1])
FLAP = "shoulder.flap"


@pytest.fixture(scope="module")
def coarse(ibis_tail):
    return ibis_tail.with_values({"wing.discretisation": 12, "drag.body": True})


def lopsided(bird, right, left):
    """The bird with another flap amplitude (deg) on each side, and a phase lead of the left."""
    return bird.with_values(
        {
            f"{FLAP}.right.amplitude_deg": right,
            f"{FLAP}.left.amplitude_deg": left,
            "wrist.sweep.left.offset_deg": -25.0 if left > right else -30.0,
            "wrist.sweep.right.offset_deg": -25.0 if right > left else -30.0,
        }
    )


def test_alike_wings_are_a_limit_of_two_wings(coarse):
    """Both circulations from one system of both wings, and from those of even and odd parity."""
    alike = birdmb.RigidModel(coarse, motion="free")
    hardly = birdmb.RigidModel(lopsided(coarse, 40.0, 40.0 + 1e-9), motion="free")
    same = birdmb.RigidModel(lopsided(coarse, 40.0, 40.0), motion="free")
    assert alike.has_like_wings
    assert same.has_like_wings
    assert not hardly.has_like_wings
    rates = same.rhs(0.07, STATE)
    twisted = coarse.with_values({f"{FLAP}.amplitude_deg": 40.0, "wrist.sweep.offset_deg": -30.0})
    np.testing.assert_allclose(
        birdmb.RigidModel(twisted, motion="free").rhs(0.07, STATE), rates, rtol=1e-13
    )
    apart = lopsided(coarse, 40.0, 40.0).with_values({f"{FLAP}.left.amplitude_deg": 40.0 + 1e-9})
    found = birdmb.RigidModel(apart, motion="free").rhs(0.07, STATE)
    np.testing.assert_allclose(found, rates, atol=1e-7)


def test_the_mirror_image_of_a_bird_flies_in_the_mirror(coarse):
    one = birdmb.RigidModel(lopsided(coarse, 36.0, 42.0), motion="free")
    other = birdmb.RigidModel(lopsided(coarse, 42.0, 36.0), motion="free")
    x = STATE
    np.testing.assert_allclose(other.rhs(0.07, MIRROR * x), MIRROR * one.rhs(0.07, x), atol=1e-10)
    np.testing.assert_allclose(
        other.flow(MIRROR * x, 0.0, 0.25), MIRROR * one.flow(x, 0.0, 0.25), atol=1e-10
    )


def test_the_jacobian_is_that_of_the_rates(coarse):
    model = birdmb.RigidModel(lopsided(coarse, 36.0, 42.0), motion="free")
    h = 1e-5
    columns = [
        (model.rhs(0.03, STATE + e) - model.rhs(0.03, STATE - e)) / (2 * h) for e in h * np.eye(8)
    ]
    exact = model.rate_jacobians(np.array([0.03]), STATE[None])[0]
    np.testing.assert_allclose(exact, np.column_stack(columns), atol=1e-6)


def test_loads_of_both_wings_are_those_that_the_rates_feel(coarse):
    """Derivatives and report are assembled apart; energy closes over both wings."""
    model = birdmb.RigidModel(lopsided(coarse, 36.0, 42.0), motion="free")
    times, twist = np.array([0.03]), STATE[None, :6]
    loads = model.loads_along(times, STATE[None])
    u, v, w, p, q, r, phi, theta = STATE
    down = model.bird.gravity * np.array(
        [-np.sin(theta), np.sin(phi) * np.cos(theta), np.cos(phi) * np.cos(theta)]
    )
    rates = model.rhs(0.03, STATE)
    expected = loads.stack.force[0] / model.mass + down - np.cross([p, q, r], [u, v, w])
    assert rates[:3] == pytest.approx(expected, rel=1e-12)
    inertia = model.bird.body.inertia_tensor
    turning = loads.stack.moment[0] - np.cross([p, q, r], inertia @ [p, q, r])
    assert rates[3:6] == pytest.approx(np.linalg.solve(inertia, turning), rel=1e-12)
    gained = (np.hstack([loads.stack.force, loads.stack.moment]) * twist).sum()
    assert loads.power - gained == pytest.approx(loads.dissipation(twist).sum(), rel=1e-12)
    one = loads.at(0)
    assert np.abs(one.right.circulation - one.left.circulation).max() > 0.1


def test_a_bird_with_one_larger_stroke_turns(coarse):
    """The shorter stroke is on the inside; mirrored, the turn is to the other side."""
    straight = birdmb.find_limit_cycle(birdmb.RigidModel(coarse, motion="free"))
    own = np.degrees(coarse.joint(FLAP).amplitude)
    cycles = []
    for right, left in ((own - 0.05, own + 0.05), (own + 0.05, own - 0.05)):
        bird = coarse.with_values(
            {f"{FLAP}.right.amplitude_deg": right, f"{FLAP}.left.amplitude_deg": left}
        )
        cycles.append(birdmb.find_limit_cycle(birdmb.RigidModel(bird, motion="free"), straight))
    right, left = cycles
    np.testing.assert_allclose(left.x0, MIRROR * right.x0, atol=1e-6)
    assert right.energy_imbalance < 1e-5
    stored = right.to_xarray()
    assert stored["left_circulation"].shape == stored["circulation"].shape
    assert np.abs(stored["left_circulation"] - stored["circulation"]).max() > 1e-3
    assert "left_circulation" not in birdmb.find_limit_cycle(birdmb.RigidModel(coarse)).to_xarray()
    assert abs(right.turn_rate) > 1e-3
    assert {mode.plane for mode in right.flight_modes} > {"longitudinal"}
    limit = 0.99 * birdmb.assess_validity(right).largest_angle_of_attack
    worst, other = (birdmb.assess_validity(cycle, largest_angle=limit) for cycle in cycles)
    assert {excess.side for excess in worst.excesses} == {"right", "left"}
    sides = worst.data.attrs["side"], other.data.attrs["side"]
    assert set(sides) == {"right", "left"}
    assert not any(excess.side for excess in birdmb.assess_validity(straight).excesses)


def test_one_stiffer_shoulder(coarse):
    """Both shoulders have states of their own, and the flight is that of the rigid limit."""
    sprung = coarse.with_joint(FLAP, stiffness=20.0, damping=0.2)
    stiffer = sprung.with_values({f"{FLAP}.left.stiffness": 20.02})
    straight = birdmb.find_limit_cycle(birdmb.MultibodyModel(sprung, motion="free"))
    cycle = birdmb.find_limit_cycle(birdmb.MultibodyModel(stiffer, motion="free"), straight)
    names = list(cycle.state_names)
    swings = [names.index(f"{FLAP}.{side}") for side in SIDES]
    path = cycle.trajectory().states[:, swings]
    # The stiffer one gives less: it stays closer to its driver.
    apart = np.ptp(path[:, 0]) - np.ptp(path[:, 1])
    assert 1e-6 < abs(apart) < 1e-2
    assert cycle.energy_imbalance < 1e-5
    assert cycle.flown_closure < 1e-5
    other = sprung.with_values({f"{FLAP}.right.stiffness": 20.02})
    mirrored = birdmb.find_limit_cycle(birdmb.MultibodyModel(other, motion="free"), straight)
    image = cycle.model.mirror
    np.testing.assert_allclose(mirrored.x0, image.signs * cycle.x0[image.order], atol=1e-6)
