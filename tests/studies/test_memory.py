"""What the air's memory changes, asked from either flight, in Python and at the command line."""

import json

import numpy as np
import pytest

import birdmb
from birdmb.studies.flight_regime import flight_regime, regime_warnings
from tests.cli.conftest import run as run_fixture

pytestmark = pytest.mark.long

run = run_fixture
COARSE = {"wing.discretisation": 8, "air.wake_points": 4}


@pytest.fixture(scope="module")
def effect(ibis):
    return birdmb.memory_effect(
        birdmb.find_limit_cycle(birdmb.RigidModel(ibis.with_values(COARSE)))
    )


def test_it_is_the_same_from_either_flight(effect):
    back = birdmb.memory_effect(effect.unsteady)
    assert back.unsteady is effect.unsteady
    np.testing.assert_allclose(back.quasi_steady.x0, effect.quasi_steady.x0, atol=1e-6)
    assert back.multiplier_change == pytest.approx(effect.multiplier_change, abs=1e-6)
    assert effect.unsteady.model.bird.air.wake == "unsteady"
    assert not effect.quasi_steady.model.wake.count


def test_it_says_what_changes(effect):
    assert effect.multiplier_change == pytest.approx(0.035, abs=0.005)
    assert not effect.changes_verdict
    assert "leaves the verdict as it is: with it unstable, |Lambda|max 1.4" in str(effect)


def test_the_command_line_says_it_too(run):
    done = run(
        "cycle", "ibis", "--model", "rigid", "--memory", "--json", "--set",
        "wing.discretisation=8", "--set", "air.wake_points=4",
    )  # fmt: skip
    assert done.exit_code == 0, done.stderr
    found = json.loads(done.stdout)["memory"]
    assert found["changes_verdict"] is False
    assert found["unsteady"]["largest_multiplier"] == pytest.approx(
        found["quasi-steady"]["largest_multiplier"] + found["multiplier_change"]
    )


def test_a_wing_that_memory_does_not_suit_is_no_failure_of_the_flight(run):
    done = run(
        "cycle", "ibis", "--model", "rigid", "--memory", "--set", "wing.discretisation=published"
    )
    assert done.exit_code == 0, done.stderr
    assert "Nothing can be said of the memory of the air" in done.stdout


def test_fast_beats_are_covered_by_memory(ibis):
    regime = flight_regime(ibis.with_values({"gait.frequency": 12.0}))
    assert any("air.wake" in warning for warning in regime_warnings(regime))
    assert not any("reduced" in each for each in regime_warnings(regime, with_memory=True))
