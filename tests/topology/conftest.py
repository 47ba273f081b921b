from pathlib import Path

import pytest

from birdmb.topology import Bird, load_bird

TOPOLOGIES = Path(__file__).parents[2] / "topologies"


@pytest.fixture(scope="session")
def topologies() -> Path:
    return TOPOLOGIES


@pytest.fixture(scope="session")
def ibis() -> Bird:
    return load_bird(TOPOLOGIES / "ibis.toml")
