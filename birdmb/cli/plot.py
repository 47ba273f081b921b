"""The command `birdmb plot`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import typer

from birdmb.cli.drawing import Pictures
from birdmb.cli.files import prepare, reject_overwriting, write_dataset
from birdmb.studies.sweeps import Study
from birdmb.studies.sweeps.verdicts import jump_lines, verdict_lines
from birdmb.topology import parse_assignment


def run(
    store: Path, quantities: Sequence[str], at: Sequence[str], out: Path, pictures: Pictures
) -> None:
    """Draw the study in `store` into the directory `out`, and write its dataset there."""
    study = Study.open(store)
    fixed = dict(map(parse_assignment, at))
    data_file = f"{store.stem}.nc"
    with pictures.style():
        figures = {
            f"{store.stem}_{name}" if name else store.stem: study.plot(name, at=fixed)
            for name in (quantities or (None,))
        }
        prepare(out)
        files = [file for name in figures for file in pictures.names(name)]
        reject_overwriting(store, out, [*files, data_file])
        for name, figure in figures.items():
            for path in pictures.write(out, name, figure):
                typer.echo(f"wrote {path}")
    dataset = study.to_xarray(timings=True)
    for line in [*verdict_lines(dataset), *jump_lines(dataset)]:
        typer.echo(line)
    typer.echo(f"wrote {write_dataset(out / data_file, dataset)}")
