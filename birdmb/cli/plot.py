"""The command `birdmb plot`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from birdmb.cli.drawing import Pictures
from birdmb.cli.files import prepare, reject_overwriting, write_dataset
from birdmb.cli.outcome import InputError
from birdmb.datafiles import is_netcdf, kind_of, read_dataset
from birdmb.models import load_cycle
from birdmb.orbits import load_branch
from birdmb.studies.sweeps import Study
from birdmb.studies.sweeps.verdicts import jump_lines, verdict_lines
from birdmb.topology import parse_assignment

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_Draw = Callable[[str | None], "Figure"]


def run(
    file: Path, quantities: Sequence[str], at: Sequence[str], out: Path, pictures: Pictures
) -> None:
    """Draw the study, branch or cycle in `file` into the directory `out`.

    Of a study's store the dataset is written there, too.
    """
    fixed = dict(map(parse_assignment, at))
    if is_netcdf(file):
        _write(file, _of_dataset(file, quantities, fixed), quantities, (out, []), pictures)
        return
    study = Study.open(file)
    data_file = f"{file.stem}.nc"
    _write(file, partial(study.plot, at=fixed), quantities, (out, [data_file]), pictures)
    dataset = study.to_xarray(timings=True)
    for line in [*verdict_lines(dataset), *jump_lines(dataset)]:
        typer.echo(line)
    typer.echo(f"wrote {write_dataset(out / data_file, dataset)}")


def _write(
    file: Path,
    draw: _Draw,
    quantities: Sequence[str],
    to: tuple[Path, Sequence[str]],
    pictures: Pictures,
) -> None:
    """Write figures to a directory, in which `to` says that other files will be written, too."""
    out, others = to
    with pictures.style():
        figures = {
            f"{file.stem}_{name}" if name else file.stem: draw(name)
            for name in (quantities or (None,))
        }
        prepare(out)
        names = [path for stem in figures for path in pictures.names(stem)]
        reject_overwriting(file, out, [*names, *others])
        for stem, figure in figures.items():
            for path in pictures.write(out, stem, figure):
                typer.echo(f"wrote {path}")


def _of_dataset(file: Path, quantities: Sequence[str], fixed: Mapping[str, Any]) -> _Draw:
    """The drawing of a NetCDF file; raises `InputError` where an option is not of its kind."""
    data = read_dataset(file)
    kind = kind_of(data)
    if kind is None:
        raise InputError(
            f"{file} holds no limit cycle, branch or sweep of birdmb; give the cycle.nc of `birdmb "
            f"cycle --out`, the file of a branch or the store of a sweep."
        )
    if fixed and kind != "sweep":
        raise InputError(f"--at fixes a parameter of a sweep; {file} holds a {kind}.")
    if kind == "sweep":
        from birdmb.figures import plot_sweep  # noqa: PLC0415 - takes a second

        return lambda name: plot_sweep(data, name, fixed)
    if kind == "branch":
        branch = load_branch(file)
        known = [*branch.state_names, "period", *branch.points[0].observables]
        for name in quantities:
            if name not in known:
                raise InputError(
                    f"--quantity: the branch in {file} has no {name}; it has {', '.join(known)}."
                )
        return branch.plot
    if quantities:
        raise InputError(f"--quantity is of sweeps and branches; {file} holds a limit cycle.")
    cycle = load_cycle(file)
    return lambda _name: cycle.plot()
