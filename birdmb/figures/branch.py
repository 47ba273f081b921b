"""A branch of orbits over its parameter, and the boundary of stability over two."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from birdmb.figures.labels import MODULUS, as_shown, parameter_label, quantity_label
from birdmb.figures.page import legend_below, new_figure, panels
from birdmb.figures.style import BIFURCATION_MARKERS, LEVEL, VERDICT_MARKERS
from birdmb.figures.verdicts import draw_curve, verdict_handles

if TYPE_CHECKING:
    from birdmb.orbits import Branch, BranchPoint, StabilityBoundary


def plot_branch(branch: Branch, quantity: str) -> Figure:
    """Draw a quantity and the multipliers' moduli over the parameter of a branch."""
    figure = new_figure(8, 7, rows=2)
    top, bottom = panels(figure, 2, 1, sharex=True)[:, 0]

    def value_of(point: BranchPoint) -> float:
        return float(as_shown(quantity, np.array(branch.value_of(point, quantity))))

    draw_curve(top, branch, value_of)
    for verdict, style in VERDICT_MARKERS.items():
        points = [point for point in branch.points if point.stability == verdict]
        over = [point.parameter for point in points]
        top.plot(over, [*map(value_of, points)], ms=2.5, **style)
    moduli = np.array([np.abs(point.multipliers) for point in branch.points])
    bottom.plot(branch.parameters, moduli, ".", color="0.3", markersize=4)
    bottom.axhline(1, **LEVEL)
    middle = 0.5 * (branch.parameters.min() + branch.parameters.max())
    for bifurcation in branch.bifurcations:
        value = value_of(bifurcation.point)
        top.plot(bifurcation.parameter, value, BIFURCATION_MARKERS[bifurcation.kind], color="k")
        text = f"{bifurcation.kind} {bifurcation.parameter:.5g}"
        top.annotate(
            text,
            (bifurcation.parameter, value),
            (-6 if bifurcation.parameter > middle else 6, 6),
            textcoords="offset points",
            fontsize="small",
            ha="right" if bifurcation.parameter > middle else "left",
        )
        bottom.axvline(bifurcation.parameter, **LEVEL)
    top.set_ylabel(quantity_label(quantity))
    legend_below(figure, verdict_handles(branch))
    bottom.set(xlabel=parameter_label(branch.parameter_name), ylabel=MODULUS)
    figure.align_ylabels([top, bottom])
    return figure


def plot_stability_boundary(boundary: StabilityBoundary) -> Figure:
    """Draw a stability boundary in the plane of its two parameters."""
    figure = new_figure(6, 5)
    axes = figure.subplots()
    found = [(p.second, p.bifurcation) for p in boundary.points if p.bifurcation is not None]
    axes.plot([b.parameter for _, b in found], [second for second, _ in found], color="0.55")
    for kind, marker in BIFURCATION_MARKERS.items():
        second = [value for value, b in found if b.kind == kind]
        if second:
            first = [b.parameter for _, b in found if b.kind == kind]
            axes.plot(first, second, marker, color="k", label=kind)
    if found:
        legend_below(figure)
    axes.set_xlabel(parameter_label(boundary.first_name))
    axes.set_ylabel(parameter_label(boundary.second_name))
    return figure
