"""The command `birdmb validate`."""

from __future__ import annotations

from rich.console import Console

from birdmb.cli.console import messages, output
from birdmb.cli.progress import Progress
from birdmb.cli.report import table_of
from birdmb.studies.validation import Comparison, compare, published_cases


def run() -> None:
    """Compute the published cases with the birds of the package and print both side by side."""
    console, progress = output(), Progress(messages())
    cases = published_cases()
    with progress.shown():
        progress.line(f"computing {len(cases)} published cases")
        for comparison in compare(cases):
            _print(console, comparison)


def _print(console: Console, comparison: Comparison) -> None:
    case = comparison.case
    console.print()
    if comparison.failure:
        console.print(f"{case.source}\n  nothing computed: {comparison.failure}", style="yellow")
    else:
        columns = ("quantity", "published", "computed", "difference")
        table = table_of(case.source, *columns, numbers=(1, 2, 3))
        for quantity, published in case.published.items():
            table.add_row(
                quantity,
                f"{published:g}",
                f"{comparison.computed[quantity]:.6g}",
                f"{comparison.difference(quantity):+.2g}",
            )
        console.print(table)
    console.print(f"  {case.command}", style="dim", soft_wrap=True, highlight=False)
