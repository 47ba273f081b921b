"""The comparison of loads on two numbers of elements."""

import numpy as np
import pytest

import birdmb
from birdmb.studies.refinement import load_change

SQUARE = {f"feathers.{name}.rest_angle_deg": 0.0 for name in "7531"}


def test_change_is_that_of_the_loads(ibis):
    """The resultants of both birds, at the same motion, one instant after the other."""
    coarse = birdmb.RigidModel(ibis.with_values({"wing.discretisation.elements": 8}))
    fine = birdmb.RigidModel(ibis.with_values({"wing.discretisation.elements": 16}))
    found = load_change(coarse.bird)
    assert found.elements == 16
    x = coarse.initial_guess()
    times = np.arange(12) / 12 * coarse.period
    forces = [[model.loads(t, x).force for t in times] for model in (coarse, fine)]
    change = np.linalg.norm(np.subtract(*forces), axis=1).max()
    assert found.force == pytest.approx(change / np.linalg.norm(forces[1], axis=1).max())
    assert found.largest == max(found.force, found.circulation)


@pytest.mark.parametrize("elements", [16, 32, 64])
def test_a_square_tip_settles(ibis, elements):
    """All joints moving; what is left stems from the corners of the edges."""
    bird = ibis.with_values(SQUARE | {"wing.discretisation.elements": elements})
    assert load_change(bird).largest < 0.02


def test_without_air_nothing_changes(ibis):
    found = load_change(ibis.with_values({"air.density": 0.0, "wing.discretisation.elements": 4}))
    assert found.force == 0.0


def test_of_very_many_elements_half_are_compared(ibis):
    assert load_change(ibis.with_values({"wing.discretisation.elements": 260})).elements == 130
