"""Limit cycles of the rigid bird: the reference program's, and the converged ones."""

import json

import numpy as np
import pytest

import birdmb
from tests.conftest import REFERENCE


def multipliers(reference):
    return np.array(reference["mult_re"]) + 1j * np.array(reference["mult_im"])


def sorted_like(found, expected):
    """Match conjugate pairs, whose order among themselves means nothing."""
    order = np.lexsort((found.imag, -np.abs(found).round(6)))
    other = np.lexsort((expected.imag, -np.abs(expected).round(6)))
    return found[order], expected[other]


@pytest.mark.parametrize("case", ["A42", "level"])
def test_published_discretisation_gives_the_reference_programs_cycle(ibis_published, case):
    """The 150 Runge-Kutta steps of the reference, its velocities by differences of 1e-6."""
    reference = json.loads((REFERENCE / "limit_cycles.json").read_text())[case]
    bird = ibis_published.with_joint("shoulder.flap", amplitude_deg=reference["A_deg"])
    model = birdmb.RigidModel(bird, steps_per_beat=reference["n_rk4"])
    cycle = birdmb.find_limit_cycle(model)
    np.testing.assert_allclose(cycle.x0, reference["x0"], atol=2e-5)
    np.testing.assert_allclose(*sorted_like(cycle.multipliers, multipliers(reference)), atol=2e-5)
    assert cycle.mean_velocity == pytest.approx(
        [reference["mean_U"], reference["mean_W"]], abs=1e-4
    )


def test_converged_cycle(rigid_cycle):
    """Within 0.02 of a prototype's clean formulation; x(0) 17.8 to 17.9, -2.11, -0.103, -0.125."""
    expected = np.array([1.421, 0.827 + 0.261j, 0.827 - 0.261j, 0.188])
    np.testing.assert_allclose(*sorted_like(rigid_cycle.multipliers, expected), atol=0.02)
    np.testing.assert_allclose(rigid_cycle.x0, [17.85, -2.11, -0.103, -0.125], atol=0.06)
    assert rigid_cycle.residual < 1e-8
    assert rigid_cycle.stability == "unstable"


def test_multipliers_are_stable_when_the_elements_are_doubled(ibis, rigid_cycle):
    finer = birdmb.find_limit_cycle(
        birdmb.RigidModel(ibis.with_values({"wing.discretisation.elements": 64}))
    )
    np.testing.assert_allclose(*sorted_like(finer.multipliers, rigid_cycle.multipliers), atol=0.003)


def test_variational_and_finite_difference_multipliers_agree(ibis, rigid_cycle):
    model = birdmb.RigidModel(ibis)
    differences = birdmb.find_limit_cycle(model, rigid_cycle.x0, jacobian="finite-differences")
    np.testing.assert_allclose(
        *sorted_like(differences.multipliers, rigid_cycle.multipliers), atol=1e-6
    )


def test_integration_is_of_fourth_order(ibis):
    start = [18.0, -2.0, -0.1, -0.12]
    ends = [
        birdmb.RigidModel(ibis, steps_per_beat=n).flow(start, 0.0, 0.25) for n in (60, 120, 240)
    ]
    errors = [np.abs(end - ends[-1]).max() for end in ends[:-1]]
    assert errors[0] < 2e-6
    assert 3.5 < np.log2(errors[0] / errors[1]) < 5.5


def test_rhs_is_the_derivative_of_the_flow(ibis):
    model = birdmb.RigidModel(ibis)
    x, h = np.array([18.0, -2.0, 0.2, -0.1]), 1e-4
    difference = (model.flow(x, 0.03, 0.03 + h) - model.flow(x, 0.03, 0.03 - h)) / (2 * h)
    np.testing.assert_allclose(difference, model.rhs(0.03, x), rtol=1e-5, atol=1e-5)


def test_multipliers_do_not_depend_on_segments_or_starting_phase(ibis, rigid_cycle):
    model = birdmb.RigidModel(ibis)
    others = [
        birdmb.find_limit_cycle(model, rigid_cycle.x0, segments=2),
        birdmb.find_limit_cycle(model, rigid_cycle.x0, segments=5),
        birdmb.find_limit_cycle(model, model.flow(rigid_cycle.x0, 0.0, 0.1), start_time=0.1),
    ]
    for other in others:
        np.testing.assert_allclose(
            *sorted_like(other.multipliers, rigid_cycle.multipliers), atol=1e-6
        )
        assert other.mean_speed == pytest.approx(rigid_cycle.mean_speed, abs=1e-6)
