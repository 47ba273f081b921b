"""Figures of orbits."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from birdmb._typing import ComplexArray, FloatArray
from birdmb.orbits.ode import Trajectory
from birdmb.text import in_figure

if TYPE_CHECKING:
    from birdmb.orbits.boundary import StabilityBoundary
    from birdmb.orbits.branch import Branch

STABLE_COLOUR, UNSTABLE_COLOUR = "tab:blue", "tab:red"
VERDICT_COLOURS = {"stable": STABLE_COLOUR, "unstable": UNSTABLE_COLOUR, "undecided": "0.5"}
MARKERS = {
    "fold": "o",
    "period doubling": "s",
    "Neimark-Sacker": "D",
    "branch point": "x",
    "multiple": "*",
}


def plot_cycle(
    path: Trajectory,
    state_names: Sequence[str],
    units: Sequence[str] | None,
    multipliers: ComplexArray,
    errors: FloatArray,
) -> Figure:
    """Draw the states over time on the left, the multipliers in the unit circle on the right."""
    n = len(state_names)
    figure = Figure(figsize=(9, max(4.0, 1.3 * n)), layout="constrained")
    left, right = figure.subfigures(1, 2, squeeze=False)[0]
    rows = left.subplots(n, 1, sharex=True, squeeze=False)[:, 0]
    for i, axes in enumerate(rows):
        axes.plot(path.times, path.states[:, i])
        unit = "" if units is None else f" ({units[i]})"
        axes.set_ylabel(in_figure(f"{state_names[i]}{unit}"))
    rows[-1].set_xlabel("time (s)")
    draw_multipliers(right.subplots(), multipliers, errors)
    return figure


def draw_multipliers(axes: Axes, multipliers: ComplexArray, errors: FloatArray) -> None:
    """Draw multipliers (n,) in the complex plane, with their error bounds as discs."""
    axes.add_patch(Circle((0, 0), 1, fill=False, color="0.6"))
    inside = np.abs(multipliers) <= 1
    for keep, colour in ((inside, STABLE_COLOUR), (~inside, UNSTABLE_COLOUR)):
        axes.plot(multipliers[keep].real, multipliers[keep].imag, "o", color=colour)
    for value, error in zip(multipliers, errors, strict=True):
        if np.isfinite(error):
            axes.add_patch(Circle((value.real, value.imag), error, color="0.5", alpha=0.3))
    reach = 1.1 * max(1.0, float(np.abs(multipliers).max()))
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes.set(xlabel="Re Λ", ylabel="Im Λ", title="Floquet multipliers")


def plot_response(
    times: FloatArray, states: FloatArray, orbit: FloatArray, state_names: Sequence[str]
) -> Figure:
    """Draw disturbed states (k, n) and the orbit (k, n) over time."""
    n = len(state_names)
    figure = Figure(figsize=(8, max(4.0, 1.3 * n)), layout="constrained")
    rows = figure.subplots(n, 1, sharex=True, squeeze=False)[:, 0]
    for i, axes in enumerate(rows):
        axes.plot(times, orbit[:, i], color="0.6", label="orbit")
        axes.plot(times, states[:, i], color=STABLE_COLOUR, label="disturbed")
        axes.set_ylabel(in_figure(state_names[i]))
    rows[0].legend(loc="upper right")
    rows[-1].set_xlabel("time (s)")
    return figure


def plot_branch(branch: Branch, quantity: str) -> Figure:
    """Draw a quantity and the multipliers' moduli over the parameter of a branch."""
    figure = Figure(figsize=(8, 7), layout="constrained")
    top, bottom = figure.subplots(2, 1, sharex=True)
    parameters, values = branch.parameters, branch.values(quantity)
    for i, (before, after) in enumerate(itertools.pairwise(branch.points)):
        # A change of verdict shows where it was located, else at the point that shows it first.
        between = [b.point for b in branch.bifurcations if b.after == i]
        nodes = [before, *between, after]
        verdicts = [
            before.stability if between else after.stability,
            *(after.stability,) * len(between),
        ]
        for ends, verdict in zip(itertools.pairwise(nodes), verdicts, strict=True):
            x = [point.parameter for point in ends]
            y = [branch.value_of(point, quantity) for point in ends]
            top.plot(x, y, "-", color=VERDICT_COLOURS[verdict])
    top.scatter(parameters, values, s=8, c=[VERDICT_COLOURS[p.stability] for p in branch.points])
    moduli = np.array([np.abs(point.multipliers) for point in branch.points])
    bottom.plot(parameters, moduli, ".", color="0.3", markersize=4)
    bottom.axhline(1, color="0.7")
    for bifurcation in branch.bifurcations:
        value = branch.value_of(bifurcation.point, quantity)
        top.plot(bifurcation.parameter, value, MARKERS[bifurcation.kind], color="k")
        text = f"{bifurcation.kind} {bifurcation.parameter:.5g}"
        top.annotate(text, (bifurcation.parameter, value), (6, 6), textcoords="offset points")
        bottom.axvline(bifurcation.parameter, color="0.8", linewidth=0.8)
    top.set_ylabel(in_figure(quantity))
    bottom.set(xlabel=in_figure(branch.parameter_name), ylabel="|Λ|")
    return figure


def plot_boundary(boundary: StabilityBoundary) -> Figure:
    """Draw a stability boundary in the plane of its two parameters."""
    figure = Figure(figsize=(6, 5), layout="constrained")
    axes = figure.subplots()
    found = [(p.second, p.bifurcation) for p in boundary.points if p.bifurcation is not None]
    axes.plot([b.parameter for _, b in found], [second for second, _ in found], color="0.7")
    for kind, marker in MARKERS.items():
        second = [value for value, b in found if b.kind == kind]
        if second:
            first = [b.parameter for _, b in found if b.kind == kind]
            axes.plot(first, second, marker, color="k", label=kind)
    if found:
        axes.legend()
    axes.set(xlabel=in_figure(boundary.first_name), ylabel=in_figure(boundary.second_name))
    return figure
