"""Limit cycles of the multibody bird: against the rigid one, and consistent in themselves."""

import pickle
import weakref

import numpy as np
import pytest

import birdmb
from birdmb.models import instants
from tests.models.test_rigid_cycle import sorted_like


def with_wing_mass(bird, factor):
    values = {}
    for bone in ("humerus", "forearm", "hand"):
        segment = getattr(bird.segments, bone)
        values[f"segments.{bone}.mass"] = segment.mass * factor
        values[f"segments.{bone}.inertia"] = (np.array(segment.inertia) * factor).tolist()
    return bird.with_values(values)


@pytest.mark.long
def test_massless_wings_give_the_rigid_bird_at_first_order_in_their_mass(ibis_massless):
    rigid = birdmb.find_limit_cycle(birdmb.RigidModel(ibis_massless, steps_per_beat=240))
    gaps = []
    for factor in (1.0, 0.1, 0.01):
        model = birdmb.MultibodyModel(with_wing_mass(ibis_massless, factor))
        cycle = birdmb.find_limit_cycle(model, rigid.x0)
        states = np.abs(cycle.x0 - rigid.x0) / model.state_scale
        gap = np.subtract(*sorted_like(cycle.multipliers, rigid.multipliers))
        gaps.append([states.max(), np.abs(gap).max()])
    gaps = np.array(gaps)
    assert gaps[0].max() < 1e-4
    np.testing.assert_allclose(np.log10(gaps[:-1] / gaps[1:]), 1.0, atol=0.05)


def test_compliant_cycle_is_closed_and_its_energy_balances(compliant_cycle):
    assert compliant_cycle.residual < 1e-8
    assert compliant_cycle.integration_error < 1e-6
    assert compliant_cycle.energy_imbalance < 1e-6
    assert compliant_cycle.stability == "unstable"
    assert (compliant_cycle.multiplier_errors < 1e-6).all()


@pytest.mark.long
def test_energy_balances_with_several_compliant_joints(ibis):
    bird = ibis.with_joint("shoulder.flap", stiffness=25, damping=0.2).with_joint(
        "elbow.sweep", stiffness=10, damping=0.05
    )
    bird = bird.with_values({"wing.discretisation": 8})
    cycle = birdmb.find_limit_cycle(birdmb.MultibodyModel(bird))
    assert cycle.energy_imbalance < 1e-6
    dissipated = {
        joint: cycle.driver_powers[joint] - cycle.joint_powers[joint] for joint in bird.joint_names
    }
    # What the drivers put in beyond what reaches the joints is lost in the dampers.
    for joint in bird.joints:
        j = bird.joint_names.index(joint.name)
        slip = (cycle.beat.joint_rates - cycle.beat.driver_rates)[:-1, 0, j]
        expected = (
            2 * (joint.damping or 0.0) * np.mean(slip**2) if joint in bird.compliant_joints else 0
        )
        assert dissipated[joint.name] == pytest.approx(expected, abs=1e-4)


def test_wing_power_is_what_the_joints_and_the_fanning_feathers_deliver(rigid_cycle):
    total = sum(rigid_cycle.joint_powers.values()) + rigid_cycle.feather_power
    assert total == pytest.approx(rigid_cycle.power, rel=1e-12)
    assert 0 < abs(rigid_cycle.feather_power) < 0.1 * abs(rigid_cycle.power)


def test_rigid_power_balances_with_climbing(rigid_cycle):
    """In periodic flight the air gives the body what gravity takes."""
    assert rigid_cycle.energy_imbalance < 1e-6
    assert rigid_cycle.potential_power == pytest.approx(
        -1.2 * 9.81 * rigid_cycle.mean_climb_rate, rel=1e-12
    )
    assert rigid_cycle.cost_of_transport == pytest.approx(
        rigid_cycle.power / (1.2 * 9.81 * rigid_cycle.mean_speed), rel=1e-12
    )


@pytest.mark.long
def test_multipliers_do_not_depend_on_segments_or_starting_phase(ibis_compliant, compliant_cycle):
    model = birdmb.MultibodyModel(ibis_compliant)
    others = [
        birdmb.find_limit_cycle(model, compliant_cycle.x0, segments=2),
        birdmb.find_limit_cycle(model, compliant_cycle.x0, segments=5),
        birdmb.find_limit_cycle(
            model, model.flow(compliant_cycle.x0, 0.0, 0.0625), start_time=0.0625
        ),
    ]
    for other in others:
        np.testing.assert_allclose(
            *sorted_like(other.multipliers, compliant_cycle.multipliers), atol=1e-6
        )


def test_models_can_be_pickled(ibis_compliant):
    model = birdmb.MultibodyModel(ibis_compliant, steps_per_beat=60)
    copy = pickle.loads(pickle.dumps(model))
    x = model.driven_state()
    assert copy.steps_per_beat == 60
    np.testing.assert_array_equal(copy.flow(x, 0.0, 0.01), model.flow(x, 0.0, 0.01))


