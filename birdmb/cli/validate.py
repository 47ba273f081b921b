"""The command `birdmb validate`."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import asdict

import typer
from rich.console import Console

from birdmb.cli.console import messages, output
from birdmb.cli.outcome import InputError
from birdmb.cli.progress import Progress, at_work
from birdmb.cli.tables import table_of
from birdmb.reproduction import page
from birdmb.reproduction.cases import published_cases
from birdmb.reproduction.published import Comparison, compare

DISAGREES = 1
_STYLES = {"pass": "green", "differs": "yellow", "contradicts": "magenta"}


def run(chapter: str | None, *, long: bool, as_json: bool, as_markdown: bool) -> None:
    """Compute the published cases with the birds of the package and print both side by side."""
    if as_json and as_markdown:
        raise InputError("--json and --markdown are two forms of the same; give one of them.")
    console, progress = output(), Progress(messages())
    cases = published_cases(chapter, long=long)
    found: list[Comparison] = []
    progress.line(f"computing {len(cases)} published cases")
    for case in cases:
        with at_work(progress):
            progress.doing(case.source)
            compared = compare(case)
        found += compared
        if not (as_json or as_markdown):
            _print(console, compared)
    failing = [one for one in found if one.fails]
    if as_json:
        json.dump(_as_object(found), sys.stdout, indent=2, allow_nan=False)
        typer.echo()
    elif as_markdown:
        typer.echo(page.as_markdown(found))
    else:
        _summarise(console, found, failing)
    if failing:
        raise typer.Exit(DISAGREES)


def _as_object(found: Sequence[Comparison]) -> dict[str, object]:
    return {
        "agrees": not any(one.fails for one in found),
        "comparisons": [
            asdict(one) | {"difference": one.difference, "verdict": one.verdict, "fails": one.fails}
            for one in found
        ],
    }


def _print(console: Console, compared: Sequence[Comparison]) -> None:
    first = compared[0]
    console.print()
    if first.failure:
        console.print(f"{first.source}\n  nothing computed: {first.failure}", style="yellow")
    else:
        columns = ("quantity", "published", "computed", "difference", "tolerance", "verdict")
        table = table_of(first.source, *columns, numbers=(1, 2, 3, 4))
        table.columns[5].no_wrap = True
        for one in compared:
            table.add_row(
                page.with_unit(one),
                f"{one.published:.10g}",
                page.computed(one),
                f"{one.difference:+.2g}",
                f"{one.tolerance:.2g}",
                one.verdict,
                style="bold red" if one.fails else _STYLES[one.verdict],
            )
        console.print(table)
    for reason in dict.fromkeys(one.reason for one in compared if one.reason):
        console.print(f"  {reason}", soft_wrap=True, highlight=False)
    console.print(f"  {first.command}", style="dim", soft_wrap=True, highlight=False)


def _summarise(
    console: Console, found: Sequence[Comparison], failing: Sequence[Comparison]
) -> None:
    counts = [f"{sum(one.verdict == verdict for one in found)} {verdict}" for verdict in _STYLES]
    console.print(f"\n{len(found)} numbers: {', '.join(counts)}")
    for one in failing:
        console.print(f"should agree: {one.source}, {one.quantity}", style="bold red")
