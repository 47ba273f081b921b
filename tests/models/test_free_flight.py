"""The rigid bird in space: symmetry, derivatives, and modes against classical theory."""

import numpy as np
import pytest

import birdmb
from birdmb.models.motion import FREE, heading_velocity

MIRROR = np.array([1, -1, 1, -1, 1, -1, -1, 1])
LATERAL = np.flatnonzero(MIRROR < 0)
LONGITUDINAL = np.flatnonzero(MIRROR > 0)
# Beside any symmetric flight, in all eight states.
ASIDE = np.array([17.0, 0.8, -1.5, 0.4, 0.3, -0.5, 0.2, 0.1])


@pytest.fixture(scope="module")
def tailed(ibis_tail):
    return ibis_tail.with_values({"wing.discretisation": 16, "drag.body": True})


@pytest.fixture(scope="module")
def model(tailed):
    return birdmb.RigidModel(tailed, motion="free")


def test_the_jacobian_is_that_of_the_rates(model):
    h = 1e-5
    columns = [(model.rhs(0.03, ASIDE + e) - model.rhs(0.03, ASIDE - e)) / (2 * h)
               for e in h * np.eye(8)]  # fmt: skip
    exact = model.rate_jacobians(np.array([0.03]), ASIDE[None])[0]
    np.testing.assert_allclose(exact, np.column_stack(columns), atol=1e-6)


def test_mirrored_states_have_mirrored_flows(model):
    flown = model.flow(ASIDE, 0.0, model.period)
    mirrored = model.flow(MIRROR * ASIDE, 0.0, model.period)
    np.testing.assert_allclose(mirrored, MIRROR * flown, atol=1e-12)


def test_in_symmetric_flight_it_is_the_planar_model(model, tailed):
    planar = birdmb.RigidModel(tailed)
    x = ASIDE[LONGITUDINAL]
    rates = model.rhs(0.03, FREE.in_space(np.zeros((1, 8)))[0] + np.insert(x, [1, 2, 3, 3], 0.0))
    np.testing.assert_allclose(rates[LONGITUDINAL], planar.rhs(0.03, x), rtol=1e-12)
    assert not rates[LATERAL].any()


def test_a_symmetric_flight_has_its_planar_multipliers_and_lateral_ones_apart(model, tailed):
    planar = birdmb.find_limit_cycle(birdmb.RigidModel(tailed))
    free = birdmb.find_limit_cycle(model)
    np.testing.assert_allclose(free.x0[LONGITUDINAL], planar.x0, atol=1e-8)
    matrix = free.monodromy
    assert np.abs(matrix[np.ix_(LATERAL, LONGITUDINAL)]).max() < 1e-9
    assert np.abs(matrix[np.ix_(LONGITUDINAL, LATERAL)]).max() < 1e-9
    found = [mode.multiplier for mode in free.flight_modes if mode.plane == "longitudinal"]
    np.testing.assert_allclose(found, planar.multipliers, atol=1e-8)
    assert free.power == pytest.approx(planar.power, rel=1e-9)
    assert free.dissipation == pytest.approx(planar.dissipation, rel=1e-9)
    assert free.energy_imbalance < 1e-6


def test_shooting_finds_the_same_lateral_multipliers(model):
    collocated, shot = (
        birdmb.find_limit_cycle(model, method=method) for method in ("collocation", "shooting")
    )
    errors = collocated.verdict_errors + shot.verdict_errors
    apart = np.abs(np.sort_complex(collocated.multipliers) - np.sort_complex(shot.multipliers))
    assert (apart <= errors.max()).all()
    assert errors.max() < 1e-5


def glider(bird):
    """Held still with its wings stretched out: the linear theory of aeroplanes applies."""
    still = {f"{joint.name}.amplitude": 0.0 for joint in bird.joints}
    return bird.with_values(still | {"wing.discretisation": 16})


