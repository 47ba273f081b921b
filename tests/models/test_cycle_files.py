"""Cycles that are read back equal those that were saved, to the last bit, and go on."""

from dataclasses import fields

import numpy as np
import pytest
import xarray as xr

import birdmb
from birdmb import DataFileError, find_limit_cycle, load_cycle
from birdmb.orbits import OdeModel

from ..conftest import TOPOLOGIES

COARSE = {"wing.discretisation": 4}


def same(first, second):
    """Whether two fields of a cycle are equal to the last bit, and of one type."""
    if isinstance(first, np.ndarray):
        return (
            first.dtype == second.dtype
            and first.shape == second.shape
            and first.tobytes() == second.tobytes()
        )
    if isinstance(first, tuple):
        return len(first) == len(second) and all(map(same, first, second))
    if hasattr(first, "__dataclass_fields__"):
        return all(
            same(getattr(first, each.name), getattr(second, each.name)) for each in fields(first)
        )
    return first == second


@pytest.fixture(scope="module")
def coarse():
    return birdmb.load_bird(TOPOLOGIES / "ibis.toml").with_values(COARSE)


@pytest.fixture(scope="module")
def sprung():
    return birdmb.load_bird(TOPOLOGIES / "ibis_compliant_shoulder.toml").with_values(COARSE)


@pytest.fixture(scope="module")
def cycle(coarse):
    return find_limit_cycle(birdmb.RigidModel(coarse))


@pytest.fixture(scope="module")
def stored(cycle, tmp_path_factory):
    path = tmp_path_factory.mktemp("cycles") / "cycle.nc"
    cycle.save(path)
    return path


CYCLES = {
    "rigid": lambda bird, _: find_limit_cycle(birdmb.RigidModel(bird)),
    "shot": lambda bird, _: find_limit_cycle(
        birdmb.RigidModel(bird, steps_per_beat=24), method="shooting"
    ),
    "with memory": lambda bird, _: find_limit_cycle(
        birdmb.RigidModel(bird.with_values({"air.wake": "unsteady", "air.wake_points": 4}))
    ),
    "compliant": lambda _, bird: find_limit_cycle(birdmb.MultibodyModel(bird)),
    "in space": lambda bird, _: find_limit_cycle(birdmb.RigidModel(bird, motion="free")),
    "trimmed": lambda bird, _: birdmb.trim_flight(bird).cycle,
    # Its edges are not rounded, and have as many points as vertices.
    "published, on a mesh": lambda bird, _: find_limit_cycle(
        birdmb.RigidModel(bird.with_values({"wing.discretisation": "published"})),
        method="collocation",
    ),
}


@pytest.mark.parametrize("name", CYCLES)
def test_a_cycle_read_back_equals_the_one_saved(name, coarse, sprung, tmp_path):
    saved = CYCLES[name](coarse, sprung)
    saved.save(tmp_path / "cycle.nc")
    found = load_cycle(tmp_path / "cycle.nc")
    different = [
        each.name
        for each in fields(saved)
        if each.name != "model" and not same(getattr(saved, each.name), getattr(found, each.name))
    ]
    assert different == []
    assert type(found.model) is type(saved.model)
    assert found.model.bird == saved.model.bird
    assert found.model.settings() == saved.model.settings()
    assert found.to_xarray().identical(saved.to_xarray())
    assert str(found) == str(saved)


def test_it_continues(cycle, stored):
    found = load_cycle(stored)
    again = find_limit_cycle(found.model, found)
    assert same(again.points, find_limit_cycle(cycle.model, cycle).points)
    assert len(again.iterations) < len(cycle.iterations)


def test_it_is_disturbed_and_drawn_as_before(cycle, stored):
    found, gust = load_cycle(stored), birdmb.GaussianGust(vertical=1.0)
    assert birdmb.gust_response(found, gust).identical(birdmb.gust_response(cycle, gust))
    disturbed = [birdmb.perturbed_flight(each, periods=1) for each in (found, cycle)]
    assert disturbed[0].identical(disturbed[1])
    assert found.plot().axes


def test_every_number_has_units_and_every_variable_a_description(stored):
    with xr.open_dataset(stored, engine="h5netcdf") as data:
        numbers = [name for name, of in data.variables.items() if of.dtype.kind in "fiub"]
        assert len(numbers) > 40
        assert [name for name in numbers if not data[name].attrs.get("units")] == []
        assert [name for name in data.data_vars if not data[name].attrs.get("long_name")] == []
        assert data.attrs["Conventions"].startswith("CF-")
        assert "birdmb" in data.attrs["source"]


def test_the_page_of_files_lists_every_variable(stored):
    page = (TOPOLOGIES.parent / "docs" / "files.md").read_text(encoding="utf-8")
    with xr.open_dataset(stored, engine="h5netcdf") as data:
        assert [name for name in data.data_vars if f"`{name}`" not in page] == []


def test_what_xarray_writes_is_read_too(cycle, tmp_path):
    cycle.to_xarray().to_netcdf(tmp_path / "cycle.nc", engine="h5netcdf")
    assert same(load_cycle(tmp_path / "cycle.nc").points, cycle.points)


def altered(cycle, **attrs):
    return cycle.to_xarray().assign_attrs(attrs)


REFUSED = {
    "another format": ({"format": 99}, "is of format 99"),
    "no kind": ({"birdmb_file": "else"}, "holds no limit cycle"),
    "a branch": ({"birdmb_file": "branch"}, "birdmb.load_branch"),
    "a sweep": ({"birdmb_file": "sweep"}, "holds a sweep"),
    "another bird": ({"fingerprint": "0"}, "not as it was written"),
    "no such model": ({"model": "paper"}, "is damaged"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_foreign_and_other_files_are_refused_with_a_sentence(name, cycle, tmp_path):
    attributes, sentence = REFUSED[name]
    altered(cycle, **attributes).to_netcdf(tmp_path / "cycle.nc", engine="h5netcdf")
    with pytest.raises(DataFileError, match=sentence):
        load_cycle(tmp_path / "cycle.nc")


def test_damage_is_seen(stored, tmp_path):
    content = bytearray(stored.read_bytes())
    content[len(content) // 2] ^= 1
    (tmp_path / "cycle.nc").write_bytes(content)
    with pytest.raises(DataFileError, match="is damaged"):
        load_cycle(tmp_path / "cycle.nc")
    (tmp_path / "text.nc").write_text("mine, not yours")
    with pytest.raises(DataFileError, match="no NetCDF-4 file"):
        load_cycle(tmp_path / "text.nc")
    with pytest.raises(DataFileError, match="cannot be read"):
        load_cycle(tmp_path / "none.nc")


def test_cycles_of_what_is_no_bird_keep_their_numbers(tmp_path):
    model = OdeModel(lambda t, x: np.cos(2 * np.pi * t) - x, ["x"], 1.0)
    found = find_limit_cycle(model, [0.0])
    found.save(tmp_path / "cycle.nc")
    with xr.open_dataset(tmp_path / "cycle.nc", engine="h5netcdf") as data:
        assert data["x0"].values == found.x0
    with pytest.raises(DataFileError, match="no bird"):
        load_cycle(tmp_path / "cycle.nc")
