"""A sweep that is killed loses nothing, computes nothing twice and ends in the same bits."""

import os
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

from birdmb.studies.sweeps import Study, sweep

from .sweeping import GRID, POINTS, Inline, coarse_bird, logged_model, read_log

ROOT = Path(__file__).parents[2]


@pytest.mark.long
@pytest.mark.skipif(not hasattr(os, "fork"), reason="forks")
def test_sweep_killed_at_ten_random_moments(tmp_path):
    store, log = tmp_path / "study.db", tmp_path / "killed.log"
    seed = os.urandom(4).hex()
    killed = subprocess.run(
        [sys.executable, "-m", "tests.studies.killed_sweep", str(store), str(log), seed],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=900,
        check=False,
    )
    assert killed.returncode == 0, f"seed {seed}: {killed.stderr}"
    stored = [int(line.split()[0]) for line in killed.stdout.splitlines()]
    assert len(stored) == 10
    assert any(0 < number < POINTS for number in stored), f"seed {seed}: killed beside the sweep"
    # Computed in vain is only what was under way in one of two workers, or waiting to be stored.
    assert POINTS <= len(read_log(log)) <= POINTS + 10 * 4

    whole = tmp_path / "whole.log"
    model = partial(logged_model, log=str(whole))
    uninterrupted = sweep(
        coarse_bird(), GRID, store=tmp_path / "whole.db", executor=Inline(), model=model
    ).to_xarray()
    assert len(read_log(whole)) == POINTS
    found = Study.open(store).to_xarray()
    assert found.attrs.pop("model") != uninterrupted.attrs.pop("model")  # the logs' names
    assert found.identical(uninterrupted)
