"""Branch files: whole or as they were, of this format and version, never believed when damaged."""

import errno
import os
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import birdmb.provenance
from birdmb.errors import OutputError
from birdmb.orbits import (
    ArgumentError,
    BranchFileError,
    BranchStopped,
    Steps,
    continue_branch,
    load_branch,
)
from birdmb.seal import sealed, unsealed


class Decay:
    """x' = p (1 - x), whose flow costs next to nothing."""

    state_names, period = ("x",), 1.0

    def __init__(self, rate):
        self.rate = rate
        self.state_scale = np.ones(1)

    def flow(self, x0, t0, t1):
        return 1 + np.exp(-self.rate * (t1 - t0)) * (x0 - 1)


def follow(**options):
    return continue_branch(Decay, (2.0, 3.0), [0.9], steps=Steps(first=0.2, longest=0.4), **options)


def one(_cycle):
    return 1.0


@pytest.fixture(scope="module")
def short():
    return follow(settings={"system": "linear", "speed": 0.2})


@pytest.fixture
def stored(short, tmp_path):
    short.save(tmp_path / "branch.nc")
    return tmp_path / "branch.nc"


def test_every_point_is_saved_before_it_is_told(tmp_path):
    path, seen = tmp_path / "branch.nc", []

    def told(point):
        seen.append(point.parameter)
        kept = load_branch(path)
        assert list(kept.parameters) == seen
        assert kept.stopped.reason == "the run was interrupted"
        assert [file.name for file in tmp_path.iterdir()] == ["branch.nc"]

    assert len(follow(store=path, callback=told).points) == len(seen) > 3
    assert load_branch(path).stopped is None


def test_other_programs_read_it(stored, short):
    with xr.open_dataset(stored, engine="h5netcdf") as data:
        assert list(data["parameter"].values) == list(short.parameters)
        assert data.attrs["format"] == 4
        assert birdmb.provenance.software()["numpy"] in data.attrs["software"]


def damaged(whole):
    """Names and contents of some hundred files that a branch file may have become."""
    yield "empty", b""
    yield "text", b"mine, not yours"
    yield "zeros", bytes(len(whole))
    yield "no seal", unsealed(whole)
    yield "HDF5 head alone", whole[:512]
    yield "two files", whole + whole
    yield "a line added", whole + b"\n"
    yield "end lost, seal kept", unsealed(whole)[:-100] + whole[-79:]
    yield "sealed text", sealed(b"mine, not yours")
    yield "sealed nothing", sealed(b"")
    for share in range(1, 40):
        yield f"truncated at {share}/40", whole[: len(whole) * share // 40]
    chance = np.random.default_rng(0)
    for place in chance.integers(0, len(whole), 60):
        yield f"bit at {place}", whole[:place] + bytes([whole[place] ^ 4]) + whole[place + 1 :]


def test_damaged_files_are_refused_in_a_sentence(stored):
    whole = stored.read_bytes()
    count = 0
    for name, content in damaged(whole):
        stored.write_bytes(content)
        with pytest.raises(BranchFileError) as caught:
            load_branch(stored)
        sentence = str(caught.value)
        assert str(stored) in sentence, name
        assert "\n" not in sentence, name
        count += 1
    assert count > 80


@pytest.mark.parametrize(
    "change",
    [
        lambda data: data.drop_vars("tangent"),
        lambda data: data.drop_vars("state"),
        lambda data: data.isel(state=slice(0)),
        lambda data: data.isel(point=slice(0)),
        lambda data: data.assign_attrs(software="{"),
        lambda data: data.assign_attrs(start_time="soon"),
        lambda _: xr.Dataset(attrs={"format": 4}),
    ],
)
def test_what_is_no_branch_inside_is_refused(short, stored, change):
    stored.write_bytes(sealed(bytes(change(short.to_xarray()).to_netcdf(engine="h5netcdf"))))
    with pytest.raises(BranchFileError, match="is damaged"):
        load_branch(stored)


def test_other_formats_are_refused(short, stored):
    for form in (3, 5, "old"):
        data = short.to_xarray().assign_attrs(format=form)
        stored.write_bytes(sealed(bytes(data.to_netcdf(engine="h5netcdf"))))
        with pytest.raises(BranchFileError, match=f"of format {form}; this birdmb reads"):
            load_branch(stored)


def test_places_that_are_no_files(tmp_path):
    for place in (tmp_path, tmp_path / "nothing.nc", tmp_path / "no\0name.nc"):
        with pytest.raises(BranchFileError, match="cannot be read"):
            load_branch(place)


def test_another_version_of_birdmb_is_not_resumed(monkeypatch):
    begun = follow(max_points=2)
    monkeypatch.setattr(
        "birdmb.provenance.version", lambda name: "99.0" if name == "birdmb" else "1.0"
    )
    with pytest.raises(ArgumentError, match=r"computed by birdmb .*, this is 99\.0: resume it"):
        follow(resume=begun)


def test_other_versions_of_libraries_are_kept_in_order(monkeypatch):
    begun = follow(max_points=2)
    now = birdmb.provenance.software()
    monkeypatch.setattr(
        "birdmb.provenance.version", lambda name: "9.9" if name == "scipy" else now[name]
    )
    resumed = follow(resume=begun)
    assert resumed.software == now | {"scipy": f"{now['scipy']}, 9.9"}
    assert follow(resume=resumed).software == resumed.software


def test_names_that_no_file_can_keep_are_refused_before_the_computing():
    def never(_period):
        raise AssertionError("computed")

    def refused(match, **options):
        with pytest.raises(ArgumentError, match=match):
            continue_branch(never, (2.0, 3.0), **options)

    refused("cannot have a slash", observables={"lift/drag": one})
    refused("null character", observables={"lift\0": one})
    refused("null character", parameter_name="p\0")
    refused("null character", settings={"bird": "ibis\0"})
    refused("characters that are none", settings={"bird": "\ud800"})


def test_names_of_all_kinds_survive_and_are_drawn(tmp_path):
    name = "a [b] $x^ <&> \n 'q' \\ ü"
    branch = follow(
        max_points=2, parameter_name=name, settings={name: name}, observables={name: one}
    )
    branch.save(tmp_path / "branch.nc")
    kept = load_branch(tmp_path / "branch.nc")
    assert kept.parameter_name == name
    assert kept.settings == {name: name}
    assert list(kept.values(name)) == [1.0, 1.0]
    kept.plot(name).savefig(tmp_path / "branch.png")


def test_reasons_with_control_characters_do_not_cost_the_branch(short, tmp_path):
    stopped = BranchStopped("the step became too small", 2.5, "so\0 it\n went")
    replace(short, stopped=stopped).save(tmp_path / "branch.nc")
    assert load_branch(tmp_path / "branch.nc").stopped.detail == "so\ufffd it went"


def test_a_full_disk_ends_in_a_sentence_and_keeps_the_older_file(short, stored):
    resource = pytest.importorskip("resource")
    before, limits = stored.read_bytes(), resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, limits[1]))
    try:
        with pytest.raises(OutputError) as caught:
            short.save(stored)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    reason = os.strerror(errno.EFBIG).lower()
    assert str(caught.value) == (
        f"{stored} cannot be written ({reason}; free some space and try again)."
    )
    assert stored.read_bytes() == before
    assert [file.name for file in stored.parent.iterdir()] == ["branch.nc"]


def test_a_store_that_cannot_be_written_is_said(tmp_path):
    with pytest.raises(OutputError, match="cannot be written"):
        follow(store=tmp_path / "nowhere" / "branch.nc")
