"""The files that `birdmb cycle --out` writes; each is whole or not there."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from birdmb.cli.outcome import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from birdmb.cli.progress import Progress
    from birdmb.models import FlightCycle

_DPI = 150


def prepare(directory: Path) -> None:
    """Make the directory and see that files can be written there, before hours of computing.

    Raises:
        InputError: it cannot be made, or not be written into.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        probe = _draft(directory / "probe")
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise _unwritable(directory, error) from error


def remove_drafts(directory: Path) -> None:
    """Remove what an interruption left half-written."""
    for draft in directory.glob(f".*.{os.getpid()}.*"):
        draft.unlink(missing_ok=True)


def write_results(cycle: FlightCycle, directory: Path, progress: Progress) -> list[Path]:
    """Write `cycle.nc` and the figures into a directory; return what was written."""
    progress.doing("writing cycle.nc")
    written = [
        write_whole(
            directory / "cycle.nc",
            lambda draft: cycle.to_xarray().to_netcdf(draft, engine="h5netcdf"),
        )
    ]
    from birdmb import figures  # noqa: PLC0415 - takes a second

    drawings: dict[str, Callable[[FlightCycle], Figure]] = {
        "states.png": figures.states,
        "multipliers.png": figures.multipliers,
        "loads.png": figures.loads_and_power,
        "wing.png": figures.wing_phases,
        "overview.png": figures.overview,
    }
    for name, draw in drawings.items():
        progress.doing(f"drawing {name}")
        save = partial(draw(cycle).savefig, dpi=_DPI, format="png")
        written.append(write_whole(directory / name, save))
    return written


def write_whole(path: Path, write: Callable[[Path], object]) -> Path:
    """Let `write` write a draft beside `path`, and put it in its place once it is whole."""
    draft = _draft(path)
    try:
        write(draft)
        draft.replace(path)
    except OSError as error:
        raise _unwritable(path, error) from error
    finally:
        draft.unlink(missing_ok=True)
    return path


def _draft(path: Path) -> Path:
    return path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")


def _unwritable(path: Path, error: OSError) -> InputError:
    reason = (error.strerror or str(error)).lower()
    return InputError(f"--out: {path} cannot be written ({reason}).")
