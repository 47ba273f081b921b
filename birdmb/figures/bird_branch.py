"""The picture of a branch of a bird's limit cycles."""

from __future__ import annotations

from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from birdmb.figures.labels import MODULUS, parameter_label
from birdmb.figures.page import legend_below, new_figure, panels, title
from birdmb.figures.style import BIFURCATION_MARKERS, LEVEL
from birdmb.figures.verdicts import THIN, draw_curve, verdict_handles
from birdmb.orbits import Branch, BranchPoint
from birdmb.quantities import BY_NAME
from birdmb.studies.validity import LARGEST_ANGLE
from birdmb.text import in_figure

# Parameters that span more than this factor are drawn on a logarithmic axis.
_WIDE = 10.0
_ANGLE = "largest_angle_of_attack"


def plot_bird_branch(branch: Branch) -> Figure:
    """Draw speed, moduli of the multipliers and angle of attack over the parameter of a branch.

    Stable flights are drawn through, unstable ones dashed, undecided ones dotted; what is located
    between them is marked. Flights whose effective angle of attack leaves the model's validity are
    drawn thin.

    Args:
        branch: what `bird_branch` returned.
    """
    figure = new_figure(8, 9, rows=3)
    rows = panels(figure, 3, 1, sharex=True)[:, 0]
    limit = float(np.degrees(LARGEST_ANGLE))
    draw_curve(rows[0], branch, _speed, _valid)
    for i in _those_that_last(branch):
        draw_curve(rows[1], branch, partial(_modulus, i), _valid)
    draw_curve(rows[2], branch, _angle, _valid)
    rows[1].axhline(1, **LEVEL)
    top = max(rows[2].get_ylim()[1], limit + 1)
    rows[2].axhspan(limit, top, color="0.93", zorder=0)
    rows[2].set_ylim(top=top)
    handles = verdict_handles(branch)
    if not all(map(_valid, branch.points)):
        thin = "thin: beyond the model (shaded)"
        handles.append(Line2D([], [], color="0.2", lw=THIN, label=thin))
    for found in branch.bifurcations:
        marker = BIFURCATION_MARKERS[found.kind]
        label = f"{found.kind} at {found.parameter:.4g}"
        (mark,) = rows[0].plot(found.parameter, _speed(found.point), marker, color="k", label=label)
        handles.append(mark)
        rows[2].plot(found.parameter, _angle(found.point), marker, color="k")
        for axes in rows:
            axes.axvline(found.parameter, **LEVEL)
    legend_below(figure, handles)
    title(figure, in_figure(str(branch.settings.get("bird", ""))))
    rows[0].set_ylabel(BY_NAME["mean_speed"].axis_label)
    rows[1].set_ylabel(MODULUS)
    rows[2].set_ylabel("largest effective\n" + BY_NAME["largest_angle_of_attack"].axis_label)
    rows[2].set_xlabel(parameter_label(branch.parameter_name))
    figure.align_ylabels(rows)
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


def _valid(point: BranchPoint) -> bool:
    return point.observables[_ANGLE] <= LARGEST_ANGLE


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
