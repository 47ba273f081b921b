"""Sweeps on a Dask cluster and on the ranks of an MPI job, asked for by their names."""

import re
import shutil
import socket
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from typer.testing import CliRunner

import birdmb
from birdmb.cli.app import app
from birdmb.studies.sweeps.executors import named_executor

from .sweeping import TOPOLOGIES

SWEEP = [
    "sweep", str(TOPOLOGIES / "ibis.toml"), "--model", "rigid", "--set", "wing.discretisation=4",
    "--vary", "body.mass=1.2,1.25,1.3", "--store",
]  # fmt: skip


@pytest.fixture(scope="module")
def on_processes(tmp_path_factory):
    store = tmp_path_factory.mktemp("processes") / "study.db"
    done = CliRunner().invoke(app, [*SWEEP, str(store), "--workers", "1"])
    assert done.exit_code == 0, done.output
    return birdmb.Study.open(store).to_xarray()


def run(tmp_path, executor, *before):
    store = tmp_path / "study.db"
    command = [sys.executable, "-m", "birdmb", *SWEEP, str(store), "--executor", executor]
    done = subprocess.run([*before, *command], capture_output=True, text=True, check=False)
    return done, store


@pytest.mark.long
def test_dask_gives_the_same_bits(tmp_path, on_processes):
    dask = pytest.importorskip("dask.distributed")
    with (
        dask.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster,
    ):
        address = cluster.scheduler_address.removeprefix("tcp://")
        done, store = run(tmp_path, f"dask://{address}")
    assert done.returncode == 0, done.stderr
    assert birdmb.Study.open(store).to_xarray().identical(on_processes)


@pytest.mark.long
def test_mpi_gives_the_same_bits(tmp_path, on_processes):
    # Beside this Python, where packages of MPI put it, first: no directory of PATH need be its.
    here = str(Path(sys.executable).parent)
    mpiexec = shutil.which("mpiexec", path=here) or shutil.which("mpiexec")
    if mpiexec is None or find_spec("mpi4py") is None:
        pytest.skip("there is no MPI here, or no mpi4py")
    done, store = run(tmp_path, "mpi", mpiexec, "-n", "2")
    assert done.returncode == 0, done.stderr
    assert birdmb.Study.open(store).to_xarray().identical(on_processes)


@pytest.mark.parametrize(
    ("name", "workers", "expected"),
    [
        ("slurm", None, 'executor must be processes, dask, dask://HOST:PORT or mpi, not "slurm".'),
        ("mpi", 3, "executor: mpi has workers of its own; leave out their number (3)."),
        ("dask://127.0.0.1:1", 2, "dask://127.0.0.1:1 has workers of its own"),
        ("dask://", None, 'as in dask://127.0.0.1:8786, not "dask://".'),
        ("dask://here", None, 'not "dask://here".'),
        ("dask://here:port", None, 'not "dask://here:port".'),
        ("dask://here:99999", None, 'not "dask://here:99999".'),
        ("dask://tcp://here:1", None, 'not "dask://tcp://here:1".'),
    ],
)
def test_wrong_names_are_one_sentence(name, workers, expected):
    with (
        pytest.raises(birdmb.ArgumentError, match=re.escape(expected)),
        named_executor(name, workers),
    ):
        pass


@pytest.mark.parametrize("name", ["dask", "mpi"])
def test_what_is_not_installed_is_named(monkeypatch, name):
    for module in ("dask.distributed", "mpi4py.MPI"):
        monkeypatch.setitem(sys.modules, module, None)
    with (
        pytest.raises(birdmb.ArgumentError, match=rf"`pip install 'birdmb\[{name}\]'` brings it"),
        named_executor(name),
    ):
        pass


def test_a_scheduler_that_does_not_answer_is_named(monkeypatch):
    pytest.importorskip("dask.distributed")
    monkeypatch.setattr("birdmb.studies.sweeps.executors._PATIENCE", 0.5)
    with (
        pytest.raises(birdmb.ArgumentError, match=r"no Dask scheduler answers at 127.0.0.1:1 "),
        named_executor("dask://127.0.0.1:1"),
    ):
        pass


def test_what_takes_connections_and_says_nothing_is_named(monkeypatch):
    pytest.importorskip("dask.distributed")
    monkeypatch.setattr("birdmb.studies.sweeps.executors._PATIENCE", 0.5)
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        address = f"127.0.0.1:{silent.getsockname()[1]}"
        with (
            pytest.raises(birdmb.ArgumentError, match=f"no Dask scheduler answers at {address} "),
            named_executor(f"dask://{address}"),
        ):
            pass
