"""Feathers on hinges: closed forms, limits, energy, and the integration that they need."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

import birdmb
from birdmb.wing.shape import wing_shape
from tests.conftest import TOPOLOGIES

STILL = [0.0, 0.0, 0.0, 0.0]
GLIDE = [18.0, 1.0, 0.0, 0.0]
HINGE = {"stiffness": 2.0, "damping": 2e-3, "mass": 1.5e-3}


def held_still(bird, **values):
    """The bird with all joints at zero, where feather 5 points straight aft."""
    drivers = {f"{j}.{key}": 0.0 for j in bird.joint_names for key in ("offset", "amplitude")}
    return bird.with_values({**drivers, "wing.discretisation": 8, **values})


@pytest.fixture(scope="module")
def shipped():
    bird = birdmb.load_bird(TOPOLOGIES / "ibis_hinged_feathers.toml")
    return bird.with_values({"wing.discretisation": 6})


@pytest.fixture(scope="module")
def cycle(shipped):
    return birdmb.find_limit_cycle(birdmb.MultibodyModel(shipped))


@pytest.mark.parametrize(
    ("integrator", "steps", "error"), [("explicit", 960, 1e-9), ("implicit", 480, 1e-7)]
)
def test_free_decay_against_the_closed_form(ibis, integrator, steps, error):
    """No air, no gravity, bones held: (m l^2/3) phi'' + C phi' + k (phi - phi_0) = 0."""
    hinge = {"stiffness": 0.5, "damping": 1e-3, "mass": 2e-3, "rest": 0.1}
    other = {"stiffness": 0.3, "damping": 0.0, "mass": 1e-3}
    bird = held_still(
        ibis,
        **{
            "air.density": 0.0,
            "gravity": 0.0,
            "feathers.5.hinge": hinge,
            "feathers.3.hinge": other,
        },
    )
    model = birdmb.MultibodyModel(
        bird, motion="held", body_state=STILL, integrator=integrator, steps_per_beat=steps
    )
    assert model.state_names == (
        "feathers.5.hinge", "feathers.5.hinge.rate", "feathers.3.hinge", "feathers.3.hinge.rate",
    )  # fmt: skip
    # Feather 3 lies at 45 degrees to the axis of its hinge: half the inertia.
    end = []
    for table, inertia, start in (
        (hinge, 2e-3 * 0.15**2 / 3, [0.2, 3.0]),
        (other, 1e-3 * 0.20**2 / 3 / 2, [-0.1, 0.0]),
    ):
        k, damping, rest = table["stiffness"], table["damping"], table.get("rest", 0.0)
        exact = expm(0.05 * np.array([[0.0, 1.0], [-k / inertia, -damping / inertia]]))
        end += [*(exact @ (np.array(start) - [rest, 0.0]) + [rest, 0.0])]
    found = model.flow([0.2, 3.0, -0.1, 0.0], 0.0, 0.05)
    np.testing.assert_allclose(found / model.state_scale, end / model.state_scale, atol=error)


def test_weight_deflects_a_hinge_as_far_as_its_spring_lets_it(ibis):
    """k phi = m g (l/2) cos(phi), tip down positive: no other load than gravity."""
    hinge = {"stiffness": 0.05, "damping": 2e-3, "mass": 5e-3}
    bird = held_still(ibis, **{"air.density": 0.0, "feathers.5.hinge": hinge})
    model = birdmb.MultibodyModel(bird, motion="held", body_state=STILL)
    expected = brentq(lambda phi: 0.05 * phi - 5e-3 * 9.81 * 0.075 * np.cos(phi), 0.0, 1.0)
    assert expected > 0.07
    np.testing.assert_allclose(model.rhs(0.0, [expected, 0.0]), 0.0, atol=1e-9)
    settled = model.flow([0.0, 0.0], 0.0, 1.0)
    np.testing.assert_allclose(settled, [expected, 0.0], atol=1e-7)


