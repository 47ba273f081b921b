"""`birdmb plot` draws any file of the family, and says of others what they lack."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.image import imread

from birdmb.orbits import Steps, continue_branch


class Decay:
    """x' = p (1 - x), whose flow costs next to nothing."""

    state_names, period = ("x",), 1.0

    def __init__(self, rate):
        self.rate = rate
        self.state_scale = np.ones(1)

    def flow(self, x0, t0, t1):
        return 1 + np.exp(-self.rate * (t1 - t0)) * (x0 - 1)


@pytest.fixture
def branch(tmp_path):
    found = continue_branch(Decay, (2.0, 3.0), [0.9], steps=Steps(first=0.2, longest=0.4))
    found.save(tmp_path / "branch.nc")
    return tmp_path / "branch.nc"


def test_a_branch_is_drawn(branch, tmp_path, run):
    result = run("plot", str(branch), "--quantity", "period", "--out", str(tmp_path))
    assert result.exit_code == 0, result.stderr
    assert imread(tmp_path / "branch_period.png")[..., :3].std() > 0.02


def test_a_branch_is_asked_for_what_it_has_not(branch, run):
    result = run("plot", str(branch), "--quantity", "colour")
    assert result.exit_code == 2
    assert "has no colour; it has x, period" in " ".join(result.stderr.split())


def test_a_branch_has_units(branch):
    with xr.open_dataset(branch, engine="h5netcdf") as data:
        numbers = [name for name, of in data.variables.items() if of.dtype.kind in "fiub"]
        assert numbers
        assert [name for name in numbers if not data[name].attrs.get("units")] == []


def test_foreign_files_are_a_sentence(tmp_path, run):
    xr.Dataset({"x": ("t", [1.0])}).to_netcdf(tmp_path / "mine.nc", engine="h5netcdf")
    result = run("plot", str(tmp_path / "mine.nc"), "--out", str(tmp_path))
    assert result.exit_code == 2
    assert "no limit cycle, branch or sweep" in " ".join(result.stderr.split())
