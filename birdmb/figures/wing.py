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
from birdmb.figures.page import is_narrow, legend_below, new_figure, title
from birdmb.figures.style import holds_still, stroke_speed, title_of
from birdmb.wing.outline import WingOutline, wing_outline

if TYPE_CHECKING:
    from birdmb.models import FlightCycle

_PHASES = (0.0, 0.25, 0.5, 0.75)
_COLOURS = "RdBu_r"
_MIRROR = np.array([1.0, -1.0, 1.0])
_SIDES = (np.ones(3), _MIRROR)
# Slower than this part of the fastest stroke, the wings are turning round.
_TURNING = 0.35
# Of the widest drawing: what is left between two of them, and the longest scale bar.
_GAP = 0.12
_LONGEST_BAR = 0.2
_ROOM_FOR_TITLES = 0.2

_Style = dict[str, Any]
_BONE: _Style = {"color": "k", "lw": 1.8, "marker": "o", "ms": 2.6, "solid_capstyle": "round"}
_LIFTING_LINE: _Style = {"color": "0.15", "lw": 0.9, "ls": (0, (4, 2))}
_EDGE: _Style = {"color": "0.15", "lw": 0.9}
_FEATHER: _Style = {"color": "0.45", "lw": 0.7}
_VIEW_NAME: _Style = {"rotation": 90, "ha": "right", "va": "center", "color": "0.3"} | {
    "fontsize": "small"
}
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
    """Both wings at one phase, the left one mirrored, and what they are doing.

    Attributes:
        phase: part of the beat.
        outlines: of the right and of the left wing.
        circulations: (2, N) m2/s.
        motion: in a word.
    """

    phase: float
    outlines: tuple[WingOutline, WingOutline]
    circulations: FloatArray
    motion: str


def plot_wing_phases(cycle: FlightCycle) -> Figure:
    """Draw both wings at t = 0, T/4, T/2 and 3T/4 in three views of equal scale."""
    figure = new_figure(13, 6.2, columns=2)
    draw_wing_phases(figure, cycle, (OBLIQUE, BEHIND, TOP))
    legend_below(figure, _legend(), most=5)
    title(figure, f"{title_of(cycle)}: the wings in body axes")
    return figure


def draw_wing_phases(figure: Figure | SubFigure, cycle: FlightCycle, views: Sequence[View]) -> None:
    """Draw the wings at four phases, a row for each view, all on one scale of length and colour.

    On narrow paper two phases stand beside one another.
    """
    poses = _poses(cycle)
    norm = CenteredNorm(0.0, max(float(np.abs(p.circulations).max()) for p in poses))
    # One set of axes for all: nothing else keeps all drawings on one scale.
    axes = figure.subplots()
    axes.set(aspect="equal")
    axes.margins(0.01)
    axes.set_axis_off()
    boxes = [_box(view, poses) for view in views]
    widest = max(right - left for (left, _), (right, _) in boxes)
    gap, width, top = _GAP * widest, (1.0 + _GAP) * widest, 0.0
    beside = 2 if is_narrow() else len(poses)
    for row in (poses[i : i + beside] for i in range(0, len(poses), beside)):
        for column, pose in enumerate(row):
            about = f"t = {_fraction(pose.phase)}, {pose.motion}"
            axes.text(column * width, top + 0.3 * gap, about, ha="center", va="bottom")
        for view, ((left, low), (right, high)) in zip(views, boxes, strict=True):
            for column, pose in enumerate(row):
                middle = column * width - 0.5 * (left + right)
                _draw(axes, pose, view, norm, np.array([middle, top - high]))
            if len(views) > 1:
                place = (-0.5 * width, top - 0.5 * (high - low))
                axes.text(*place, view.name, **_VIEW_NAME)
            top -= high - low + gap
        top -= _ROOM_FOR_TITLES * widest
    foot = top + _ROOM_FOR_TITLES * widest + 0.3 * gap
    _scale_bar(axes, -0.4 * width, foot, round_below(_LONGEST_BAR * widest))
    circulations = np.array([pose.circulations for pose in poses])
    _colour_bar(figure, axes, norm, circulations, below=is_narrow() and len(views) > 1)


