"""Collocated limit cycles of birds against shooting, against more nodes, and flown."""

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

import birdmb
from tests.conftest import TOPOLOGIES

RIGID = ("ibis", "ibis_tail", "ibis_thesis_ch8")
MULTIBODY = ("ibis_massless", "ibis_tail", "ibis_compliant_shoulder")


def apart(one, other):
    """Distances (n,) of the multipliers of two cycles, paired."""
    distance = np.abs(np.subtract.outer(one.multipliers, other.multipliers))
    rows, columns = linear_sum_assignment(distance)
    return distance[rows, columns]


def agree(model):
    found = birdmb.find_limit_cycle(model)
    shot = birdmb.find_limit_cycle(model, found.x0, method="shooting")
    assert (found.method, shot.method) == ("collocation", "shooting")
    of_states = np.abs((found.x0 - shot.x0) / found.state_scale).max()
    assert of_states < found.state_error + 10 * shot.integration_error + 1e-8
    assert (apart(found, shot) < found.verdict_errors + shot.verdict_errors).all()
    return found, shot


@pytest.mark.parametrize("name", RIGID)
def test_rigid_birds_have_the_cycles_of_shooting(name):
    model = birdmb.RigidModel(birdmb.load_bird(TOPOLOGIES / f"{name}.toml"), steps_per_beat=480)
    found, shot = agree(model)
    assert np.abs((found.x0 - shot.x0) / found.state_scale).max() < 1e-6
    assert apart(found, shot).max() < 1e-6
    assert found.multiplier_errors.max() < 1e-6
    assert found.flown_closure < 1e-7
    assert found.energy_imbalance < 1e-6


@pytest.mark.long
@pytest.mark.parametrize("name", MULTIBODY)
def test_multibody_birds_have_the_cycles_of_shooting(name):
    model = birdmb.MultibodyModel(birdmb.load_bird(TOPOLOGIES / f"{name}.toml"))
    found, shot = agree(model)
    assert apart(found, shot).max() < 1e-6
    assert found.multiplier_errors.max() < 1e-6
    assert found.flown_closure < 1e-5
    assert found.failed_checks == ()


def test_hinged_feathers_need_no_implicit_integration_to_be_found():
    model = birdmb.MultibodyModel(birdmb.load_bird(TOPOLOGIES / "ibis_hinged_feathers.toml"))
    found = birdmb.find_limit_cycle(model)
    assert found.method == "collocation"
    finer = birdmb.find_limit_cycle(model, found, nodes=2 * found.nodes + 1)
    assert np.abs((found.x0 - finer.x0) / found.state_scale).max() < found.state_error < 1e-6
    assert (apart(found, finer) < found.multiplier_errors + finer.multiplier_errors).all()
    # by a prototype that was written apart from this program
    assert found.multipliers[0].real == pytest.approx(1.629787, abs=1e-6)
    assert found.flown_closure < 1e-4


def test_rates_that_stiff_light_joints_make_rough_have_honest_bars(ibis):
    """A pitch joint whose inertia all but vanishes twice a beat: 1e6 off without more instants."""
    bird = ibis.with_values({"wing.discretisation": 4, "shoulder.flap.amplitude_deg": 42.0})
    for joint in ("shoulder.flap", "shoulder.pitch"):
        bird = bird.with_joint(joint, stiffness=15, damping=0.2)
    found = birdmb.find_limit_cycle(birdmb.MultibodyModel(bird))
    assert len(found.points) > found.nodes
    assert found.multiplier_errors.max() < 1e-5
    other = birdmb.find_limit_cycle(birdmb.MultibodyModel(bird), found, nodes=91)
    assert (apart(found, other) < found.multiplier_errors + other.multiplier_errors).all()


def test_the_published_wing_is_too_rough(ibis_published):
    found = birdmb.find_limit_cycle(birdmb.RigidModel(ibis_published))
    assert found.method == "shooting"
    assert "too rough for collocation" in found.method_reason


def test_a_neighbour_s_cycle_is_a_start(ibis_compliant, compliant_cycle):
    heavier = ibis_compliant.with_values({"body.mass": 1.05 * ibis_compliant.body.mass})
    model = birdmb.MultibodyModel(heavier)
    cold, warm = birdmb.find_limit_cycle(model), birdmb.find_limit_cycle(model, compliant_cycle)
    assert np.abs((warm.x0 - cold.x0) / cold.state_scale).max() < 2 * cold.state_error
    assert (apart(warm, cold) < warm.multiplier_errors + cold.multiplier_errors).all()
    assert len(warm.iterations) < len(cold.iterations)


def test_a_tethered_bird_is_collocated_too(ibis_compliant):
    model = birdmb.MultibodyModel(ibis_compliant, motion="held", body_state=[18.0, -2.0, 0.0, -0.1])
    found = birdmb.find_limit_cycle(model)
    shot = birdmb.find_limit_cycle(model, found.x0, method="shooting")
    assert found.method == "collocation"
    assert (apart(found, shot) < found.verdict_errors + shot.verdict_errors + 1e-9).all()


def test_the_published_wing_is_met_on_a_mesh(ibis_published):
    """It jumps in time: the mesh crowds there, and says the same as shooting within both bars."""
    bird = ibis_published.with_values({"wing.discretisation.elements": 8})
    cycle = birdmb.find_limit_cycle(birdmb.RigidModel(bird), method="collocation", accuracy=1e-5)
    assert cycle.intervals is not None
    assert "too rough" in cycle.method_reason
    shot = birdmb.find_limit_cycle(birdmb.RigidModel(bird, steps_per_beat=960))
    assert shot.method == "shooting"
    apart = np.abs((cycle.x0 - shot.x0) / cycle.state_scale).max()
    assert apart < cycle.state_error + 10 * shot.integration_error
    gaps = np.abs(cycle.multipliers - shot.multipliers)
    assert (gaps < cycle.multiplier_errors + 1e-4).all()
    assert cycle.energy_imbalance < 1e-3
    assert cycle.flown_closure < 1e-3
