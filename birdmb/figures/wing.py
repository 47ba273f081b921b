"""The wings at phases of the beat, coloured by their circulation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import CenteredNorm
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from birdmb._typing import FloatArray
from birdmb.figures.style import model_of, stroke_speed
from birdmb.wing.outline import WingOutline, wing_outline

if TYPE_CHECKING:
    from birdmb.models import FlightCycle

_PHASES = (0.0, 0.25, 0.5, 0.75)
_COLOURS = "RdBu_r"
_MIRROR = np.array([1.0, -1.0, 1.0])
# Slower than this part of the fastest stroke, the wings are turning round.
_TURNING = 0.35

_Style = dict[str, Any]
_BONE: _Style = {"color": "k", "lw": 1.8, "marker": "o", "ms": 2.6, "solid_capstyle": "round"}
_LIFTING_LINE: _Style = {"color": "0.15", "lw": 0.9, "ls": (0, (4, 2))}
_EDGE: _Style = {"color": "0.15", "lw": 0.9}
_FEATHER: _Style = {"color": "0.45", "lw": 0.7}
_CENTRE: _Style = {"color": "k", "ls": "", "marker": "+", "ms": 6, "mew": 1}


@dataclass(frozen=True)
class View:
    """A parallel projection of body axes (x forward, y right, z down) on paper.

    `right` and `up` (3,) are the directions on paper, `towards` (3,) the one to the eye.
    """

    name: str
    right: FloatArray
    up: FloatArray
    towards: FloatArray

    @classmethod
    def along(cls, name: str, towards: Sequence[float], up: Sequence[float]) -> View:
        """View against the direction `towards` (3,), with `up` (3,) upright on paper."""
        eye = np.array(towards) / np.linalg.norm(towards)
        right = np.cross(up, eye)
        right /= np.linalg.norm(right)
        return cls(name, right, np.cross(eye, right), eye)

    def __call__(self, points: FloatArray) -> FloatArray:
        """Places (..., 2) on paper of points (..., 3)."""
        return np.stack([points @ self.right, points @ self.up], axis=-1)


# All from behind or from above, so that the right wing is always on the right. The oblique one is
# close enough to the plane of symmetry not to see a raised or lowered wing edge-on.
OBLIQUE = View.along("oblique, from behind", (-0.75, 0.3, -0.8), (0.0, 0.0, -1.0))
BEHIND = View.along("from behind", (-1.0, 0.0, 0.0), (0.0, 0.0, -1.0))
TOP = View.along("from above", (0.0, 0.0, -1.0), (1.0, 0.0, 0.0))


@dataclass(frozen=True)
class Pose:
    """The wing at one phase: its outline, the circulation (N,) m2/s, and what it is doing."""

    phase: float
    outline: WingOutline
    circulation: FloatArray
    motion: str


def wing_phases(cycle: FlightCycle) -> Figure:
    """Draw both wings at t = 0, T/4, T/2 and 3T/4 in three views of equal scale."""
    figure = Figure(figsize=(13, 7.2), layout="constrained")
    draw_wing_phases(figure, cycle, (OBLIQUE, BEHIND, TOP))
    figure.legend(handles=_legend(), loc="outside lower center", ncols=5, frameon=False)
    figure.suptitle(f"{model_of(cycle).bird.name}: the wings in body axes", fontsize="medium")
    return figure


def draw_wing_phases(figure: Figure | SubFigure, cycle: FlightCycle, views: Sequence[View]) -> None:
    """Draw the wings at four phases, a row for each view, all on one scale of length and colour."""
    poses = _poses(cycle)
    norm = CenteredNorm(0.0, max(float(np.abs(p.circulation).max()) for p in poses))
    boxes = [_box(view, poses) for view in views]
    heights = [box[1][1] - box[1][0] for box in boxes]
    grid = figure.subplots(len(views), len(poses), squeeze=False, height_ratios=heights)
    for row, (view, (xlim, ylim)) in enumerate(zip(views, boxes, strict=True)):
        for axes, pose in zip(grid[row], poses, strict=True):
            _draw(axes, pose, view, norm)
            axes.set(xlim=xlim, ylim=ylim, aspect="equal")
            axes.set_axis_off()
            if row == 0:
                axes.set_title(f"t = {_fraction(pose.phase)}, {pose.motion}", fontsize="medium")
        if len(views) > 1:
            grid[row, 0].text(
                -0.02,
                0.5,
                view.name,
                rotation=90,
                ha="right",
                va="center",
                transform=grid[row, 0].transAxes,
                color="0.3",
            )
    colours = ScalarMappable(norm, _COLOURS)
    bar = figure.colorbar(colours, ax=grid, label="circulation Γ (m²/s)", shrink=0.7, pad=0.01)
    # Zero is white on any scale; what does not occur need not be shown.
    lowest, highest = (float(f([f(p.circulation) for p in poses])) for f in (np.min, np.max))
    bar.ax.set_ylim(min(lowest, 0.0), max(highest, 0.0))
    _scale_bar(grid[-1, 0])


def _poses(cycle: FlightCycle) -> list[Pose]:
    model = model_of(cycle)
    discretisation = model.bird.wing.resolved_discretisation
    times = cycle.start_time + np.array(_PHASES) * cycle.period
    poses = []
    for phase, t, x in zip(_PHASES, times, cycle.trajectory(times).states, strict=True):
        angles, _ = model.joint_motion(t, x)
        outline = wing_outline(model.wing, angles, discretisation)
        poses.append(Pose(phase, outline, model.loads(t, x).circulation, _motion(cycle, t)))
    return poses


def _motion(cycle: FlightCycle, t: float) -> str:
    speed = stroke_speed(cycle)
    now = float(np.interp(t, cycle.beat.times, speed)) / max(float(np.abs(speed).max()), 1e-12)
    if abs(now) >= _TURNING:
        return "downstroke" if now > 0 else "upstroke"
    soon = np.interp(t + 0.1 * cycle.period, cycle.beat.times, speed, period=cycle.period)
    return "upper turn" if soon > 0 else "lower turn"


def _fraction(phase: float) -> str:
    return {0.0: "0", 0.25: "T/4", 0.5: "T/2", 0.75: "3T/4"}[phase]


def _box(view: View, poses: Sequence[Pose]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Limits on paper that hold both wings of all poses."""
    points = np.concatenate(
        [np.concatenate([p.outline.leading, p.outline.trailing]) for p in poses]
    )
    seen = view(np.concatenate([points, points * _MIRROR]))
    (x0, y0), (x1, y1) = seen.min(axis=0) - 0.03, seen.max(axis=0) + 0.03
    return (x0, x1), (y0, y1)


