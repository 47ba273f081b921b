"""Air that remembers in Exudyn's system: its lags, its inertia, and flights through it."""

import weakref

import exudyn as exu
import numpy as np
import pytest

import birdmb
from birdmb.models.air_kernel import Motion, air_forces
from birdmb.models.tree_coordinates import COORDINATES, attitude, space_state, whole
from birdmb.models.tree_rates import TreeRates

CURRENT = exu.ConfigurationType.Current
TREE, ADDED = exu.ObjectIndex(0), exu.ObjectIndex(1)  # of Exudyn's system
ROW = np.zeros(1, np.int64)


def remembering(bird):
    return bird.with_values(
        {"air.wake": "unsteady", "air.wake_points": 4, "wing.discretisation": 4}
    )


@pytest.fixture(scope="module")
def compliant(ibis_compliant):
    return remembering(ibis_compliant)


@pytest.fixture(scope="module", params=["massless", "planar", "free"])
def model(request, compliant, ibis_massless):
    """Joints prescribed; the shoulder compliant; that in space, each wing for itself."""
    if request.param == "massless":
        return birdmb.MultibodyModel(remembering(ibis_massless), integrator="explicit")
    return birdmb.MultibodyModel(compliant, motion=request.param, integrator="explicit")


def states_near(model, t, count, seed):
    rng = np.random.default_rng(seed)
    near = rng.standard_normal((count, len(model.state_names)))
    return model.driven_state(t) + 0.1 * model.state_scale * near


def put(model, x):
    """Put a state into Exudyn's system, whose time is 0; in space on a heading of its own."""
    q, v = model.coordinates(0.0, x)
    if model.motion.name == "free":
        yaw = COORDINATES.index("yaw")
        q[yaw] = 0.7
        v[:3] = attitude(q) @ x[[model.state_names.index(name) for name in "uvw"]]
    data = model._exudyn.mbs.systemData
    data.SetODE2Coordinates(q, CURRENT)
    data.SetODE2Coordinates_t(v, CURRENT)
    data.SetODE1Coordinates(x[model._lags], CURRENT)
    return q, v


def exudyn_item(model, item, what):
    return np.array(model._exudyn.mbs.ComputeItem(item, what))


