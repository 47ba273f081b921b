"""The command `birdmb tail-study`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import typer
import xarray as xr

from birdmb.cli.console import messages
from birdmb.cli.drawing import Pictures
from birdmb.cli.files import prepare, reject_overwriting, write_dataset
from birdmb.cli.outcome import InputError
from birdmb.cli.progress import Progress
from birdmb.cli.sweep import SweepProgress, ignored_springs
from birdmb.figures.tail_study import (
    plot_envelope,
    plot_manifold,
    plot_pareto,
    plot_stability_openings,
)
from birdmb.models import RigidModel
from birdmb.quantities import BY_NAME
from birdmb.studies.stability_opening import StabilityOpening, stability_openings
from birdmb.studies.sweeps.executors import named_executor
from birdmb.studies.sweeps.verdicts import jump_lines, short, verdict_lines
from birdmb.studies.tail import OPENING, gait_parameters, tail_study, within_limits
from birdmb.studies.tail_price import PriceOfStability, price_of_stability
from birdmb.studies.trim_defaults import default_parameters
from birdmb.topology import Bird

if TYPE_CHECKING:
    from rich.console import Console

_CURVES = 4


def run(
    bird: Bird,
    store: Path,
    *,
    vary: Mapping[str, Sequence[float]] | None,
    trim: Mapping[str, tuple[float, float]] | None,
    limits: Mapping[str, float],
    every: int,
    workers: int | None,
    executor: str,
    out: Path | None,
    pictures: Pictures,
) -> None:
    """Fill the store, say what it holds, and draw it.

    Raises:
        InputError: a limit of what does not describe flights.
    """
    for name in limits:
        if name not in {*BY_NAME, *(trim or default_parameters(bird, 1))}:
            raise InputError(f"--limit {name}: flights are not described by it.")
    if out is not None:
        prepare(out)
        reject_overwriting(store, out, [f"{store.stem}.nc"])
    console = messages()
    with (
        named_executor(executor, workers) as pool,
        SweepProgress(console, ignored_springs(bird, RigidModel)) as progress,
    ):
        study = tail_study(
            bird,
            store,
            vary,
            trim=trim,
            every=every,
            workers=workers,
            executor=pool,
            on_point=progress.update,
        )
    data = study.to_xarray(timings=True)
    found = data["status"] == "found"
    allowed = within_limits(data, limits)
    stable, undecided = (allowed & (data["stability"] == kind) for kind in ("stable", "undecided"))
    seconds = float(data["seconds"].sum())
    typer.echo(
        f"{store}: {study.total} gaits and openings, {int(found.sum())} of them fly level, "
        f"{int(allowed.sum())} within the limits, {int(stable.sum())} of these stable, "
        f"{int(undecided.sum())} undecided; {study.total / seconds:.2f} flights per second and "
        f"core."
    )
    for line in [*verdict_lines(data), *jump_lines(data)]:
        typer.echo(line)
    climb, error = abs(data["mean_climb_rate"]), data["integration_error"].where(allowed)
    typer.echo(
        f"Level to {float(climb.max()):.1e} m/s; largest error of a beat within the limits "
        f"{float(error.max()):.1e} of the state scale."
    )
    for row in price_of_stability(data, limits=limits):
        typer.echo(priced(row))
    if out is not None:
        with pictures.style():
            _draw(bird, data, store, out, limits, trim, pictures, console)


def _draw(
    bird: Bird,
    data: xr.Dataset,
    store: Path,
    out: Path,
    limits: Mapping[str, float],
    trim: Mapping[str, tuple[float, float]] | None,
    pictures: Pictures,
    console: Console,
) -> None:
    """Write figures and dataset, and say at which openings flight becomes stable."""
    figures = {
        "manifold": plot_manifold(data, limits),
        "envelope": plot_envelope(data, limits=limits),
        "pareto": plot_pareto(data, limits),
    }
    drawing = Progress(console)
    with drawing.shown():
        drawing.doing("tracing the openings at which flight becomes stable")
        curves = _curves(bird, data, trim)
        figures["stability_opening"] = plot_stability_openings(curves, bird.name)
    for name, figure in figures.items():
        for path in pictures.write(out, f"{store.stem}_{name}", figure):
            typer.echo(f"wrote {path}")
    typer.echo(f"wrote {write_dataset(out / f'{store.stem}.nc', data)}")
    for each in curves:
        typer.echo("\n".join(_traced(each)))


def _curves(
    bird: Bird, data: xr.Dataset, trim: Mapping[str, tuple[float, float]] | None
) -> tuple[StabilityOpening, ...]:
    *others, across = gait_parameters(data)
    at = {}
    for name in others:
        values = data[name].values
        at[name] = values[:: max(1, (values.size - 1) // (_CURVES - 1))].tolist()
    openings, range_across = (_ends(data[name].values) for name in (OPENING, across))
    return stability_openings(bird, {across: range_across}, at, openings=openings, trim=trim)


def _ends(values: np.ndarray) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def _traced(each: StabilityOpening) -> list[str]:
    where = f"{each.at} {short(each.value)}: " if each.at else ""
    if not each.curves:
        return [f"{where}no level flight changes stability"]
    lines = []
    for curve in each.curves:
        (a0, b0), (a1, b1) = curve.points[[0, -1]]
        lines.append(
            f"{where}stable beyond {b0:.3f} deg of opening at {each.across} {a0:.4g} to {b1:.3f} "
            f"at {a1:.4g}"
        )
    return lines


def priced(row: PriceOfStability) -> str:
    """The price of stability at a speed, as a sentence."""
    least = f"{row.speed:g} m/s: cost of transport {row.cheapest:.5f} at least"
    if np.isnan(row.opening):
        return f"{least}, and no stable flight"
    return (
        f"{least}, {row.cheapest_stable:.5f} if stable ({row.price:+.2%}), tail open "
        f"{row.opening:.3g} deg"
    )
