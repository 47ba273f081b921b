"""Executors by name: processes of this computer, a Dask cluster, or the ranks of an MPI job."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from importlib import import_module
from typing import Any
from urllib.parse import urlsplit

from birdmb.errors import ArgumentError

NAMES = "processes, dask, dask://HOST:PORT or mpi"
_DASK = "dask://"
_PATIENCE = 10.0  # s, for a scheduler to answer


@contextmanager
def named_executor(name: str, workers: int | None = None) -> Iterator[Executor | None]:
    """The executor that a name stands for; `None` of "processes", which a sweep makes itself.

    Of the ranks of an MPI job the first gets the executor. The others compute what it hands out,
    and end in `SystemExit` when the first is done.

    Args:
        name: "processes"; "dask", a cluster of this computer's own; "dask://HOST:PORT", one whose
            scheduler is there; or "mpi", the job in which all ranks call this.
        workers: how many processes, for those that this computer starts; by default one a core.

    Raises:
        ArgumentError: no such name, an address without host or port, workers of a cluster that
            has its own, a package that is not installed, a scheduler that does not answer, or an
            MPI job of one rank.
    """
    if workers is not None and name not in {"processes", "dask"}:
        raise ArgumentError(
            f"executor: {name} has workers of its own; leave out their number ({workers})."
        )
    if name == "processes":
        yield None
    elif name == "dask" or name.startswith(_DASK):
        with _on_dask(_address(name) if name != "dask" else None, workers) as executor:
            yield executor
    elif name == "mpi":
        with _on_mpi() as executor:
            yield executor
    else:
        raise ArgumentError(f'executor must be {NAMES}, not "{name}".')


@contextmanager
def _on_dask(address: str | None, workers: int | None) -> Iterator[Executor]:
    try:
        dask: Any = import_module("dask.distributed")
    except ImportError as error:
        raise _missing("Dask", "dask") from error
    if address is None:
        count = workers or os.cpu_count() or 1
        with (
            dask.LocalCluster(
                n_workers=count, threads_per_worker=1, dashboard_address=None
            ) as cluster,
            dask.Client(cluster) as client,
        ):
            yield client.get_executor()
        return
    try:
        asyncio.run(_greeted(f"tcp://{address}"))
        client = dask.Client(f"tcp://{address}", timeout=_PATIENCE)
    except (OSError, ValueError, TypeError) as error:
        raise ArgumentError(
            f"executor: no Dask scheduler answers at {address} within {_PATIENCE:.0f} s; start one "
            f"with `dask scheduler` and workers with `dask worker {address}`, where birdmb is "
            f"installed."
        ) from error
    with client:
        yield client.get_executor()


def _address(name: str) -> str:
    try:
        parts = urlsplit(name)
        complete = bool(parts.hostname and parts.port) and name == f"{_DASK}{parts.netloc}"
    except ValueError:  # a port that is no number, or above 65535
        complete = False
    if not complete:
        raise ArgumentError(
            f'executor must name host and port, as in dask://127.0.0.1:8786, not "{name}".'
        )
    return parts.netloc


async def _greeted(address: str) -> None:
    """Connect once: Dask's client bounds the connection, but not the wait for a greeting."""
    comm: Any = import_module("distributed.comm")
    async with asyncio.timeout(_PATIENCE):
        connection = await comm.connect(address, timeout=_PATIENCE)
    connection.abort()


@contextmanager
def _on_mpi() -> Iterator[Executor]:
    try:
        job: Any = import_module("mpi4py.MPI").COMM_WORLD
        futures: Any = import_module("mpi4py.futures")
    except (ImportError, RuntimeError) as error:  # the package, or the library of MPI
        raise _missing("MPI", "mpi") from error
    if job.size == 1:
        raise ArgumentError(
            "executor: an MPI job of one rank has nobody to compute; start it with more, as in "
            "`mpiexec -n 4 birdmb sweep ... --executor mpi`."
        )
    with futures.MPICommExecutor(job, root=0) as executor:
        if executor is not None:
            yield executor
    if executor is None:
        raise SystemExit(0)


def _missing(what: str, extra: str) -> ArgumentError:
    return ArgumentError(
        f"executor: {what} is not installed here; `pip install 'birdmb[{extra}]'` brings it"
        f"{', beside an MPI of the machine' if extra == 'mpi' else ''}."
    )