def test_exudyns_mass_matrix_has_the_kinetic_energy_of_the_air(model):
    """1/2 v M v of the coordinates is that of the twist and the joints' rates in the kernel."""
    tree, mirrored = model.tree, model.is_mirrored
    mass = exu.ComputeItemType.MassMatrix
    driven = np.flatnonzero(model.prescribed)
    for x in states_near(model, 0.0, 6, seed=2):
        q, v = put(model, x)
        added = exudyn_item(model, ADDED, mass)
        np.testing.assert_allclose(added, added.T, rtol=1e-12, atol=1e-15)
        of_tree = exudyn_item(model, TREE, mass)
        np.testing.assert_allclose(of_tree, tree.inertia.at(q[None], v[None])[0][0], rtol=1e-12)
        assert (np.diag(added)[driven] > 1e8).all()
        v[driven] = 0.0
        body = model._coordinates_of_body.size
        twist = space_state(
            whole(q[:body], model._coordinates_of_body), whole(v[:body], model._coordinates_of_body)
        )[:6]
        joints = slice(body, body + (q.size - body) // (2 if mirrored else 1))
        drivers, instants = tree.drivers_at(np.zeros(1))
        motion = Motion(
            twist[None],
            np.zeros((1, 3)),
            q[None, joints].copy(),
            v[None, joints].copy(),
            x[None, model._lags].copy(),
        )
        shapes = tree.shapes_at(instants, np.zeros(1), ROW, motion.angles, motion.rates)
        found = air_forces(tree.constants, shapes, motion, drivers.accelerations[0], ROW)
        moves = np.concatenate([twist[tree.constants.links.directions], v[joints]])
        assert v @ added @ v == pytest.approx(moves @ found.inertia @ moves, rel=1e-11)


def test_exudyns_equations_of_motion_are_the_partitioned_ones(model):
    for x in states_near(model, 0.0, 4, seed=3):
        q, v = put(model, x)
        mass, left = exu.ComputeItemType.MassMatrix, exu.ComputeItemType.ODE2LHS
        matrix = exudyn_item(model, TREE, mass) + exudyn_item(model, ADDED, mass)
        a = np.linalg.solve(matrix, -exudyn_item(model, TREE, left))
        # How the state changes while the coordinates move so.
        step = 1e-5
        ends = [
            model._state(q + h * v + 0.5 * h * h * a, v + h * a, np.zeros(0), "")
            for h in (-step, step)
        ]
        change = (ends[1] - ends[0]) / (2.0 * step)
        count = change.size
        scale = model.state_scale[:count] * 100.0
        np.testing.assert_allclose(change / scale, model.rhs(0.0, x)[:count] / scale, atol=1e-8)


def test_flights_by_exudyn_and_by_radau_agree_at_their_orders(model):
    x = states_near(model, 0.02, 1, seed=0)[0]

    def end(method, steps):
        other = birdmb.MultibodyModel(
            model.bird, motion=model.motion.name, integrator=method, steps_per_beat=steps
        )
        return other.flow(x, 0.02, 0.045) / model.state_scale

    finest = end("implicit", 480)
    explicit = [np.abs(end("explicit", n) - finest).max() for n in (120, 240)]
    implicit = [np.abs(end("implicit", n) - finest).max() for n in (60, 120)]
    assert explicit[1] < 1e-7
    assert implicit[1] < 1e-7
    assert np.log2(explicit[0] / explicit[1]) > 5.5
    assert np.log2(implicit[0] / implicit[1]) > 4.5


def test_a_stage_evaluates_the_air_once_for_forces_inertia_and_lags(compliant, monkeypatch):
    model = birdmb.MultibodyModel(compliant, integrator="explicit", steps_per_beat=200)
    calls = []
    loads = TreeRates.loads

    def counted(tree, *arguments):
        calls.append(arguments[0])
        return loads(tree, *arguments)

    monkeypatch.setattr(TreeRates, "loads", counted)
    model.flow(model.driven_state(0.0), 0.0, 4 * model.bird.period / 200)
    # Exudyn asks for the lags' rates once more at the end; there the next step would begin.
    assert len(calls) == 4 * 7 + 1


def test_lags_near_pointed_tips_are_integrated_implicitly(compliant):
    """They fade with speed over chord: more elements put the outermost of them further out."""
    assert birdmb.MultibodyModel(compliant).integration == ("explicit", 240)
    finer = compliant.with_values({"wing.discretisation": 8})
    assert birdmb.MultibodyModel(finer).integration == ("implicit", 60)
    assert birdmb.MultibodyModel(compliant, integrator="implicit").integration == ("implicit", 60)


def test_no_model_is_kept_by_exudyn(compliant):
    model = birdmb.MultibodyModel(compliant, integrator="explicit", steps_per_beat=200)
    model.flow(model.driven_state(0.0), 0.0, 2 * model.bird.period / 200)
    gone = weakref.ref(model)
    del model
    assert gone() is None


@pytest.mark.long
@pytest.mark.parametrize("name", ["compliant", "massless"])
def test_multipliers_by_differences_through_exudyn_and_by_collocation(
    compliant, ibis_massless, name
):
    bird = compliant if name == "compliant" else remembering(ibis_massless)
    collocated = birdmb.find_limit_cycle(birdmb.MultibodyModel(bird), method="collocation")
    model = birdmb.MultibodyModel(bird)
    assert model.integration.method == "explicit"
    shot = birdmb.find_limit_cycle(model, collocated.x0, method="shooting")
    assert np.abs((shot.x0 - collocated.x0) / model.state_scale).max() < 3e-7
    for one, other in ((shot, collocated), (collocated, shot)):
        for multiplier, error in zip(one.multipliers, one.multiplier_errors, strict=True):
            k = int(np.argmin(np.abs(other.multipliers - multiplier)))
            bar = error + other.multiplier_errors[k]
            assert abs(other.multipliers[k] - multiplier) < bar
