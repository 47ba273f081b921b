"""The command `birdmb plot`."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import typer

from birdmb.cli.drawing import plain_style
from birdmb.cli.files import prepare, write_whole
from birdmb.studies.sweeps import Study
from birdmb.topology import parse_assignment

_DPI = 150


def run(store: Path, quantities: Sequence[str], at: Sequence[str], out: Path) -> None:
    """Draw the study in `store` into the directory `out`, and write its dataset there."""
    study = Study.open(store)
    fixed = dict(map(parse_assignment, at))
    with plain_style():
        figures = {
            f"{store.stem}_{name}.png" if name else f"{store.stem}.png": study.plot(name, at=fixed)
            for name in (quantities or (None,))
        }
        prepare(out)
        for name, figure in figures.items():
            save = partial(figure.savefig, dpi=_DPI, format="png")
            typer.echo(f"wrote {write_whole(out / name, save)}")
    dataset = study.to_xarray(timings=True)
    save = partial(dataset.to_netcdf, engine="h5netcdf")
    typer.echo(f"wrote {write_whole(out / f'{store.stem}.nc', save)}")
