"""The picture of a branch of a bird's limit cycles."""

from __future__ import annotations

import itertools

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from birdmb._typing import BoolArray, FloatArray
from birdmb.orbits import Bifurcation, Branch
from birdmb.orbits.plots import MARKERS, VERDICT_COLOURS
from birdmb.studies.validity import LARGEST_ANGLE

# Parameters that span more than this factor are drawn on a logarithmic axis.
_WIDE = 10.0


def plot_bird_branch(branch: Branch) -> Figure:
    """Draw speed, moduli of the multipliers and angle of attack over the parameter of a branch.

    Stable flights are blue, unstable ones red, undecided ones grey; what is located between them is
    marked. Flights whose effective angle of attack leaves the model's validity are drawn thin.

    Args:
        branch: what `bird_branch` returned.
    """
    figure = Figure(figsize=(8, 9), layout="constrained")
    rows = figure.subplots(3, 1, sharex=True)
    angles = np.degrees(branch.values("largest_angle_of_attack"))
    limit = float(np.degrees(LARGEST_ANGLE))
    valid = angles <= limit
    _draw(rows[0], branch, branch.values("mean_speed"), valid)
    for moduli in _moduli(branch).T:
        _draw(rows[1], branch, moduli, valid)
    rows[1].axhline(1, color="0.7", linewidth=0.8, zorder=0)
    _draw(rows[2], branch, angles, valid)
    rows[2].axhspan(limit, max(float(angles.max()) * 1.05, limit + 1), color="0.93", zorder=0)
    rows[2].text(
        0.99, limit + 0.5, "beyond the model", transform=rows[2].get_yaxis_transform(), ha="right"
    )
    for found in branch.bifurcations:
        values = found.point.observables
        marker = MARKERS[found.kind]
        rows[0].plot(found.parameter, values["mean_speed"], marker, color="k", label=_label(found))
        rows[2].plot(
            found.parameter, np.degrees(values["largest_angle_of_attack"]), marker, color="k"
        )
        for axes in rows:
            axes.axvline(found.parameter, color="0.8", linewidth=0.8, zorder=0)
    for verdict in dict.fromkeys(point.stability for point in branch.points):
        rows[0].plot([], [], "-", color=VERDICT_COLOURS[verdict], label=verdict)
    rows[0].legend(fontsize="small")
    rows[0].set(ylabel="mean speed (m/s)", title=str(branch.settings.get("bird", "")))
    rows[1].set(ylabel="|Λ|")
    rows[2].set(ylabel="largest effective angle\nof attack (deg)", xlabel=branch.parameter_name)
    low, high = branch.parameters.min(), branch.parameters.max()
    if low > 0 and high > _WIDE * low:
        _make_logarithmic(rows[2], low, high)
    return figure


def _draw(axes: Axes, branch: Branch, values: FloatArray, valid: BoolArray) -> None:
    parameters = branch.parameters
    for i, (before, after) in enumerate(itertools.pairwise(branch.points)):
        between = [found for found in branch.bifurcations if found.after == i]
        verdict = before.stability if between else after.stability
        axes.plot(
            parameters[i : i + 2],
            values[i : i + 2],
            "-",
            color=VERDICT_COLOURS[verdict],
            linewidth=2.0 if valid[i] and valid[i + 1] else 0.8,
        )


def _moduli(branch: Branch) -> FloatArray:
    """Moduli (k, n) of the multipliers, largest first, without those that are all but zero."""
    moduli = np.array([np.abs(point.multipliers) for point in branch.points])
    return np.asarray(moduli[:, moduli.max(axis=0) > 1e-3])


def _label(found: Bifurcation) -> str:
    return f"{found.kind}, {found.parameter:.4g}"


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
