"""The picture of a branch of a bird's limit cycles."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from birdmb.figures.style import BIFURCATION_MARKERS, VERDICT_COLOURS
from birdmb.orbits import Branch, BranchPoint
from birdmb.quantities import BY_NAME
from birdmb.studies.validity import LARGEST_ANGLE
from birdmb.text import in_figure

# Parameters that span more than this factor are drawn on a logarithmic axis.
_WIDE = 10.0
_ANGLE = "largest_angle_of_attack"


def plot_bird_branch(branch: Branch) -> Figure:
    """Draw speed, moduli of the multipliers and angle of attack over the parameter of a branch.

    Stable flights are blue, unstable ones red, undecided ones grey; what is located between them is
    marked. Flights whose effective angle of attack leaves the model's validity are drawn thin.

    Args:
        branch: what `bird_branch` returned.
    """
    figure = Figure(figsize=(8, 9), layout="constrained")
    rows = figure.subplots(3, 1, sharex=True)
    limit = float(np.degrees(LARGEST_ANGLE))
    _draw(rows[0], branch, _speed)
    for i in _those_that_last(branch):
        _draw(rows[1], branch, partial(_modulus, i))
    _draw(rows[2], branch, _angle)
    rows[1].axhline(1, color="0.7", linewidth=0.8, zorder=0)
    top = max(rows[2].get_ylim()[1], limit + 1)
    rows[2].axhspan(limit, top, color="0.93", zorder=0)
    rows[2].set_ylim(top=top)
    rows[2].text(0.99, 0.95, "beyond the model", transform=rows[2].transAxes, ha="right", va="top")
    for found in branch.bifurcations:
        marker = BIFURCATION_MARKERS[found.kind]
        label = f"{found.kind}, {found.parameter:.4g}"
        rows[0].plot(found.parameter, _speed(found.point), marker, color="k", label=label)
        rows[2].plot(found.parameter, _angle(found.point), marker, color="k")
        for axes in rows:
            axes.axvline(found.parameter, color="0.8", linewidth=0.8, zorder=0)
    for verdict in dict.fromkeys(point.stability for point in branch.points):
        rows[0].plot([], [], "-", color=VERDICT_COLOURS[verdict], label=verdict)
    rows[0].legend(fontsize="small")
    rows[0].set(
        ylabel=BY_NAME["mean_speed"].axis_label,
        title=in_figure(str(branch.settings.get("bird", ""))),
    )
    rows[1].set(ylabel="|Λ|")
    rows[2].set_ylabel("largest effective\n" + BY_NAME["largest_angle_of_attack"].axis_label)
    rows[2].set_xlabel(in_figure(branch.parameter_name))
    low, high = branch.parameters.min(), branch.parameters.max()
    if low > 0 and high > _WIDE * low:
        _make_logarithmic(rows[2], low, high)
    return figure


def _speed(point: BranchPoint) -> float:
    return point.observables["mean_speed"]


def _angle(point: BranchPoint) -> float:
    return float(np.degrees(point.observables[_ANGLE]))


def _modulus(i: int, point: BranchPoint) -> float:
    return float(np.abs(point.multipliers[i]))


def _those_that_last(branch: Branch) -> list[int]:
    """Positions of the multipliers that are not all but zero everywhere."""
    moduli = np.array([np.abs(point.multipliers) for point in branch.points])
    return [int(i) for i in np.flatnonzero(moduli.max(axis=0) > 1e-3)]


def _draw(axes: Axes, branch: Branch, value: Callable[[BranchPoint], float]) -> None:
    for i, (before, after) in enumerate(itertools.pairwise(branch.points)):
        # A change of verdict shows where it was located, else at the point that shows it first.
        between = [found.point for found in branch.bifurcations if found.after == i]
        for ends in itertools.pairwise([before, *between, after]):
            shows = before if between and ends[0] is before else after
            valid = all(point.observables[_ANGLE] <= LARGEST_ANGLE for point in ends)
            axes.plot(
                [point.parameter for point in ends],
                [value(point) for point in ends],
                "-",
                color=VERDICT_COLOURS[shows.stability],
                linewidth=2.0 if valid else 0.8,
            )


def _make_logarithmic(axes: Axes, low: float, high: float) -> None:
    axes.set_xscale("log")
    ticks = [
        digit * 10.0**power
        for power in range(-6, 7)
        for digit in (1, 2, 3, 5)
        if low <= digit * 10.0**power <= high
    ]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xticks([], minor=True)
