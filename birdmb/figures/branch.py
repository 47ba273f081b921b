"""A branch of orbits over its parameter, and the boundary of stability over two."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from birdmb.figures.style import BIFURCATION_MARKERS, VERDICT_COLOURS
from birdmb.text import in_figure

if TYPE_CHECKING:
    from birdmb.orbits import Branch, StabilityBoundary


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
        top.plot(bifurcation.parameter, value, BIFURCATION_MARKERS[bifurcation.kind], color="k")
        text = f"{bifurcation.kind} {bifurcation.parameter:.5g}"
        top.annotate(text, (bifurcation.parameter, value), (6, 6), textcoords="offset points")
        bottom.axvline(bifurcation.parameter, color="0.8", linewidth=0.8)
    top.set_ylabel(in_figure(quantity))
    bottom.set(xlabel=in_figure(branch.parameter_name), ylabel="|Λ|")
    return figure


def plot_stability_boundary(boundary: StabilityBoundary) -> Figure:
    """Draw a stability boundary in the plane of its two parameters."""
    figure = Figure(figsize=(6, 5), layout="constrained")
    axes = figure.subplots()
    found = [(p.second, p.bifurcation) for p in boundary.points if p.bifurcation is not None]
    axes.plot([b.parameter for _, b in found], [second for second, _ in found], color="0.7")
    for kind, marker in BIFURCATION_MARKERS.items():
        second = [value for value, b in found if b.kind == kind]
        if second:
            first = [b.parameter for _, b in found if b.kind == kind]
            axes.plot(first, second, marker, color="k", label=kind)
    if found:
        axes.legend()
    axes.set(xlabel=in_figure(boundary.first_name), ylabel=in_figure(boundary.second_name))
    return figure
