"""The command `birdmb validate --experiments`."""

from __future__ import annotations

import json
import sys

import typer
from rich.console import Console

from birdmb.cli.console import messages, output
from birdmb.cli.progress import Progress
from birdmb.cli.tables import table_of
from birdmb.studies.experiments.cases import experiments
from birdmb.studies.experiments.comparison import (
    ATTACHED,
    MODELS,
    WITH_APPARENT_MASS,
    Comparison,
    Experiment,
)

_NOTHING = "-"
_HEADINGS = {WITH_APPARENT_MASS: "and apparent\nmass", ATTACHED: "attached"}


def run(case: str | None, *, as_json: bool) -> None:
    """Compute all experiments, or one, and print measurements and computations side by side."""
    console, progress = output(), Progress(messages())
    chosen = experiments(case)
    found: list[dict[str, object]] = []
    with progress.shown():
        for experiment in chosen:
            progress.line(f"computing case {experiment.case}: {experiment.title}")
            compared = list(experiment.compare())
            found += [one.as_object() | {"source": experiment.source} for one in compared]
            if not as_json:
                _print(console, experiment, compared)
    if as_json:
        json.dump(found, sys.stdout, indent=2, allow_nan=False)
        typer.echo()


def _print(console: Console, experiment: Experiment, compared: list[Comparison]) -> None:
    attached = any(ATTACHED in one.computed for one in compared)
    models = [name for name in MODELS if name != ATTACHED or attached]
    columns = ("quantity", "measured", *(_HEADINGS.get(name, name) for name in models))
    title = f"{experiment.case}: {experiment.title} ({experiment.source})"
    table = table_of(title, *columns, numbers=tuple(range(1, len(columns))))
    table.columns[0].no_wrap = False
    for one in compared:
        cells = (one.computed.get(name) for name in models)
        table.add_row(
            f"{one.quantity}, {one.unit}" if one.unit else one.quantity,
            f"{one.measured:.4g}",
            *(_NOTHING if value is None else f"{value:.4g}" for value in cells),
        )
    console.print()
    console.print(table)
    for one in compared:
        for name, value in one.others.items():
            console.print(f"  {one.quantity}, {name}: {value:g}", soft_wrap=True, highlight=False)
        if one.failure:
            console.print(f"  {one.quantity}: {one.failure}", style="yellow", soft_wrap=True)
