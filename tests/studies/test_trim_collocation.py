"""The system of orbit and targets that trims by collocation."""

import numpy as np
import pytest

import birdmb
from birdmb.errors import StateError
from birdmb.orbits.trigonometric import resampled
from birdmb.studies.cycles import KeptModels
from birdmb.studies.trim_collocation import CollocatedTrim, solve_collocated

NAMES = ("forearm.roll.offset_deg", "shoulder.flap.amplitude_deg")
LOW, HIGH = np.array([-30.0, 15.0]), np.array([30.0, 70.0])
TARGETS = {"climb_rate": 0.0, "speed": 16.0}


@pytest.fixture(scope="module")
def models(coarse):
    def model_at(point):
        by_name = dict(zip(NAMES, point.tolist(), strict=True))
        return birdmb.RigidModel(coarse.with_values(by_name))

    return KeptModels(model_at)


@pytest.fixture(scope="module")
def system(models):
    return CollocatedTrim(models, LOW, HIGH, TARGETS, 9)


@pytest.fixture(scope="module")
def somewhere(system):
    """A wavy path beside any orbit, for which no term of the derivative vanishes."""
    waves = np.sin(2 * np.pi * np.arange(9)[:, None] / 9 + np.arange(4))
    path = np.array([14.0, 0.5, 0.1, 0.05]) + 0.1 * waves
    return system.pack(path, np.array([-5.0, 40.0]))


def test_jacobian_is_that_of_the_residual(system, somewhere):
    step, columns = 1e-5, []
    for shift in step * np.eye(somewhere.size):
        ends = [system.residual(somewhere + sign * shift) for sign in (1, -1)]
        columns.append((ends[0] - ends[1]) / (2 * step))
    differences = np.column_stack(columns)
    size = np.abs(differences).max()
    np.testing.assert_allclose(system.jacobian(somewhere), differences, atol=1e-5 * size)


def test_means_are_those_over_the_nodes(system, somewhere):
    u, w, _, theta = system.path(somewhere).T
    forward = (u * np.cos(theta) + w * np.sin(theta)).mean()
    climb = (u * np.sin(theta) - w * np.cos(theta)).mean()
    missed = system.residual(somewhere)[-2:]
    assert missed == pytest.approx([climb, np.hypot(forward, climb) - 16.0], abs=1e-12)


def test_parameters_stay_within_their_bounds(system, somewhere):
    beyond = somewhere.copy()
    beyond[-1] = 1.001
    with pytest.raises(StateError, match="left their bounds"):
        system.residual(beyond)


@pytest.mark.parametrize("nodes", [9, 13, 17])
def test_error_bound_of_a_trimmed_orbit_holds(models, nodes):
    rough = CollocatedTrim(models, LOW, HIGH, TARGETS, nodes)
    start = np.tile([14.0, 0.5, 0.0, 0.05], (nodes, 1))
    point, found = solve_collocated(
        rough, start, np.array([-5.0, 40.0]), tolerance=1e-8, accuracy=0.1
    )
    assert found.equations.nodes == nodes
    finer = CollocatedTrim(models, LOW, HIGH, TARGETS, 65)
    path = found.u.reshape(nodes, -1) * models(point).state_scale
    _, exact = solve_collocated(finer, path, point, tolerance=1e-8, accuracy=1e-9)
    error = np.abs(found.u.reshape(nodes, -1) - resampled(exact.u.reshape(65, -1), nodes)).max()
    assert error <= found.state_error <= 10 * error