def test_dense_flight_passes_through_the_steps(ibis_compliant, compliant_cycle):
    model = birdmb.MultibodyModel(ibis_compliant)
    flight = model.trajectory(compliant_cycle.x0, 0.0, 0.25)
    np.testing.assert_allclose(
        flight.states[-1], model.flow(compliant_cycle.x0, 0.0, 0.25), atol=1e-9
    )
    np.testing.assert_allclose(flight(0.1), model.flow(compliant_cycle.x0, 0.0, 0.1), atol=1e-4)
    assert flight["theta"].shape == flight.times.shape
    assert flight.at([0.05, 0.07]).states.shape == (2, 6)


def test_result_as_a_labelled_dataset(compliant_cycle, tmp_path):
    dataset = compliant_cycle.to_xarray()
    assert list(dataset["state"].values) == [
        "u", "w", "q", "theta", "shoulder.flap", "shoulder.flap.rate",
    ]  # fmt: skip
    assert dataset.attrs["power"] == compliant_cycle.power
    assert dataset["force"].attrs["units"] == "N"
    dataset.to_netcdf(tmp_path / "cycle.nc", engine="h5netcdf")
    assert (tmp_path / "cycle.nc").stat().st_size > 0


@pytest.mark.parametrize("kind", [birdmb.RigidModel, birdmb.MultibodyModel])
def test_a_state_that_is_not_finite_is_told(ibis, kind):
    model = kind(ibis.with_values({"wing.discretisation": 8}))
    bad = [18.0, np.nan, 0.0, 0.0]
    with pytest.raises(birdmb.StateError, match="not finite"):
        model.loads(0.0, bad)
    with pytest.raises(birdmb.StateError, match="diverged"):
        model.flow(bad, 0.0, 0.25)
    with pytest.raises(birdmb.BirdmbError, match="not finite"):
        birdmb.find_limit_cycle(model, bad)


@pytest.mark.parametrize("kind", [birdmb.RigidModel, birdmb.MultibodyModel])
@pytest.mark.parametrize("values", [{"air.density": 0.0}, {"body.mass": 60.0}])
def test_a_bird_that_cannot_fly_is_told(ibis, kind, values):
    """In a vacuum, or fifty times as heavy: the search says how far it came and what to try."""
    model = kind(ibis.with_values({**values, "wing.discretisation": 8}))
    with pytest.raises(
        birdmb.ConvergenceError, match=r"iterations.*closure error.*(?i:try)"
    ) as caught:
        birdmb.find_limit_cycle(model)
    assert np.isfinite(caught.value.best_x).all()
    assert caught.value.residual > 0.1
    assert caught.value.history


def test_a_wing_folded_too_far_is_told(ibis):
    bird = ibis.with_values({"elbow.sweep.offset_deg": 130, "wrist.sweep.offset_deg": -150})
    with pytest.raises(birdmb.StateError, match=r"ibis: no line orthogonal.*elbow.sweep"):
        birdmb.RigidModel(bird).flow([18, -2, 0, 0], 0.0, 0.25)


@pytest.mark.parametrize("kind", [birdmb.RigidModel, birdmb.MultibodyModel])
def test_a_model_is_freed_when_nobody_needs_it(ibis, kind):
    """At once and without the garbage collector: branches and sweeps make thousands of models."""
    model = kind(ibis.with_values({"wing.discretisation": 8}))
    model.flow(model.initial_guess(), 0.0, 0.25)
    gone = weakref.ref(model)
    del model
    assert gone() is None


@pytest.mark.long
@pytest.mark.parametrize(("method", "steps"), [("explicit", 40), ("implicit", 16)])
def test_integration_error_is_that_of_the_method_that_was_named(
    ibis_compliant, method, steps, monkeypatch
):
    bird = ibis_compliant.with_values({"wing.discretisation": 4})
    cycle = birdmb.find_limit_cycle(
        birdmb.MultibodyModel(bird, steps_per_beat=steps, integrator=method),
        tolerance=1e-7,
        method="shooting",
    )
    used = []
    flow = birdmb.MultibodyModel.flow

    def seen(model, *arguments):
        used.append(model.integration)
        return flow(model, *arguments)

    monkeypatch.setattr(birdmb.MultibodyModel, "flow", seen)
    assert 1e-9 < cycle.integration_error < 1e-2
    assert used == [(method, steps), (method, 2 * steps)]


def test_birds_that_differ_in_springs_share_their_instants_and_no_result_depends_on_it(
    ibis_compliant,
):
    bird = ibis_compliant.with_values({"wing.discretisation": 4})
    model, softer, wider = (
        birdmb.MultibodyModel(other, steps_per_beat=40)
        for other in (
            bird,
            bird.with_values({"shoulder.flap.stiffness": 15, "segments.hand.mass": 0.02}),
            bird.with_values({"shoulder.sweep.amplitude_deg": 21}),
        )
    )
    at = np.array([0.1])
    kept = [each.tree._instants[0].stacked(at) for each in (model, softer, wider)]
    assert kept[0] is kept[1]
    assert kept[0] is not kept[2]
    x = model.driven_state()
    end = softer.flow(x, 0.0, 0.25)
    instants._kept.cache_clear()
    alone = birdmb.MultibodyModel(softer.bird, steps_per_beat=40)
    assert alone.tree._instants[0].stacked(at) is not kept[1]
    np.testing.assert_array_equal(alone.flow(x, 0.0, 0.25), end)
