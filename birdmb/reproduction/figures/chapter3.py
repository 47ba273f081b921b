"""Figures of chapter 3: the path of the wing's tip, and the bird held and set free."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from birdmb._typing import FloatArray
from birdmb.figures.page import label_x, legend_below, new_figure, panels, title
from birdmb.figures.style import DRIVER, LEVEL, LINE, SERIES
from birdmb.models import RigidModel
from birdmb.reproduction.figures.drawing import Drawing, keep_figure
from birdmb.reproduction.quantities import published_wing
from birdmb.wing.outline import wing_outline

_START = np.array([14.0, 0.0, 0.0, 0.0])
_STYLES = {"held": {"color": DRIVER, "ls": "--"}, "free": {"color": LINE}}


def tip_path(out: Path, coarse: bool) -> None:
    """Draw the path of the wing's tip over a beat from the side and from behind, body axes."""
    model = RigidModel(published_wing("ibis"))
    times = np.linspace(0.0, model.bird.period, 25 if coarse else 121)
    angles, _ = model.joint_motion_along(times, np.zeros((times.size, 4)))
    outlines = [
        wing_outline(model.wing, each, model.bird.wing.resolved_discretisation) for each in angles
    ]
    paths = {
        "wing tip": np.array([each.leading[-1] for each in outlines]),
        "wrist": np.array([each.bones[-2] for each in outlines]),
    }
    figure = new_figure(9, 4.6, columns=2)
    side, behind = panels(figure, 1, 2, width_ratios=(1, 1.8))[0]
    down = np.sin(2 * np.pi * times / model.bird.period + np.pi / 2) > 0
    for (name, path), style in zip(paths.items(), SERIES, strict=False):
        for axes, across in ((side, 0), (behind, 1)):
            axes.plot(path[:, across], -path[:, 2], lw=1, label=name, **style)
            axes.plot(path[down, across], -path[down, 2], ".", color=style["color"])
    side.set(xlabel="x, forward (m)", ylabel="height over G (m)", title="from the right")
    behind.set(xlabel="y, to the right (m)", ylabel="height over G (m)", title="from behind")
    for axes in (side, behind):
        axes.set_aspect("equal")
        axes.plot(0, 0, "k+")
    legend_below(figure, about="dots: downstroke")
    keep_figure(out, "figure 3.9", figure)


def _flights(coarse: bool) -> tuple[FloatArray, dict[str, FloatArray], dict[str, FloatArray]]:
    """Times (K,), states (K, 4) and [thrust, lift, moment] (K, 3), held and free, from `_START`."""
    model = RigidModel(published_wing("ibis"))
    beats = 1 if coarse else 3
    times = np.linspace(0.0, beats * model.bird.period, beats * 40 + 1)
    free = model.trajectory(_START, 0.0, times[-1], times).states
    states = {"held": np.tile(_START, (times.size, 1)), "free": free}
    loads = {}
    for mount, along in states.items():
        each = [model.loads(t, x) for t, x in zip(times, along, strict=True)]
        force = np.array([at.force for at in each])
        c, s = np.cos(along[:, 3]), np.sin(along[:, 3])
        loads[mount] = np.column_stack(
            [
                c * force[:, 0] + s * force[:, 2],
                s * force[:, 0] - c * force[:, 2],
                [at.moment[1] for at in each],
            ]
        )
    return times / model.bird.period, states, loads


def loads_held_and_free(out: Path, coarse: bool) -> None:
    """Draw thrust, lift and pitching moment of the bird held at 14 m/s and of the free one."""
    beats, _, loads = _flights(coarse)
    weight = 1.2 * 9.81
    figure = new_figure(8, 7, rows=3)
    rows = panels(figure, 3, 1, sharex=True)[:, 0]
    for i, (axes, label) in enumerate(
        zip(rows, ("thrust / weight", "lift / weight", "moment (N m)"), strict=True)
    ):
        for mount, style in _STYLES.items():
            axes.plot(beats, loads[mount][:, i] / (weight if i < 2 else 1.0), **style, label=mount)
        axes.axhline(1.0 if i == 1 else 0.0, **LEVEL)
        axes.set_ylabel(label)
    legend_below(figure)
    rows[-1].set(xlabel="time (beats)", xlim=(0, beats[-1]))
    title(figure, "loads from u = 14 m/s, w = q = θ = 0 on, in world axes")
    keep_figure(out, "figure 3.11", figure)


def states_held_and_free(out: Path, coarse: bool) -> None:
    """Draw the states of the bird held at 14 m/s and of the free one, which is not periodic."""
    beats, states, _ = _flights(coarse)
    figure = new_figure(9, 5.4, rows=2, columns=2)
    rows = panels(figure, 2, 2, sharex=True)
    labels = ("u (m/s)", "w (m/s)", "q (°/s)", "θ (°)")
    for i, (axes, label) in enumerate(zip(rows.ravel(), labels, strict=True)):
        scale = np.degrees(1.0) if i > 1 else 1.0
        for mount, style in _STYLES.items():
            axes.plot(beats, scale * states[mount][:, i], **style, label=mount)
        axes.set_ylabel(label)
    legend_below(figure)
    rows[0, 0].set_xlim(0, beats[-1])
    label_x(rows, "time (beats)")
    figure.align_ylabels()
    keep_figure(out, "figure 3.12", figure)


DRAWINGS: Mapping[str, Drawing] = {
    "figure 3.9": Drawing("path of the wing's tip over a beat", tip_path),
    "figure 3.11": Drawing(
        "loads in the tunnel and in free flight from 14 m/s on, not periodic", loads_held_and_free
    ),
    "figure 3.12": Drawing(
        "states in the tunnel and in free flight from 14 m/s on", states_held_and_free
    ),
}
