"""Sections that stall: against the polar they were given, and an independent integration."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import birdmb
from birdmb.aerodynamics.wake_lags import BOUND_RATES, BOUND_SHARES

from .stalling import NORMAL, SLOPE, SPEED, STALL, WIDTH, plate, polar, steady_state

pytestmark = pytest.mark.long

BY_ANGLE = {"angle_deg": STALL, "width_deg": WIDTH}
STALLING = {
    "air.wake": "unsteady",
    "air.wake_points": 4,
    "wing.discretisation": 12,
    "wing.profile.stall": {"angle_deg": 8.0, "width_deg": 4.0},
}
TIMES = np.array([0.03, 0.11, 0.2])


def attached(alpha):
    """Share of the chord in steady flow."""
    return 0.5 * (1 - np.tanh((np.abs(alpha) - np.radians(STALL)) / np.radians(WIDTH)))


def coefficients(wing, angle, e):
    """Lift, drag and moment coefficient of an element of a plate at an angle of attack."""
    pressure = 0.5 * 1.225 * SPEED**2 * wing.width[e] * wing.chord[e]
    back, _, down = wing.force[e] / pressure
    lift = -down * np.cos(angle) + back * np.sin(angle)
    drag = -back * np.cos(angle) - down * np.sin(angle)
    return lift, drag, wing.moment[e, 1] / (pressure * wing.chord[e])


@pytest.mark.parametrize("degrees", [0.0, 4.0, 8.0, 10.0, 12.0, 15.0, 20.0, 30.0, 40.0, 60.0])
def test_a_long_plate_has_the_polar_that_it_was_given(degrees):
    """What is left is that 400 chords are not infinitely many."""
    given, angle = polar(), np.radians(degrees)
    model = birdmb.RigidModel(plate(200.0, 8, polar=given))
    loads = model.loads(0.0, steady_state(model, angle))
    row = given["angle_deg"].index(degrees)
    expected = [given[key][row] for key in ("lift", "drag", "moment")]
    assert coefficients(loads.right, angle, 1) == pytest.approx(expected, abs=4e-3)


@pytest.mark.parametrize("degrees", [5.0, 10.0, 30.0, 60.0])
def test_every_section_of_a_finite_plate_is_on_its_polar(degrees):
    """By an independent downwash: that of straight vortices behind the steps of circulation."""
    angle = np.radians(degrees)
    model = birdmb.RigidModel(plate(3.0, 8, stall=BY_ANGLE))
    wing = model.loads(0.0, steady_state(model, angle)).right
    y, node, gamma = wing.position[:, 1], wing.node[:, 1], wing.circulation
    shed = np.append(gamma[:-1] - gamma[1:], gamma[-1])
    downwash = (shed / (node[1:] - y[:, None]) + shed / (node[1:] + y[:, None])).sum(axis=1)
    effective = angle - downwash / (4 * np.pi * SPEED)
    share = attached(effective)
    separated = NORMAL * np.sin(effective) * np.cos(effective)
    lift = share * SLOPE * effective + (1 - share) * separated
    np.testing.assert_allclose(2 * gamma / (wing.chord * SPEED), lift, atol=1e-4)


def test_a_pitching_section_follows_the_equations_of_the_theory():
    """Dynamic stall: loops of lift and drag, by scipy from the equations of one section."""
    mean, swing = np.radians(13.0), np.radians(8.0)
    pitch = {"name": "root.pitch", "segment": "bar", "axis": [0, 1, 0]}
    driver = {"offset": mean, "amplitude": swing, "phase": 0.0}
    bird = plate(200.0, 8, [pitch | driver], stall=BY_ANGLE)
    model = birdmb.RigidModel(bird, steps_per_beat=200)
    omega, beats = 2 * np.pi * bird.gait.frequency, 3
    start = model.guess_along(np.zeros(1))[0]
    start[:4] = SPEED, 0.0, 0.0, 0.0
    times = np.linspace(beats - 1, beats, 25) * bird.period

    def air(t):
        angle, rate = mean + swing * np.sin(omega * t), swing * omega * np.cos(omega * t)
        rising, back = SPEED * np.sin(angle) + 0.5 * rate, SPEED * np.cos(angle)
        speed = np.hypot(rising, back)
        return speed, speed * np.arctan2(rising, back)

    def effective(t, y):
        speed, driving = air(t)
        lifting = 0.5 * driving + BOUND_SHARES[0] * y[0] + BOUND_SHARES[1] * y[1]
        return speed, driving, lifting, lifting / speed

    def rates(t, y):
        speed, driving, _, alpha = effective(t, y)
        lags = [2 * b * speed * (driving - lag) for b, lag in zip(BOUND_RATES, y[:2], strict=True)]
        return [*lags, speed / 4.0 * (attached(alpha) - y[2])]

    points = model.wake.lags.kept.size
    own = [start[4 + 1], start[4 + points + 1], start[4 + 4 * points + 1]]
    alone = solve_ivp(rates, (0, times[-1]), own, t_eval=times, rtol=1e-9, atol=1e-9)
    flight = model.trajectory(start, 0.0, beats * bird.period, times)
    share = flight.states[:, 4 + 4 * points + 1]
    np.testing.assert_allclose(share, alone.y[2], atol=4e-3)
    assert np.ptp(share) > 0.5

    loads = model.loads_along(times, flight.states).stack.right
    lost, kept = [], []
    for t, y in zip(times, alone.y.T, strict=True):
        speed, _, lifting, alpha = effective(t, y)
        separated = speed * NORMAL * np.sin(alpha) * np.cos(alpha)
        kept.append(0.5 * (SLOPE * lifting - (1 - y[2]) * (SLOPE * lifting - separated)))
        force = 0.5 * 1.225 * speed**2 * (1 - y[2]) * NORMAL * np.sin(alpha) ** 2
        lost.append(force * loads.width[0, 1])
    np.testing.assert_allclose(loads.circulation[:, 1], kept, atol=4e-3 * np.max(kept))
    drag = np.linalg.norm(loads.profile_drag[:, 1], axis=1)
    np.testing.assert_allclose(drag, lost, atol=1e-2 * np.max(lost))
    # A loop: more lift on the way up than at the same incidence on the way down.
    up, down = loads.circulation[0, 1], loads.circulation[12, 1]
    assert up > 1.2 * down


@pytest.fixture(scope="module")
def ibis_that_stalls(ibis_massless):
    return ibis_massless.with_values(STALLING)


def beside(model):
    guess = model.guess_along(TIMES)
    return guess + 0.1 * np.random.default_rng(1).normal(size=guess.shape) * model.state_scale


@pytest.mark.parametrize("motion", ["planar", "free"])
def test_the_jacobian_is_that_of_the_rates(ibis_that_stalls, motion):
    model = birdmb.RigidModel(ibis_that_stalls, motion=motion)
    states, h = beside(model)[:1], 1e-6 * model.state_scale
    exact = model.rate_jacobians(TIMES[:1], states)[0]
    columns = [
        (model.rates(TIMES[:1], states + e) - model.rates(TIMES[:1], states - e))[0] / (2 * e.sum())
        for e in np.diag(h)
    ]
    size = np.abs(exact).max(axis=1, keepdims=True)
    np.testing.assert_allclose(np.column_stack(columns) / size, exact / size, atol=1e-6)


@pytest.mark.parametrize("motion", ["planar", "free"])
def test_massless_wings_of_a_tree_are_those_of_the_rigid_bird(ibis_that_stalls, motion):
    """The difference is the wings' mass, to first order."""
    differences = []
    for share in (1.0, 0.1):
        masses = {
            f"segments.{name}.mass": share * segment.mass
            for name, segment in ibis_that_stalls.segments.items()
        }
        bird = ibis_that_stalls.with_values(masses)
        rigid = birdmb.RigidModel(bird, motion=motion)
        tree = birdmb.MultibodyModel(bird, motion=motion)
        states = beside(rigid)
        expected, found = rigid.rates(TIMES, states), tree.rates(TIMES, states)
        differences.append(np.abs((found - expected) / rigid.state_scale).max())
    assert differences[1] == pytest.approx(0.1 * differences[0], rel=0.2)
    loads = [model.loads_along(TIMES, states).stack for model in (rigid, tree)]
    for side in ("right", "left"):
        one, other = (getattr(each, side) for each in loads)
        np.testing.assert_allclose(one.profile_drag, other.profile_drag, atol=1e-5)
        np.testing.assert_allclose(one.circulation, other.circulation, atol=1e-6)


def test_sections_of_two_polars_stall_one_after_the_other():
    """Between two sections curves go linearly from one to the other."""
    early, late = ({"stall": {"angle_deg": angle, "width_deg": 2.0}} for angle in (8.0, 16.0))
    bird = plate(3.0, 12)
    document = bird.model_dump(exclude_unset=True)
    document["sections"][0]["profile"], document["sections"][1]["profile"] = early, late
    curves = birdmb.RigidModel(type(bird).model_validate(document)).wake.lags.separation
    at_12_degrees = curves.values[curves.of, 360 + 24, 0]
    ends = [0.5 * (1 - np.tanh((12.0 - angle) / 2.0)) for angle in (8.0, 16.0)]
    assert all(before < after for before, after in pairwise(at_12_degrees))
    assert ends[0] - 1e-12 < at_12_degrees[0] < at_12_degrees[-1] < ends[1] + 1e-12


def test_stall_needs_air_that_remembers(ibis):
    bird = ibis.with_values({"wing.profile.stall": BY_ANGLE})
    with pytest.raises(birdmb.TopologyError, match="air that remembers"):
        birdmb.RigidModel(bird)
