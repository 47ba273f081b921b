"""Figures of chapter 4: a limit cycle that attracts, and a sphere that the flow deforms."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from birdmb._typing import FloatArray
from birdmb.figures.page import axes_in_space, legend_below, new_figure, panels, title
from birdmb.figures.style import BLUE, GREEN, ORANGE, SERIES, VERMILION
from birdmb.orbits import LimitCycle
from birdmb.reproduction.appendices import ROESSLER, roessler_cycle
from birdmb.reproduction.chapter4 import AMPLITUDE, PERIOD, poincare_oscillator
from birdmb.reproduction.figures.drawing import Drawing, keep_figure

_RADIUS = 0.3


def poincare(out: Path, _coarse: bool) -> None:
    """Draw trajectories of the Poincaré oscillator that come to its cycle from both sides."""
    model = poincare_oscillator()
    figure = new_figure(9.5, 4.4, columns=2)
    plane, over_time = panels(figure, 1, 2)[0]
    phase = np.linspace(0.0, 2 * np.pi, 181)
    plane.plot(AMPLITUDE * np.cos(phase), AMPLITUDE * np.sin(phase), "k", lw=2, label="limit cycle")
    over_time.axhline(AMPLITUDE, color="k", lw=2)
    for start, style in zip((0.05, 0.4, 1.8), SERIES, strict=False):
        path = model.trajectory(np.array([start, 0.0]), 0.0, 2 * PERIOD)
        plane.plot(*path.states.T, lw=1, label=f"from r = {start:g}", **style)
        plane.plot(start, 0.0, "o", color=style["color"], ms=4)
        over_time.plot(path.times / PERIOD, np.hypot(*path.states.T), lw=1, **style)
    plane.set(xlabel="x", ylabel="y", aspect="equal")
    legend_below(figure, most=4)
    over_time.set(xlabel="time (periods)", ylabel="r", ylim=(0, None))
    keep_figure(out, "figure 4.4", figure)


def _sphere(points: int) -> FloatArray:
    """Points (3, P, P) of the unit sphere."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, points), np.linspace(0, np.pi, points))
    return np.array([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)])


def _carried(cycle: LimitCycle, part: float) -> tuple[FloatArray, FloatArray]:
    """State (3,) on the cycle a part of the period on, and the flow's derivative (3, 3) to it."""
    model = cycle.model
    if part == 0.0:
        return cycle.x0, np.eye(3)
    return model.flow_jacobian(cycle.x0, 0.0, part * cycle.period)  # type: ignore[attr-defined]


def sphere_along_the_flow(out: Path, coarse: bool) -> None:
    """Draw a sphere of disturbances, to first order, at some phases of Roessler's cycle."""
    cycle = roessler_cycle(ROESSLER[2])
    path = cycle.trajectory().states
    figure = new_figure(7.5, 6.4)
    axes = axes_in_space(figure)
    axes.plot(*path.T, color="0.5", lw=1)
    ball = _sphere(9 if coarse else 25)
    colours = (BLUE, GREEN, ORANGE, VERMILION)
    for part, colour in zip((0.0, 0.3, 0.6, 0.9), colours, strict=True):
        centre, tangent = _carried(cycle, part)
        surface = centre[:, None, None] + _RADIUS * np.einsum("ij,jpq->ipq", tangent, ball)
        axes.plot_surface(*surface, color=colour, alpha=0.5, linewidth=0)
        axes.text(*(centre + 0.6), f"{part:g} T", color=colour)
    axes.set(xlabel="x", ylabel="y", zlabel="z")
    title(axes, "a sphere of disturbances carried along the flow")
    keep_figure(out, "figure 4.7", figure)


def sphere_after_a_period(out: Path, coarse: bool) -> None:
    """Draw the sphere and the ellipsoid that a period makes of it, with axes and eigenvectors."""
    cycle = roessler_cycle(ROESSLER[2])
    _, tangent = _carried(cycle, 1.0)
    ball = _sphere(9 if coarse else 31)
    ellipsoid = np.einsum("ij,jpq->ipq", tangent, ball)
    figure = new_figure(7.5, 6.4)
    axes = axes_in_space(figure)
    axes.plot_wireframe(*ball, color=BLUE, lw=0.4, alpha=0.6)
    axes.plot_surface(*ellipsoid, color=VERMILION, alpha=0.35, linewidth=0)
    left, sizes, _ = np.linalg.svd(tangent)
    for size, axis, dashes in zip(sizes, left.T, ("-", "-.", ":"), strict=True):
        ends = np.array([-axis, axis]) * size
        axes.plot(*ends.T, color=VERMILION, ls=dashes, label=f"semi-axis {size:.2g}")
    for value, mode, look in zip(
        cycle.multipliers, cycle.modes.T, ("--", (0, (6, 3, 1, 3)), ":"), strict=True
    ):
        if abs(value) > 1e-3:
            vector = mode.real / np.linalg.norm(mode.real)
            ends = np.array([-vector, vector])
            axes.plot(
                *ends.T, color="k", ls=look, lw=1, label=f"Λ = {value.real:.3f}".replace("-", "−")
            )
    axes.set(xlabel="δx", ylabel="δy", zlabel="δz")
    axes.set_aspect("equal", adjustable="datalim")
    axes.locator_params(nbins=5)
    axes.set_zticks([])
    # Nearly along the axis that has all but vanished: the rest is a disc.
    towards = left[:, 2] + 0.5 * left[:, 1]
    azimuth = np.degrees(np.arctan2(towards[1], towards[0]))
    axes.view_init(np.degrees(np.arctan2(towards[2], np.hypot(*towards[:2]))), azimuth)
    legend_below(figure, most=2)
    title(axes, "unit sphere (wires) and what a period makes of it (surface)")
    keep_figure(out, "figure 4.8", figure)


DRAWINGS: Mapping[str, Drawing] = {
    "figure 4.4": Drawing("Poincaré oscillator: trajectories onto a stable cycle", poincare),
    "figure 4.7": Drawing("a sphere of disturbances along the flow", sphere_along_the_flow),
    "figure 4.8": Drawing("the ellipsoid after a period, with its axes", sphere_after_a_period),
}
