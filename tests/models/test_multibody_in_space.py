"""The multibody bird in space, its wings free of each other."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import birdmb
from birdmb.models.motion import SPACE_STATES
from tests.models.newton_euler import inverse_dynamics, mass_matrix, momentum

SPRING = {"stiffness": 20.0, "damping": 0.2}
ASIDE = np.array([17.0, 0.8, -1.5, 0.4, 0.3, -0.5, 0.2, 0.1])
LATERAL = [1, 3, 5, 6]


def mirror(model):
    """Matrix (n, n) that takes a state to its mirror image: sides change, v, p, r, phi turn."""
    names = list(model.state_names)
    matrix = np.zeros((len(names), len(names)))
    for i, name in enumerate(names):
        image = name.replace(".right", ".LEFT").replace(".left", ".right").replace(".LEFT", ".left")
        matrix[names.index(image), i] = -1.0 if name in ("v", "p", "r", "phi") else 1.0
    return matrix


def aside(model, t, seed=0):
    """A state beside any symmetric flight, both wings in motions of their own."""
    rng = np.random.default_rng(seed)
    x = model.driven_state(t)
    x[:8] = ASIDE
    return x + 0.1 * rng.normal(size=x.size) * np.where(np.arange(x.size) < 8, 0, model.state_scale)


def birds(ibis):
    coarse = ibis.with_values({"wing.discretisation.elements": 8})
    yield coarse
    yield coarse.with_joint("shoulder.flap", **SPRING)
    lopsided = {
        "segments.forearm.centre_of_mass": [-0.01, 0.06, 0.004],
        "segments.forearm.inertia": [[3e-5, 2e-6, 1e-6], [2e-6, 5e-6, -1e-6], [1e-6, -1e-6, 3e-5]],
        "wing.root.z": 0.02,
        "body.inertia_xz": 0.01,
    }
    hinge = {"stiffness": 2.0, "damping": 3e-3, "mass": 1.5e-3, "rest": 0.05}
    yield coarse.with_joint("forearm.roll", stiffness=2, damping=0.01).with_values(
        {**lopsided, "feathers.5.hinge": hinge}
    )


def coordinates(model, t, x):
    """Coordinates and velocities (n,) of the tree at no yaw, written out by means of scipy."""
    u, v, w, p, q, r, phi, theta = x[:8]
    R = Rotation.from_euler("YX", [theta, phi]).as_matrix()
    turning = R @ [p, q, r]
    # Angular velocity is yaw' about z, pitch' about the heading's y, roll' about the body's x.
    rates = np.linalg.solve(np.column_stack([[0, 0, 1], [0, 1, 0], R[:, 0]]), turning)
    angles, joint_rates = (each[0].ravel() for each in model.motion_of_both(np.array([t]), x[None]))
    return (
        np.concatenate([[0, 0, 0, 0, theta, phi], angles]),
        np.concatenate([R @ [u, v, w], rates, joint_rates]),
    )


@pytest.mark.parametrize("case", range(3))
def test_accelerations_are_those_of_newton_and_euler(ibis, case):
    bird = list(birds(ibis))[case]
    model = birdmb.MultibodyModel(bird, motion="free")
    for seed, t in enumerate((0.0, 0.08, 0.19)):
        x = aside(model, t, seed)
        q, v = coordinates(model, t, x)
        for found, written in zip(model.coordinates(t, x), (q, v), strict=True):
            np.testing.assert_allclose(found, written, atol=1e-12)
        a, actuators = model.accelerations(t, x)
        free = ~model.prescribed
        loads = model.loads_along(np.array([t]), x[None])
        R = Rotation.from_euler("YX", [x[7], x[6]]).as_matrix()
        axes = np.column_stack([[0, 0, 1], [0, 1, 0], R[:, 0]])
        applied = np.concatenate(
            [
                R @ loads.stack.force[0],
                axes.T @ R @ loads.stack.moment[0],
                loads.joint_torques[0].ravel(),
            ]
        )
        driver, driver_rate, _ = (each[0].ravel() for each in model.drivers_of_both(np.array([t])))
        stiffness, damping = np.zeros(driver.size), np.zeros(driver.size)
        names = [*bird.angle_names, *bird.angle_names]
        for j, name in enumerate(names):
            of = next((f.hinge for f in bird.hinged_feathers if f.hinge_name == name), None)
            of = of or (bird.joint(name) if name in bird.joint_names else None)
            stiffness[j], damping[j] = of.stiffness or 0.0, of.damping or 0.0
        applied[6:] -= stiffness * (q[6:] - driver) + damping * (v[6:] - driver_rate)
        M = mass_matrix(bird, q)
        bias = inverse_dynamics(bird, q, v, np.zeros(q.size)) - applied
        expected = np.linalg.solve(
            M[np.ix_(free, free)], -bias[free] - M[np.ix_(free, ~free)] @ a[~free]
        )
        np.testing.assert_allclose(a[free], expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())
        torques = (M @ a + bias)[~free]
        np.testing.assert_allclose(actuators[~free], torques, atol=1e-9 * np.abs(torques).max())
        # The compiled rates say the same: velocities along turning axes change besides.
        rates = model.rhs(t, x)
        in_space = R.T @ a[:3] - np.cross(x[3:6], x[:3])
        np.testing.assert_allclose(rates[:3], in_space, atol=1e-9 * np.abs(a[:3]).max())
        joints = np.flatnonzero(free[6:]) + 6
        np.testing.assert_allclose(
            rates[9::2], a[joints], atol=1e-9 * np.abs(a[joints]).max(initial=1)
        )


@pytest.fixture(scope="module")
def bird(ibis_tail):
    return ibis_tail.with_values({"wing.discretisation": 8}).with_joint("shoulder.flap", **SPRING)


@pytest.fixture(scope="module")
def model(bird):
    return birdmb.MultibodyModel(bird, motion="free")


def test_states_of_both_wings_have_names(model):
    assert model.state_names[:8] == SPACE_STATES
    assert model.state_names[8:] == (
        "shoulder.flap.right",
        "shoulder.flap.right.rate",
        "shoulder.flap.left",
        "shoulder.flap.left.rate",
    )


def test_mirrored_states_have_mirrored_rates_and_flows(model):
    image = mirror(model)
    np.testing.assert_array_equal(
        np.diag(model.mirror.signs) @ np.eye(len(image))[model.mirror.order], image
    )
    x = aside(model, 0.03)
    np.testing.assert_allclose(
        model.rhs(0.03, image @ x), image @ model.rhs(0.03, x), rtol=1e-11, atol=1e-10
    )
    flown, mirrored = model.flow(x, 0.0, 0.1), model.flow(image @ x, 0.0, 0.1)
    np.testing.assert_allclose(mirrored, image @ flown, atol=1e-9)


def test_flow_follows_the_rates(model):
    x = aside(model, 0.0)
    finer = model.with_steps(4 * model.steps_per_beat)
    times = np.array([0.05 - 1e-4, 0.05, 0.05 + 1e-4])
    before, at, after = (finer.flow(x, 0.0, t) for t in times)
    np.testing.assert_allclose((after - before) / 2e-4, finer.rhs(0.05, at), rtol=1e-4, atol=1e-3)


def test_momentum_is_conserved_without_loads(bird):
    floating = bird.with_values({"air.density": 0.0, "gravity": 0.0})
    model = birdmb.MultibodyModel(floating, motion="free", steps_per_beat=240)
    x0 = aside(model, 0.0)
    flight = model.trajectory(x0, 0.0, 0.2)
    R, values = np.eye(3), []
    # The heading is no state: it is followed by the angular velocity.
    heading = np.concatenate([[0.0], np.cumsum(np.diff(flight.times) * 0.5 * sum(
        (s[:, 4] * np.sin(s[:, 6]) + s[:, 5] * np.cos(s[:, 6])) / np.cos(s[:, 7])
        for s in (flight.states[1:], flight.states[:-1])
    ))])  # fmt: skip
    for t, x, yaw in list(zip(flight.times, flight.states, heading, strict=True))[::48]:
        q, v = coordinates(model, t, x)
        R = Rotation.from_euler("Z", yaw).as_matrix()
        linear, angular = momentum(floating, q, v)
        values.append(np.concatenate([R @ linear, R @ angular]))
    np.testing.assert_allclose(values, values[:1] + 0 * np.array(values), atol=1e-4)
    assert np.ptp(flight["phi"]) > 0.01


def test_a_symmetric_flight_has_its_planar_multipliers_and_lateral_ones_apart(model, bird):
    planar = birdmb.find_limit_cycle(birdmb.MultibodyModel(bird))
    free = birdmb.find_limit_cycle(model)
    np.testing.assert_allclose(free.x0[[0, 2, 4, 7, 8, 9]], planar.x0, atol=1e-7)
    image = mirror(model)
    matrix = free.monodromy / model.state_scale[:, None] * model.state_scale
    mixed = matrix @ image - image @ matrix
    assert np.abs(mixed).max() < 1e-9
    found = [mode.multiplier for mode in free.flight_modes if mode.plane == "longitudinal"]
    np.testing.assert_allclose(found, planar.multipliers, atol=1e-8)
    assert {mode.plane for mode in free.flight_modes} == {"longitudinal", "lateral"}
    assert free.power == pytest.approx(planar.power, rel=1e-7)
    assert free.energy_imbalance < 1e-5


def test_multibody_goes_to_rigid_with_the_wings_mass(ibis_tail):
    """At first order, lateral multipliers too."""
    light = ibis_tail.with_values({"wing.discretisation": 8})
    rigid = birdmb.find_limit_cycle(birdmb.RigidModel(light, motion="free"))
    gaps = []
    for mass in (1e-4, 1e-5):
        masses = {f"segments.{s}.mass": mass / 3 for s in ("humerus", "forearm", "hand")}
        inertias = {
            f"segments.{s}.inertia": [0.0, 0.0, 0.0] for s in ("humerus", "forearm", "hand")
        }
        heavy = birdmb.MultibodyModel(light.with_values({**masses, **inertias}), motion="free")
        found = birdmb.find_limit_cycle(heavy, rigid.x0)
        gaps.append(np.abs(np.sort_complex(found.multipliers) - np.sort_complex(rigid.multipliers)))
    assert gaps[1].max() < 1e-3
    assert np.log10(gaps[0].max() / gaps[1].max()) == pytest.approx(1.0, abs=0.1)


def test_turning_the_heading_changes_nothing(model):
    """What the heading turns are the horizontal components of velocity, force and acceleration."""
    x = aside(model, 0.03)
    turn = Rotation.from_euler("Z", 1.2).as_matrix()
    q, v = model.coordinates(0.03, x)
    turned_q, turned_v = q.copy(), v.copy()
    turned_q[3] += 1.2
    turned_v[:3] = turn @ v[:3]
    accelerations = []
    air = np.array([1.0, -2.0, 0.5])
    for at, moves in ((q, v), (turned_q, turned_v)):
        forces = model.tree.loads(0.03, at, moves, np.empty(0), air).forces
        (mass,), (bias,) = model.tree.inertia.at(at[None], moves[None])
        accelerations.append(np.linalg.solve(mass, forces - bias))
    straight, turned = accelerations
    straight[:3] = turn @ straight[:3]
    np.testing.assert_allclose(turned, straight, rtol=1e-9, atol=1e-9 * np.abs(straight).max())