def test_air_deflects_a_hinge_as_far_as_its_spring_lets_it(ibis):
    """In a glide, k phi = the work of the air's forces along a turn of the hinge."""
    bird = held_still(ibis, **{"feathers.5.hinge": HINGE, "gravity": 0.0})
    model = birdmb.MultibodyModel(bird, motion="held", body_state=GLIDE)
    phi, rate = model.flow([0.0, 0.0], 0.0, 0.5)
    assert abs(rate) < 1e-9
    assert np.radians(-10) < phi < np.radians(-1)
    force = model.loads(0.0, [phi, 0.0]).right.force
    angles, h = np.append(np.zeros(6), phi), 1e-5
    work = [
        np.sum(force * wing_shape(model.wing, a, 0 * a, *model.discretisation).line[0::2])
        for a in (angles + h * (np.arange(7) == 6), angles - h * (np.arange(7) == 6))
    ]
    assert 2.0 * phi == pytest.approx((work[0] - work[1]) / (2 * h), rel=1e-6)


def test_stiffness_to_infinity_goes_to_the_firm_feather(ibis):
    """At first order in 1/k: the flight of a beat, the feathers next to massless."""
    firm = ibis.with_values({"wing.discretisation": 6})
    x = birdmb.MultibodyModel(firm).initial_guess()
    expected = birdmb.MultibodyModel(firm).flow(x, 0.0, 0.25)
    gaps, angles = [], []
    for k in (1e2, 1e3, 1e4):
        hinge = {"stiffness": k, "damping": 1e-3 * k, "mass": 1e-9}
        hinged = firm.with_values({"feathers.5.hinge": hinge, "feathers.3.hinge": hinge})
        model = birdmb.MultibodyModel(hinged)
        assert model.integration.method == "implicit"
        end = model.flow([*x, 0.0, 0.0, 0.0, 0.0], 0.0, 0.25)
        gaps.append(np.abs((end[:4] - expected) / model.state_scale[:4]).max())
        angles.append(np.abs(end[[4, 6]]))
    assert gaps[-1] < 1e-4
    np.testing.assert_allclose(-np.diff(np.log10(gaps)), 1.0, atol=0.03)
    np.testing.assert_allclose(-np.diff(np.log10(angles), axis=0), 1.0, atol=0.03)


def test_the_rigid_model_holds_hinges_at_rest(ibis):
    bird = ibis.with_values({"wing.discretisation": 8})
    x = [18.0, -2.0, 0.0, -0.1]
    ends = [
        birdmb.RigidModel(bird.with_values(values), steps_per_beat=60).flow(x, 0.0, 0.25)
        for values in (
            {},
            {"feathers.5.hinge": HINGE},
            {"feathers.5.hinge": {**HINGE, "rest": 0.05}},
        )
    ]
    np.testing.assert_allclose(ends[1], ends[0], atol=1e-12)
    assert np.abs(ends[2] - ends[0]).max() > 0.01


def test_cycle_is_closed_and_its_energy_balances(cycle):
    assert cycle.residual < 1e-8
    assert cycle.integration_error < 2e-6
    assert cycle.energy_imbalance < 1e-6
    assert (cycle.multiplier_errors < 1e-6).all()
    assert len(cycle.multipliers) == 8


@pytest.mark.long
def test_what_hinges_take_is_what_their_dampers_dissipate(cycle, shipped):
    """Over a beat a spring gives back what it took; what is left of the power is the damper's."""
    beat = cycle.beat
    for h, feather in enumerate(shipped.hinged_feathers):
        hinge, j = feather.hinge, len(shipped.joints) + h
        angle, rate = beat.states[:, 4 + 2 * h], beat.joint_rates[:, 0, j]
        np.testing.assert_array_equal(rate, beat.states[:, 5 + 2 * h])
        spring = -2 * hinge.stiffness * (angle - hinge.rest) * rate
        damper = -2 * hinge.damping * rate**2
        np.testing.assert_allclose(beat.joint_power[:, j], spring + damper, rtol=1e-12)
        dissipated = -np.mean(damper[:-1])
        assert dissipated > 1e-3
        assert abs(np.mean(spring[:-1])) < 1e-4 * np.abs(spring).max()
        assert cycle.joint_powers[feather.hinge_name] == pytest.approx(-dissipated, rel=0.01)
        assert cycle.driver_powers[feather.hinge_name] == 0.0
        assert cycle.driver_work[feather.hinge_name] == (0.0, 0.0)
    assert list(cycle.to_xarray()["joint"].values) == list(shipped.angle_names)


