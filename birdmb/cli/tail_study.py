"""The command `birdmb tail-study`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import typer
import xarray as xr

from birdmb.cli.console import messages
from birdmb.cli.drawing import plain_style
from birdmb.cli.files import prepare, reject_overwriting, write_dataset, write_figure
from birdmb.cli.progress import Progress
from birdmb.cli.sweep import SweepProgress, ignored_springs
from birdmb.figures.tail_study import (
    plot_envelope,
    plot_manifold,
    plot_pareto,
    plot_stability_openings,
)
from birdmb.models import RigidModel
from birdmb.studies.sweeps.verdicts import jump_lines, verdict_lines
from birdmb.studies.tail import (
    SWEEP,
    PriceOfStability,
    price_of_stability,
    stability_openings,
    tail_study,
    within_rules,
)
from birdmb.studies.validity import LARGEST_TAIL_ANGLE
from birdmb.topology import Bird

if TYPE_CHECKING:
    from rich.console import Console

_CURVES = 4


def run(bird: Bird, store: Path, *, every: int, workers: int | None, out: Path | None) -> None:
    """Fill the store, say what it holds, and draw it."""
    if out is not None:
        prepare(out)
        reject_overwriting(store, out, [f"{store.stem}.nc"])
    console = messages()
    with SweepProgress(console, ignored_springs(bird, RigidModel)) as progress:
        study = tail_study(bird, store, every=every, workers=workers, on_point=progress.update)
    data = study.to_xarray(timings=True)
    found = data["status"] == "found"
    allowed = within_rules(data)
    stable, undecided = (allowed & (data["stability"] == kind) for kind in ("stable", "undecided"))
    seconds = float(data["seconds"].sum())
    typer.echo(
        f"{store}: {study.total} gaits and openings, {int(found.sum())} of them fly level, "
        f"{int(allowed.sum())} within the rules, {int(stable.sum())} of these stable, "
        f"{int(undecided.sum())} undecided; {study.total / seconds:.2f} flights per second and "
        f"core."
    )
    for line in [*verdict_lines(data), *jump_lines(data)]:
        typer.echo(line)
    beyond = stable & (data["largest_tail_angle"] > LARGEST_TAIL_ANGLE)
    climb, error = abs(data["mean_climb_rate"]), data["integration_error"].where(allowed)
    typer.echo(
        f"Level to {float(climb.max()):.1e} m/s; largest error of a beat within the rules "
        f"{float(error.max()):.1e} of the state scale; {int(beyond.sum())} of the stable flights "
        f"have the tail beyond {np.degrees(LARGEST_TAIL_ANGLE):g} deg."
    )
    for row in price_of_stability(data):
        typer.echo(_priced(row))
    if out is not None:
        with plain_style():
            _draw(bird, data, store, out, console)


def _draw(bird: Bird, data: xr.Dataset, store: Path, out: Path, console: Console) -> None:
    """Write figures and dataset, and say at which openings flight becomes stable."""
    figures = {
        "manifold": plot_manifold(data),
        "envelope": plot_envelope(data),
        "pareto": plot_pareto(data),
    }
    drawing = Progress(console)
    with drawing.shown():
        drawing.doing("tracing the openings at which flight becomes stable")
        values = data[SWEEP].values
        picked = values[:: max(1, (values.size - 1) // (_CURVES - 1))]
        curves = stability_openings(bird, picked.tolist())
        figures["stability_opening"] = plot_stability_openings(curves, bird.name)
    for name, figure in figures.items():
        typer.echo(f"wrote {write_figure(out / f'{store.stem}_{name}.png', figure)}")
    typer.echo(f"wrote {write_dataset(out / f'{store.stem}.nc', data)}")
    for each in curves:
        for curve in each.curves:
            (a0, b0), (a1, b1) = curve.points[[0, -1]]
            typer.echo(
                f"sweep offset {each.sweep:g}: stable beyond {b0:.3f} deg of opening at amplitude "
                f"{a0:.2f} to {b1:.3f} at {a1:.2f}"
            )
        if not each.curves:
            typer.echo(f"sweep offset {each.sweep:g}: no level flight changes stability")


def _priced(row: PriceOfStability) -> str:
    least = f"{row.slowest:g} to {row.fastest:g} m/s: cost of transport {row.cheapest:.5f} at least"
    if np.isnan(row.opening):
        return f"{least}, and no stable flight"
    more = row.cheapest_stable / row.cheapest - 1.0
    return (
        f"{least}, {row.cheapest_stable:.5f} if stable ({more:+.2%}), tail open {row.opening:g} deg"
    )
