"""Birds and cycles that many tests share."""

from pathlib import Path

import pytest
from hypothesis import settings

import birdmb

# How long an example takes says how busy the machine is; and a failure must not depend on luck.
settings.register_profile("birdmb", deadline=None, derandomize=True)
settings.load_profile("birdmb")

TOPOLOGIES = Path(__file__).parent.parent / "topologies"
REFERENCE = Path(__file__).parent / "reference"


@pytest.fixture(scope="session")
def ibis():
    return birdmb.load_bird(TOPOLOGIES / "ibis.toml")


@pytest.fixture(scope="session")
def ibis_massless():
    return birdmb.load_bird(TOPOLOGIES / "ibis_massless.toml")


@pytest.fixture(scope="session")
def ibis_compliant():
    return birdmb.load_bird(TOPOLOGIES / "ibis_compliant_shoulder.toml")


@pytest.fixture(scope="session")
def ibis_tail():
    return birdmb.load_bird(TOPOLOGIES / "ibis_tail.toml")


@pytest.fixture(scope="session")
def tail_cycle(ibis_tail):
    return birdmb.find_limit_cycle(birdmb.RigidModel(ibis_tail))


@pytest.fixture(scope="session")
def ibis_published(ibis):
    return ibis.with_values({"wing.discretisation": "published"})


@pytest.fixture(scope="session")
def compliant_cycle(ibis_compliant):
    return birdmb.find_limit_cycle(birdmb.MultibodyModel(ibis_compliant))


@pytest.fixture(scope="session")
def rigid_cycle(ibis):
    return birdmb.find_limit_cycle(birdmb.RigidModel(ibis))