def test_modes_of_a_glider_are_those_of_its_linearised_equations(ibis_tail):
    """Multipliers are exp(eigenvalue * T) of the constant matrix, taken here by differences."""
    model = birdmb.RigidModel(glider(ibis_tail), motion="free")
    cycle = birdmb.find_limit_cycle(model)
    h = 1e-5
    matrix = np.column_stack(
        [(model.rhs(0.0, cycle.x0 + e) - model.rhs(0.0, cycle.x0 - e)) / (2 * h)
         for e in h * np.eye(8)]
    )  # fmt: skip
    exact = np.exp(np.linalg.eigvals(matrix) * model.period)
    np.testing.assert_allclose(
        np.sort_complex(cycle.multipliers), np.sort_complex(exact), atol=1e-6
    )
    names = [(mode.plane, mode.name) for mode in cycle.flight_modes]
    assert ("lateral", "roll") in names
    assert ("lateral", "spiral") in names
    assert names.count(("lateral", "Dutch roll")) == 2
    assert names.count(("longitudinal", "phugoid")) == 2


def test_modes_of_a_glider_are_those_of_classical_linear_theory(ibis_tail):
    """Etkin & Reid (1996), section 4.9: small disturbances of a steady flight, planes apart.

    The derivatives are differences of the reported loads, which come from both circulations of one
    system; the model takes exact ones of even and odd parity.
    """
    model = birdmb.RigidModel(glider(ibis_tail), motion="free")
    cycle = birdmb.find_limit_cycle(model)
    mass, gravity, theta = model.mass, model.bird.gravity, cycle.x0[7]
    inertia = model.bird.body.inertia_tensor
    u, w = cycle.x0[[0, 2]]
    h = 1e-4

    def derivatives(component):
        ahead, back = np.tile(cycle.x0, (2, 1))
        ahead[component] += h
        back[component] -= h
        loads = model.loads_along(np.zeros(2), np.array([ahead, back])).stack
        wrenches = np.hstack([loads.force, loads.moment])
        return (wrenches[0] - wrenches[1]) / (2 * h)

    X, Y, Z, L, M, N = np.column_stack([derivatives(k) for k in range(6)])
    c, s = gravity * np.cos(theta), gravity * np.sin(theta)
    side = [1, 3, 5]  # v, p, r
    rolling = np.linalg.solve(inertia[np.ix_([0, 2], [0, 2])], np.array([L[side], N[side]]))
    lateral = np.zeros((4, 4))
    lateral[0] = [*(Y[side] / mass + [0.0, w, -u]), c]
    lateral[1:3, :3] = rolling
    lateral[3] = [0.0, 1.0, np.tan(theta), 0.0]
    plane = [0, 2, 4]  # u, w, q
    longitudinal = np.zeros((4, 4))
    longitudinal[0] = [*(X[plane] / mass + [0.0, 0.0, -w]), -c]
    longitudinal[1] = [*(Z[plane] / mass + [0.0, 0.0, u]), -s]
    longitudinal[2, :3] = M[plane] / inertia[1, 1]
    longitudinal[3, 2] = 1.0
    for name, matrix in (("lateral", lateral), ("longitudinal", longitudinal)):
        found = [mode.multiplier for mode in cycle.flight_modes if mode.plane == name]
        exact = np.exp(np.linalg.eigvals(matrix) * model.period)
        np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(exact), atol=2e-6)


def test_power_and_losses_balance_in_a_flight_that_is_not_symmetric(model):
    """Massless wings: what they do against the air is lost to it or gained by the body."""
    times, twist = np.array([0.03]), ASIDE[None, :6]
    loads = model.loads_along(times, ASIDE[None])
    wrench = np.hstack([loads.stack.force, loads.stack.moment])
    gained = (wrench * twist).sum()
    assert loads.power - gained == pytest.approx(loads.dissipation(twist).sum(), rel=1e-12)
    rates = model.rhs(0.03, ASIDE)
    u, v, w, p, q, r, phi, theta = ASIDE
    down = model.bird.gravity * np.array(
        [-np.sin(theta), np.sin(phi) * np.cos(theta), np.cos(phi) * np.cos(theta)]
    )
    turning = np.cross([p, q, r], [u, v, w])
    assert rates[:3] == pytest.approx(loads.stack.force[0] / model.mass + down - turning)