def test_power_against_the_air_is_what_joints_hinges_and_fanning_feathers_deliver(cycle):
    """What the hinges' motion gives the air is in the torques about them, by virtual work."""
    torques = np.array([loads.right.joint_torques for loads in cycle.beat.loads])
    powers = -2 * (torques * cycle.beat.joint_rates[:, 0])[:-1]
    by_hinges, by_joints = np.mean(powers[:, 6:].sum(axis=1)), np.mean(powers[:, :6].sum(axis=1))
    assert abs(by_hinges) > 1e-3
    assert by_joints + by_hinges + cycle.feather_power == pytest.approx(cycle.power, abs=1e-12)


def test_twist_of_the_shipped_bird_stays_some_degrees(cycle):
    hinges = np.degrees(cycle.beat.states[:, [4, 6]])
    assert (np.abs(hinges) < 8).all()
    assert (np.ptp(hinges, axis=0) > 1).all()


def test_a_first_guess_settles_the_hinges(cycle):
    model = cycle.model
    rest = model.driven_state()[[4, 6]]
    guess = model.initial_guess()[[4, 6]]
    assert (np.abs(guess - cycle.x0[[4, 6]]) < 0.5 * np.abs(rest - cycle.x0[[4, 6]])).all()


@pytest.mark.long
def test_steps_doubled_and_the_implicit_method_change_nothing(shipped, cycle):
    x = cycle.x0
    coarse = cycle.model
    assert coarse.integration.method == "explicit"
    n = coarse.steps_per_beat
    ends = [
        birdmb.MultibodyModel(shipped, integrator="explicit", steps_per_beat=m).flow(x, 0.0, 0.25)
        for m in (n, 2 * n, 4 * n)
    ]
    errors = [np.abs((end - ends[-1]) / coarse.state_scale).max() for end in ends[:-1]]
    assert errors[0] < 2e-6
    assert errors[1] < errors[0] / 30
    implicit = birdmb.MultibodyModel(shipped, integrator="implicit", steps_per_beat=240)
    np.testing.assert_allclose(
        implicit.flow(x, 0.0, 0.25) / coarse.state_scale, ends[-1] / coarse.state_scale, atol=1e-6
    )


@pytest.mark.long
def test_tiny_feathers_are_integrated_implicitly_without_being_asked(shipped, cycle):
    tiny = shipped.with_values({f"feathers.{n}.hinge.mass": 5e-5 for n in ("5", "3")})
    stiff = birdmb.MultibodyModel(tiny)
    assert stiff.integration == ("implicit", 60)
    x = cycle.x0
    explicit = birdmb.MultibodyModel(tiny, integrator="explicit", steps_per_beat=4800)
    # Past the first moments, in which a hinge leaps to where air and spring want it.
    x = explicit.flow(x, 0.0, 0.05)
    scale = stiff.state_scale
    np.testing.assert_allclose(
        stiff.flow(x, 0.05, 0.15) / scale, explicit.flow(x, 0.05, 0.15) / scale, atol=2e-6
    )
    too_few = birdmb.MultibodyModel(tiny, integrator="explicit", steps_per_beat=60)
    with pytest.raises(birdmb.StateError):
        too_few.flow(x, 0.05, 0.25)


def test_a_wing_that_runs_away_into_a_division_by_zero_is_told(shipped, cycle, monkeypatch):
    """A hinge that spins may turn its feather onto the leading edge: no wing is left there."""
    model = birdmb.MultibodyModel(shipped, integrator="explicit", steps_per_beat=120)

    def no_wing(*_):
        raise ZeroDivisionError

    monkeypatch.setattr("birdmb.models.instants.wing_shapes", no_wing)
    with pytest.raises(birdmb.StateError, match="diverged"):
        model.flow(cycle.x0, 0.0, 0.1)


def test_a_feather_along_the_axis_of_its_hinge_is_told(ibis):
    bird = ibis.with_values(
        {
            "feathers.3.shares": {"wrist.sweep": 0.5},
            "feathers.3.rest_angle_deg": 105.0,
            "feathers.3.hinge": HINGE,
        }
    )
    # Half of the wrist's offset of -30 degrees turns it back to 90.
    with pytest.raises(birdmb.TopologyError, match=r"feathers\.3\.hinge.*points along its bone"):
        birdmb.MultibodyModel(bird).flow(np.zeros(6), 0.0, 0.01)