def _colour_bar(
    figure: Figure | SubFigure,
    axes: Axes,
    norm: CenteredNorm,
    circulations: FloatArray,
    *,
    below: bool,
) -> None:
    # Zero is white on any scale; what does not occur need not be shown.
    shown = min(float(circulations.min()), 0.0), max(float(circulations.max()), 0.0)
    bar = figure.colorbar(
        ScalarMappable(norm, _COLOURS), ax=axes, label="circulation Γ (m²/s)", shrink=0.7,
        pad=0.01, location="bottom" if below else "right",
    )  # fmt: skip
    (bar.ax.set_xlim if below else bar.ax.set_ylim)(*shown)


def _poses(cycle: FlightCycle) -> list[Pose]:
    model = cycle.model
    discretisation = model.bird.wing.resolved_discretisation
    times = cycle.start_time + np.array(_PHASES) * cycle.period
    poses = []
    for phase, t, x in zip(_PHASES, times, cycle.trajectory(times).states, strict=True):
        angles, _ = model.motion_of_both(np.array([t]), x[None])
        right, left = (wing_outline(model.wing, at, discretisation) for at in angles[0])
        loads = model.loads(t, x)
        circulations = np.array([loads.right.circulation, loads.left.circulation])
        poses.append(Pose(phase, (right, left), circulations, _motion(cycle, t)))
    return poses


def _motion(cycle: FlightCycle, t: float) -> str:
    if holds_still(cycle):
        return "gliding"
    speed = stroke_speed(cycle)
    now = float(np.interp(t, cycle.beat.times, speed)) / max(float(np.abs(speed).max()), 1e-12)
    if abs(now) >= _TURNING:
        return "downstroke" if now > 0 else "upstroke"
    soon = np.interp(t + 0.1 * cycle.period, cycle.beat.times, speed, period=cycle.period)
    return "upper turn" if soon > 0 else "lower turn"


def _fraction(phase: float) -> str:
    return {0.0: "0", 0.25: "T/4", 0.5: "T/2", 0.75: "3T/4"}[phase]


def _box(view: View, poses: Sequence[Pose]) -> tuple[FloatArray, FloatArray]:
    """Lower left and upper right corner (2,) on paper of both wings in all poses."""
    points = np.concatenate(
        [
            edge * side
            for pose in poses
            for outline, side in zip(pose.outlines, _SIDES, strict=True)
            for edge in (outline.leading, outline.trailing)
        ]
    )
    seen = view(points)
    return seen.min(axis=0), seen.max(axis=0)


def _draw(axes: Axes, pose: Pose, view: View, norm: CenteredNorm, origin: FloatArray) -> None:
    """Draw both wings with the body's centre of mass at `origin` (2,) m on paper."""

    def seen(points: FloatArray) -> FloatArray:
        return origin + view(points)

    wings = list(zip(pose.outlines, _SIDES, strict=True))
    panels = np.concatenate([outline.panels * side for outline, side in wings])
    circulation = pose.circulations.ravel()
    order = np.argsort((panels @ view.towards).mean(axis=1))
    axes.add_collection(
        PolyCollection(
            list(seen(panels[order])),
            array=circulation[order],
            norm=norm,
            cmap=_COLOURS,
            edgecolors="face",
            linewidths=0.4,
        )
    )
    for outline, side in wings:
        for feather in outline.feathers:
            axes.plot(*seen(feather * side).T, **_FEATHER)
        for edge in (outline.leading, outline.trailing):
            axes.plot(*seen(edge * side).T, **_EDGE)
        axes.plot(*seen(outline.line * side).T, **_LIFTING_LINE)
        axes.plot(*seen(outline.bones * side).T, **_BONE)
    axes.plot(*seen(np.zeros((1, 3))).T, **_CENTRE)


def _legend() -> list[Line2D]:
    styles = {
        "bones": _BONE,
        "feathers or sections": _FEATHER,
        "leading and trailing edge": _EDGE,
        "lifting line": _LIFTING_LINE,
        "centre of mass of the body": _CENTRE,
    }
    return [Line2D([], [], label=label, **style) for label, style in styles.items()]


def _scale_bar(axes: Axes, x: float, y: float, length: float) -> None:
    axes.plot([x, x + length], [y, y], color="k", lw=2)
    label = f"  {length:g} m"
    axes.text(x + length, y, label, ha="left", va="center", fontsize="small")


def round_below(length: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not more than a length."""
    power = 10.0 ** np.floor(np.log10(length))
    return float(power * max(digit for digit in (1.0, 2.0, 5.0) if digit * power <= length))
