from pathlib import Path

import pytest

import birdmb

from ..cli.pigeon import written


@pytest.fixture(scope="session")
def flown_ibis(ibis):
    """An ibis with another gait than that of its file, a second harmonic in its flap."""
    return ibis.with_values(
        {
            "gait.frequency": 4.13,
            "shoulder.flap.offset_deg": 6.0,
            "shoulder.flap.amplitude_deg": 37.0,
            "shoulder.flap.harmonics": [{"order": 2, "amplitude_deg": 4.0, "phase_deg": 30.0}],
            "elbow.sweep.phase_deg": -70.0,
        }
    )


@pytest.fixture(scope="session")
def pigeon_file(tmp_path_factory) -> Path:
    return Path(written(tmp_path_factory.mktemp("pigeon")))


@pytest.fixture(scope="session")
def pigeon(pigeon_file):
    return birdmb.load_bird(pigeon_file)


@pytest.fixture(scope="session")
def flown_pigeon(pigeon):
    return pigeon.with_values(
        {
            "gait.frequency": 6.7,
            "shoulder.flap.amplitude_deg": 44.0,
            "shoulder.pitch.amplitude_deg": 3.0,
            "shoulder.pitch.phase_deg": 20.0,
            "wrist.sweep.offset_deg": -27.0,
        }
    )