def test_velocity_seen_along_the_heading_has_its_length():
    states = np.random.default_rng(1).normal(size=(20, 8))
    seen = heading_velocity(states)
    assert np.linalg.norm(seen, axis=1) == pytest.approx(np.linalg.norm(states[:, :3], axis=1))
    # Rolled by a quarter turn to the right, what moved along z moves to the left.
    rolled = np.zeros((1, 8))
    rolled[0, [2, 6]] = 1.0, np.pi / 2
    np.testing.assert_allclose(heading_velocity(rolled), [[0.0, -1.0, 0.0]], atol=1e-15)


def test_motion_in_space_needs_all_moments_of_inertia(tailed):
    incomplete = tailed.with_values({"body.inertia_zz": None})
    birdmb.RigidModel(incomplete)
    with pytest.raises(birdmb.TopologyError, match=r"needs body\.inertia_zz, the moments"):
        birdmb.RigidModel(incomplete, motion="free")
    flat = tailed.with_values({"body.inertia_zz": 0.2})
    with pytest.raises(birdmb.TopologyError, match="triangle inequality"):
        birdmb.RigidModel(flat, motion="free")
    with pytest.raises(ValueError, match='must be "planar" or "free", not "sideways"'):
        birdmb.RigidModel(tailed, motion="sideways")


def test_a_turn_is_a_limit_cycle_like_its_mirror_image(model):
    straight = birdmb.find_limit_cycle(model)
    assert straight.stability == "unstable"  # in the spiral mode alone
    assert [m.name for m in straight.flight_modes if abs(m.multiplier) > 1] == ["spiral"]
    start = straight.x0.copy()
    start[[4, 5, 6]] += 0.17, 0.30, 0.5
    right = birdmb.find_limit_cycle(model, start)
    left = birdmb.find_limit_cycle(model, MIRROR * start)
    np.testing.assert_allclose(left.x0, MIRROR * right.x0, atol=1e-6)
    assert right.stability == left.stability == "stable"
    assert "coupled" in {mode.plane for mode in right.flight_modes}
    # The lift's horizontal part turns the path: tan(bank) = V omega/g, level and coordinated.
    coordinated = np.arctan(right.mean_velocity[0] * right.turn_rate / model.bird.gravity)
    assert right.mean_bank == pytest.approx(coordinated, rel=0.03)
    assert left.turn_rate == pytest.approx(-right.turn_rate, rel=1e-6)
    assert right.energy_imbalance < 1e-6
    # Where the straight flight goes if nobody corrects its bank.
    x = straight.x0.copy()
    x[6] = 0.01
    for beat in range(360):
        x = model.flow(x, beat * model.period, (beat + 1) * model.period)
    np.testing.assert_allclose(x, right.x0, atol=1e-2)


def test_all_flights_in_space_hold_turns_to_both_sides(model):
    found = birdmb.find_limit_cycles(model, deflations=0)
    flights = [cycle for cycle in found if cycle.why_no_flight is None]
    assert len(flights) == 3  # and none of them twice, by other angles of the same attitude
    straight, *turns = flights
    assert abs(straight.mean_bank) < 1e-8
    left, right = sorted(turns, key=lambda cycle: cycle.mean_bank)
    assert left.turn_rate < 0 < right.turn_rate
    assert turns[0].mean_speed == pytest.approx(turns[1].mean_speed, abs=1e-6)


def test_a_body_that_pitches_beyond_the_vertical_is_refused(model):
    upright = ASIDE.copy()
    upright[7] = 1.6
    for compute in (lambda: model.rhs(0.0, upright), lambda: model.flow(upright, 0.0, 0.1)):
        with pytest.raises(birdmb.StateError, match="pitches beyond 90 degrees"):
            compute()
