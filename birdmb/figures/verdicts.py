"""Curves along a branch, their lines by the verdict on each orbit."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from birdmb.figures.style import VERDICT_LINES
from birdmb.orbits import Branch, BranchPoint

THICK, THIN = 1.8, 0.8


def draw_curve(
    axes: Axes,
    branch: Branch,
    value: Callable[[BranchPoint], float],
    valid: Callable[[BranchPoint], bool] = lambda _: True,
) -> None:
    """Draw a value along a branch, dashed where unstable, thin where the model is not valid."""
    for (verdict, inside), points in _runs(branch, valid):
        axes.plot(
            [point.parameter for point in points],
            [value(point) for point in points],
            lw=THICK if inside else THIN,
            **VERDICT_LINES[verdict],
        )


def verdict_handles(branch: Branch) -> list[Line2D]:
    """Entries of a legend for the verdicts along a branch."""
    verdicts = dict.fromkeys(point.stability for point in branch.points)
    return [Line2D([], [], label=each, lw=THICK, **VERDICT_LINES[each]) for each in verdicts]


def _runs(
    branch: Branch, valid: Callable[[BranchPoint], bool]
) -> Iterator[tuple[tuple[str, bool], Sequence[BranchPoint]]]:
    """Stretches of one verdict and validity: a line for each, or its dashes begin at each point."""
    for key, steps in itertools.groupby(_steps(branch, valid), key=lambda step: step[0]):
        ends = [step[1] for step in steps]
        yield key, [ends[0][0], *(last for _, last in ends)]


def _steps(branch: Branch, valid: Callable[[BranchPoint], bool]) -> Iterable[tuple[Any, Any]]:
    for i, (before, after) in enumerate(itertools.pairwise(branch.points)):
        # A change of verdict shows where it was located, else at the point that shows it first.
        between = [found.point for found in branch.bifurcations if found.after == i]
        for ends in itertools.pairwise([before, *between, after]):
            shows = before if between and ends[0] is before else after
            yield (shows.stability, all(map(valid, ends))), ends
