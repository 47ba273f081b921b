"""The shipped pigeon flies as its file says."""

import numpy as np
import pytest

import birdmb
from birdmb.studies.bird_warnings import bird_warnings, load_warnings
from birdmb.studies.refinement import load_change


@pytest.fixture(scope="module")
def pigeon():
    return birdmb.load_bird("pigeon")


def test_nothing_is_odd_about_it(pigeon):
    assert bird_warnings(pigeon) == []
    assert load_warnings(load_change(pigeon)) == []


def test_it_flies_level_at_12_metres_a_second_and_stably(pigeon):
    cycle = birdmb.find_limit_cycle(birdmb.MultibodyModel(pigeon))
    assert cycle.mean_speed == pytest.approx(12.0, abs=0.05)
    assert cycle.mean_climb_rate == pytest.approx(0.0, abs=0.05)
    assert np.abs(cycle.multipliers[0]) < 1.0
