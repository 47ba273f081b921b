"""The files that commands write, and the directories that they write into."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from birdmb.cli.outcome import InputError
from birdmb.errors import OutputError
from birdmb.files import make_directory, netcdf_bytes, write_whole

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from birdmb.cli.drawing import Pictures
    from birdmb.cli.progress import Progress
    from birdmb.models import FlightCycle


def prepare(directory: Path, option: str = "--out") -> None:
    """Make the directory of an option and see that files can be written there.

    Raises:
        InputError: it cannot be made, or not be written into.
    """
    try:
        make_directory(directory)
    except OutputError as error:
        raise InputError(f"{option}: {error}") from error


def reject_overwriting(store: Path, out: Path, names: Iterable[str]) -> None:
    """Refuse to write files into a directory, one of which is the store that they are made of.

    Raises:
        InputError: one of the names is that of the store.
    """
    for name in names:
        if (out / name).resolve() == store.resolve():
            raise InputError(
                f"--out: {out / name} is the study itself and would be written over; give another "
                f"directory."
            )


def write_dataset(path: Path, dataset: xr.Dataset) -> Path:
    """Write a dataset as NetCDF."""
    return write_whole(path, netcdf_bytes(dataset))


def write_results(
    cycle: FlightCycle, directory: Path, pictures: Pictures, progress: Progress
) -> list[Path]:
    """Write `cycle.nc` and the figures into a directory; return what was written."""
    progress.doing("writing cycle.nc")
    cycle.save(directory / "cycle.nc")
    written = [directory / "cycle.nc"]
    from birdmb import figures  # noqa: PLC0415 - takes a second

    drawings: dict[str, Callable[[FlightCycle], Figure]] = {
        "states": figures.plot_states,
        "multipliers": figures.plot_multipliers,
        "loads": figures.plot_loads_and_power,
        "wing": figures.plot_wing_phases,
        "overview": figures.plot_overview,
    }
    for name, draw in drawings.items():
        progress.doing(f"drawing {name}")
        with pictures.style():
            written += pictures.write(directory, name, draw(cycle))
    return written
