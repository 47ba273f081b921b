"""A coarse ibis, for studies whose point is not the discretisation."""

from functools import partial

import pytest

import birdmb


@pytest.fixture(scope="session")
def coarse(ibis):
    return ibis.with_values({"wing.discretisation.elements": 8})


@pytest.fixture(scope="session")
def quick():
    return partial(birdmb.RigidModel, steps_per_beat=30)


@pytest.fixture(scope="session")
def coarse_cycle(coarse, quick):
    return birdmb.find_limit_cycle(quick(coarse))
