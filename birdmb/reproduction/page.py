"""The comparisons as the tables of docs/thesis.md."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import groupby

from birdmb.reproduction.published import Comparison, Published

HEADINGS = ("where", "quantity", "printed", "computed", "verdict", "why")


def title_of(chapter: str) -> str:
    """Name of a chapter or an appendix."""
    return f"Chapter {chapter}" if chapter.isdigit() else f"Appendix {chapter}"


def with_unit(number: Published | Comparison) -> str:
    """Name of a quantity with its unit."""
    return f"{number.quantity}, {number.unit}" if number.unit else number.quantity


def start_of_row(source: str, number: Published | Comparison, printed: float) -> str:
    """The cells of a row that say what is printed."""
    return f"| {_cell(source)} | {_cell(with_unit(number))} | {printed:.10g} |"


def computed(one: Comparison) -> str:
    """The computed number to a tenth of the tolerance."""
    if one.computed is None:
        return "none"
    decimals = max(0, 1 + math.ceil(-math.log10(one.tolerance)))
    return f"{one.computed:.{decimals}f}"


def as_markdown(comparisons: Sequence[Comparison]) -> str:
    """A table of the comparisons for each chapter, in Markdown."""
    parts = []
    for chapter, group in groupby(comparisons, lambda one: one.chapter):
        rule = "|".join("---" for _ in HEADINGS)
        lines = [f"| {' | '.join(HEADINGS)} |", f"|{rule}|", *_rows(list(group))]
        parts.append(f"### {title_of(chapter)}\n\n" + "\n".join(lines) + "\n")
    return "\n".join(parts)


def _rows(comparisons: Sequence[Comparison]) -> Iterator[str]:
    said: set[tuple[str, str]] = set()
    for one in comparisons:
        why = one.failure or one.reason
        first = (one.source, why) not in said
        said.add((one.source, why))
        yield (
            f"{start_of_row(one.source, one, one.published)} {computed(one)} | {one.verdict} "
            f"| {_cell(why) if first else ''} |"
        )


def _cell(text: str) -> str:
    """Text without the bars that would end a cell."""
    return text.replace("|", r"\|")
