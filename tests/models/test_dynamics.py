"""The assembled bird in Exudyn against an independent formulation of its dynamics."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import birdmb
from birdmb.aerodynamics.prescribed import driver_motion
from tests.models.newton_euler import inverse_dynamics, mass_matrix, momentum

BODY = 3


def coordinates(model, t, x):
    """Coordinates and velocities (n,) from a state, written out independently of the model."""
    u, w, q, theta = x[:4]
    angles, rates, _ = driver_motion(model.wing, t)
    names = list(model.state_names)
    for j, name in enumerate(model.bird.angle_names):
        if name in names:
            angles[j] = x[names.index(name)]
            rates[j] = x[names.index(f"{name}.rate")]
    c, s = np.cos(theta), np.sin(theta)
    return (
        np.concatenate([[0, 0, theta], angles, angles]),
        np.concatenate([[u * c + w * s, -u * s + w * c, q], rates, rates]),
    )


def applied(model, t, x):
    """Generalised forces (n,) of the air, springs and dampers."""
    loads = model.loads(t, x)
    c, s = np.cos(x[3]), np.sin(x[3])
    fx, _, fz = loads.force
    angles, rates = model.joint_motion(t, np.asarray(x))
    q, v, _ = driver_motion(model.wing, t)
    torque = loads.right.joint_torques.copy()
    for j, joint in enumerate(model.bird.joints):
        if joint.mode == "compliant":
            torque[j] -= joint.stiffness * (angles[j] - q[j])
            torque[j] -= joint.damping * (rates[j] - v[j])
    for j, feather in enumerate(model.bird.hinged_feathers, len(model.bird.joints)):
        torque[j] -= feather.hinge.stiffness * (angles[j] - feather.hinge.rest)
        torque[j] -= feather.hinge.damping * rates[j]
    return np.concatenate([[fx * c + fz * s, -fx * s + fz * c, loads.moment[1]], torque, torque])


def compliant_birds(ibis):
    yield ibis
    yield ibis.with_joint("shoulder.flap", stiffness=20, damping=0.2)
    yield ibis.with_joint("shoulder.flap", stiffness=20, damping=0.2).with_joint(
        "shoulder.sweep", stiffness=15, damping=0.1
    )
    yield ibis.with_joint("elbow.sweep", stiffness=5, damping=0.02).with_joint(
        "wrist.sweep", stiffness=3, damping=0.01
    )
    lopsided = {"segments.forearm.centre_of_mass": [-0.01, 0.06, 0.004], "wing.root.z": 0.02}
    tensor = [[3e-5, 2e-6, 1e-6], [2e-6, 5e-6, -1e-6], [1e-6, -1e-6, 3e-5]]
    yield ibis.with_joint("forearm.roll", stiffness=2, damping=0.01).with_values(
        {**lopsided, "segments.forearm.inertia": tensor, "wing.discretisation": 12}
    )
    hinge = {"stiffness": 2.0, "damping": 3e-3, "mass": 1.5e-3, "rest": 0.05}
    hinged = ibis.with_values({"feathers.5.hinge": hinge, "feathers.3.hinge": hinge})
    yield hinged
    # Of no small mass, on bones with inertia of their own, beside compliant joints and twist.
    yield (
        hinged.with_joint("shoulder.flap", stiffness=20, damping=0.2)
        .with_joint("forearm.roll", stiffness=2, damping=0.01, offset=0.2)
        .with_values(
            {
                "feathers.7.hinge": {**hinge, "mass": 0.02},
                "feathers.3.hinge.mass": 0.03,
                "feathers.7.rest_angle": 0.3,
                "wing.root.z": 0.02,
            }
        )
    )


@pytest.mark.parametrize("case", range(7))
def test_accelerations_are_those_of_newton_and_euler(ibis, case):
    bird = list(compliant_birds(ibis))[case]
    model = birdmb.MultibodyModel(bird)
    rng = np.random.default_rng(case)
    for t in (0.0, 0.08, 0.19):
        x = model.driven_state(t) * rng.uniform(0.9, 1.1, len(model.state_names))
        x[2] = rng.normal()
        swinging = [name.endswith("hinge.rate") for name in model.state_names]
        x[swinging] = 5 * rng.normal(size=sum(swinging))
        q, v = coordinates(model, t, x)
        a, actuators = model.accelerations(t, x)
        compliant = np.array([name in model.state_names for name in bird.angle_names])
        free = np.concatenate([np.ones(BODY, bool), compliant, compliant])
        prescribed = np.concatenate([np.zeros(BODY), *[driver_motion(model.wing, t)[2]] * 2])
        np.testing.assert_array_equal(a[~free], prescribed[~free])

        M = mass_matrix(bird, q)
        bias = inverse_dynamics(bird, q, v, np.zeros(len(q))) - applied(model, t, x)
        expected = np.linalg.solve(
            M[np.ix_(free, free)], -bias[free] - M[np.ix_(free, ~free)] @ a[~free]
        )
        np.testing.assert_allclose(a[free], expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())
        torques = M @ a + bias
        scale = np.abs(torques[~free]).max()
        np.testing.assert_allclose(actuators[~free], torques[~free], atol=1e-9 * scale)


def test_flow_follows_the_accelerations(ibis_compliant):
    """The driven inertia holds prescribed joints well enough: RK67 against DOP853 of the rhs."""
    model = birdmb.MultibodyModel(
        ibis_compliant.with_values({"wing.discretisation": 8}), steps_per_beat=480
    )
    x0 = model.initial_guess()
    reference = solve_ivp(model.rhs, (0.0, 0.05), x0, method="DOP853", rtol=1e-10, atol=1e-11)
    np.testing.assert_allclose(model.flow(x0, 0.0, 0.05), reference.y[:, -1], atol=1e-8)


def test_momentum_is_conserved_without_loads(ibis_compliant):
    bird = ibis_compliant.with_values({"air.density": 0.0, "gravity": 0.0})
    model = birdmb.MultibodyModel(bird, steps_per_beat=240)
    x0 = np.array([3.0, -0.5, 0.8, 0.1, 0.2, -5.0])
    flight = model.trajectory(x0, 0.0, 0.25)
    values = []
    for t, x in zip(flight.times[::40], flight.states[::40], strict=True):
        q, v = coordinates(model, t, x)
        linear, angular = momentum(bird, q, v)
        values.append([*linear, *angular])
    values = np.array(values)
    np.testing.assert_allclose(values[:, 1], 0, atol=1e-14)
    np.testing.assert_allclose(values, values[:1] + 0 * values, atol=1e-9)
    assert np.ptp(flight["theta"]) > 0.1


@pytest.mark.parametrize("hinged", [False, True])
def test_symmetric_pairs_of_joints_stay_symmetric(ibis_compliant, hinged):
    """Left and right are integrated apart; their difference is round-off."""
    hinge = {"stiffness": 4.0, "damping": 3e-3, "mass": 1.5e-3} if hinged else None
    bird = ibis_compliant.with_values({"feathers.5.hinge": hinge, "feathers.3.hinge": hinge})
    model = birdmb.MultibodyModel(bird)
    x0 = model.driven_state()
    q, v, _ = model._exudyn.integrate(*model.coordinates(0.0, x0), np.empty(0), 0.0, 0.25, 180)
    n = len(bird.angle_names)
    right, left = slice(BODY, BODY + n), slice(BODY + n, None)
    np.testing.assert_allclose(q[right], q[left], atol=1e-10)
    np.testing.assert_allclose(v[right], v[left], atol=1e-8)


def test_driven_inertia_keeps_prescribed_joints_on_their_drivers(ibis):
    model = birdmb.MultibodyModel(ibis)
    x0 = model.initial_guess()
    q, v, _ = model._exudyn.integrate(*model.coordinates(0.0, x0), np.empty(0), 0.0, 0.25, 60)
    angles, rates, _ = driver_motion(model.wing, 0.25)
    np.testing.assert_allclose(q[BODY : BODY + 6], angles, atol=1e-8)
    np.testing.assert_allclose(v[BODY : BODY + 6], rates, atol=1e-6)