def _draw(axes: Axes, pose: Pose, view: View, norm: CenteredNorm) -> None:
    outline = pose.outline
    panels = np.concatenate([outline.panels, outline.panels * _MIRROR])
    circulation = np.concatenate([pose.circulation, pose.circulation])
    order = np.argsort((panels @ view.towards).mean(axis=1))
    axes.add_collection(
        PolyCollection(
            list(view(panels[order])),
            array=circulation[order],
            norm=norm,
            cmap=_COLOURS,
            edgecolors="face",
            linewidths=0.4,
        )
    )
    for side in (np.ones(3), _MIRROR):
        for feather in outline.feathers:
            axes.plot(*view(feather * side).T, **_FEATHER)
        for edge in (outline.leading, outline.trailing):
            axes.plot(*view(edge * side).T, **_EDGE)
        axes.plot(*view(outline.line * side).T, **_LIFTING_LINE)
        axes.plot(*view(outline.bones * side).T, **_BONE)
    axes.plot(*view(np.zeros((1, 3))).T, **_CENTRE)


def _legend() -> list[Line2D]:
    styles = {
        "bones": _BONE,
        "feathers": _FEATHER,
        "leading and trailing edge": _EDGE,
        "lifting line": _LIFTING_LINE,
        "centre of mass of the body": _CENTRE,
    }
    return [Line2D([], [], label=label, **style) for label, style in styles.items()]


def _scale_bar(axes: Axes) -> None:
    x0, y0 = axes.get_xlim()[0], axes.get_ylim()[0]
    axes.plot([x0 + 0.03, x0 + 0.28], [y0, y0], color="k", lw=2, clip_on=False)
    axes.text(x0 + 0.3, y0, "0.25 m", ha="left", va="center", fontsize="small")
