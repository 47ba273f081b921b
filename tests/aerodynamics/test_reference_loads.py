"""Loads of the published discretisation against the reference program, state by state."""

import numpy as np
import pytest

import birdmb
from tests.conftest import REFERENCE


@pytest.fixture(scope="module")
def reference():
    return np.load(REFERENCE / "forces.npz")


def test_loads_are_the_reference_programs(ibis_published, reference):
    """They agree to the reference's central-difference velocities, 1e-6 of the force scale."""
    model = birdmb.RigidModel(ibis_published)
    for i, x in enumerate(reference["states"]):
        for j, t in enumerate(reference["t"]):
            loads = model.loads(t, x)
            side, up, back, moment = reference["F"][i, j, [0, 1, 2, 3]]
            found = [loads.force[1], -loads.force[2], -loads.force[0], loads.moment[1]]
            np.testing.assert_allclose(found, [side, up, back, moment], atol=2e-5)
            np.testing.assert_allclose(
                loads.right.circulation, reference["gamma"][i, j, 8:], atol=1e-6
            )
            np.testing.assert_allclose(
                loads.right.angle_of_attack, reference["alpha"][i, j, 8:], atol=1e-6
            )
            assert loads.power == pytest.approx(reference["Pkin"][i, j], abs=1e-4)
