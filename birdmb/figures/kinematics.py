"""A measured motion beside the gait that was fitted to it."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from birdmb.figures.labels import in_words
from birdmb.figures.page import is_narrow, legend_below, new_figure, panels, title
from birdmb.figures.style import BLUE, DRIVER, GREEN, LINE, VERMILION
from birdmb.kinematics import KinematicsFit
from birdmb.text import in_figure

_INSTANTS = 200
_COLUMNS = 3
_SAMPLE: dict[str, Any] = {"ls": "", "marker": ".", "ms": 2.0, "alpha": 0.5, "zorder": 1}
_DIRECTIONS = {"forward": (0, 1.0), "right": (1, 1.0), "up": (2, -1.0)}
_STYLES = ((BLUE, "-"), (VERMILION, "--"), (GREEN, "-."))


def plot_kinematics(fit: KinematicsFit) -> Figure:
    """Draw the joints' angles beside the topology's own, and measured markers beside fitted ones.

    All beats are drawn over one, the scatter of single beats as a band. Markers are drawn from the
    shoulder, along body axes, in mm.
    """
    points = [name for name in fit.markers if name not in fit.bird.joint_names]
    groups = [list(fit.bird.joint_names), points] if points else [list(fit.bird.joint_names)]
    columns = 1 if is_narrow() else _COLUMNS
    rows = [-(-len(names) // columns) for names in groups]
    wide, high = (3.5, 1.0) if is_narrow() else (10.5, 1.9)
    figure = new_figure(wide, 0.8 + high * sum(rows), rows=sum(rows), columns=columns)
    parts = figure.subfigures(len(groups), 1, squeeze=False, height_ratios=rows)[:, 0]
    for name, axes in zip(groups[0], _panels(parts[0], rows[0], len(groups[0])), strict=True):
        _draw_joint(axes, fit, name)
    legend_below(parts[0])
    for name, axes in zip(points, _panels(parts[-1], rows[-1], len(points)), strict=False):
        _draw_marker(axes, fit, name)
    if points:
        legend_below(parts[-1])
    beats = f"{fit.beats} beats" if fit.beats != 1 else "1 beat"
    title(
        figure,
        f"{in_figure(fit.bird.name)}: {beats} at {fit.frequency:.4g} Hz, measured (dots) and "
        "fitted (lines)",
    )
    return figure


def _panels(figure: SubFigure, rows: int, count: int) -> list[Axes]:
    columns = 1 if is_narrow() else _COLUMNS
    all_panels = list(panels(figure, rows, columns, sharex=True).ravel())
    for axes in all_panels[count:]:
        axes.remove()
    for place, axes in enumerate(all_panels[:count]):
        axes.set_xlim(0.0, 1.0)
        axes.spines[["top", "right"]].set_visible(False)
        if place + columns >= count:
            axes.set_xlabel("time (beats)")
            axes.tick_params(labelbottom=True)
    figure.align_ylabels()
    return all_panels[:count]


def _draw_joint(axes: Axes, fit: KinematicsFit, name: str) -> None:
    phases = np.linspace(0.0, 1.0, _INSTANTS)
    own = np.degrees(fit.like.joint(name).driver.at(phases))
    axes.plot(phases, own, "--", color=DRIVER, lw=1.0, label="topology")
    if name in fit.markers:
        measured = np.degrees(fit.measured[:, fit.column(name)])
        axes.plot(np.mod(fit.phases, 1.0), measured, color=LINE, **_SAMPLE)
    if name in fit.joints:
        motion = fit.joints[name]
        angles = np.degrees(motion.at(phases))
        scatter = np.degrees(np.nan_to_num(motion.scatter))
        low, high = angles - scatter, angles + scatter
        axes.fill_between(phases, low, high, color=LINE, alpha=0.3, lw=0, label="scatter of beats")
        axes.plot(phases, angles, color=LINE, lw=1.5, label="fitted")
    else:
        axes.set_title("not told by the data", fontsize="small", loc="right", pad=2)
    axes.set_ylabel(f"{in_figure(name).replace('.', chr(10))} (°)")


def _draw_marker(axes: Axes, fit: KinematicsFit, name: str) -> None:
    column = fit.column(name)
    phases = np.mod(fit.phases, 1.0)
    order = np.argsort(phases)
    for (direction, (axis, sign)), style in zip(_DIRECTIONS.items(), _STYLES, strict=True):
        colour, dashes = style
        measured = 1e3 * sign * fit.measured[:, column + axis]
        fitted = 1e3 * sign * fit.fitted[:, column + axis]
        axes.plot(phases, measured, color=colour, **_SAMPLE)
        axes.plot(phases[order], fitted[order], color=colour, ls=dashes, lw=1.0, label=direction)
    residual = 1e3 * fit.markers[name].residual
    axes.set_ylabel(f"{in_words(name).replace(' ', chr(10))} (mm)")
    axes.set_title(f"residual {residual:.3g} mm", fontsize="small", loc="right", pad=2)
