"""The command `birdmb plot`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import typer

from birdmb.cli.drawing import plain_style
from birdmb.cli.files import prepare, reject_overwriting, write_dataset, write_figure
from birdmb.studies.sweeps import Study
from birdmb.studies.sweeps.verdicts import jump_lines, verdict_lines
from birdmb.topology import parse_assignment


def run(store: Path, quantities: Sequence[str], at: Sequence[str], out: Path) -> None:
    """Draw the study in `store` into the directory `out`, and write its dataset there."""
    study = Study.open(store)
    fixed = dict(map(parse_assignment, at))
    data_file = f"{store.stem}.nc"
    with plain_style():
        figures = {
            f"{store.stem}_{name}.png" if name else f"{store.stem}.png": study.plot(name, at=fixed)
            for name in (quantities or (None,))
        }
        prepare(out)
        reject_overwriting(store, out, [*figures, data_file])
        for name, figure in figures.items():
            typer.echo(f"wrote {write_figure(out / name, figure)}")
    dataset = study.to_xarray(timings=True)
    for line in [*verdict_lines(dataset), *jump_lines(dataset)]:
        typer.echo(line)
    typer.echo(f"wrote {write_dataset(out / data_file, dataset)}")
