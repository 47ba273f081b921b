"""The parts of a scene as plotly draws them: what they look like, and what changes by frame."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from birdmb._typing import FloatArray, IntArray
from birdmb.animation.palette import (
    BODY,
    BONE,
    EDGE,
    FEATHER,
    FORCE,
    GRID,
    LAND,
    TAIL,
    TRACK,
    VALUES,
)
from birdmb.animation.scene import Scene
from birdmb.animation.stage import Stage, multiples

Attributes = dict[str, Any]

_SECTION = "rgba(60,70,85,0.35)"
_SMOOTH = {"ambient": 0.62, "diffuse": 0.55, "specular": 0.12, "roughness": 0.7, "fresnel": 0.1}
_HEAD_LENGTH, _HEAD_WIDTH = 0.3, 0.09  # of an arrow
_HEAD_SIDES = 6
_POINTS_ALONG_AN_EDGE = 36
_MOST_MARKS = 10


@dataclass(frozen=True)
class Trace:
    """A trace of plotly.

    Attributes:
        fixed: its attributes that stay.
        at: those that change, at a frame; `None` where all stay.
    """

    fixed: Attributes
    at: Callable[[int], Attributes] | None = None

    def changed(self, frame: int) -> Attributes:
        """The attributes that change, at a frame, with the type of the trace."""
        return {"type": self.fixed["type"]} | (self.at(frame) if self.at is not None else {})

    def whole(self, frame: int) -> Attributes:
        """All attributes at a frame."""
        return self.fixed | self.changed(frame)


def traces(stage: Stage, scene: Scene, name: str, *, first: bool) -> list[Trace]:
    """Traces of one bird in the plotly scene `name`; the `first` one has the colour bar."""
    found = [
        *_land(stage, scene),
        *_way(stage, scene),
        _wake(stage, scene),
        _shadow(stage, scene),
        _wings(stage, scene, bar=first),
        *_skeleton(scene),
        *_trunk(scene),
        *_forces(stage, scene),
    ]
    for trace in found:
        trace.fixed["scene"] = name
    return found


def _land(stage: Stage, scene: Scene) -> list[Trace]:
    # Just within the box, at whose borders nothing is drawn.
    box, height, step = stage.box(scene), stage.ground(scene), stage.grid
    lifted = height + 5e-3 * scene.span
    (x0, y0), (x1, y1) = box[:, :2, 0].min(axis=0), box[:, :2, 1].max(axis=0)
    xs, ys = multiples(x0, x1, step), multiples(y0, y1, step)
    ends = [np.array([[x, y0, lifted], [x, y1, lifted]]) for x in xs]
    ends += [np.array([[x0, y, lifted], [x1, y, lifted]]) for y in ys]
    corners = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
    plain = np.column_stack([corners, np.full(4, height + 1e-3 * scene.span)])
    seen = float(np.ptp(box[0, 0])) / step
    each = max(1, math.ceil(seen / _MOST_MARKS))
    marked = xs[np.round(xs / step).astype(int) % each == 0]
    quiet: Attributes = {"hoverinfo": "skip", "showlegend": False}
    return [
        Trace(
            _mesh(plain, np.array([[0, 1, 2], [0, 2, 3]]))
            | quiet
            | {"color": LAND, "lighting": {"ambient": 1.0, "diffuse": 0.0, "specular": 0.0}}
        ),
        Trace(_lines(ends) | quiet | {"line": {"color": GRID, "width": 1.5}}),
        Trace(
            {
                "type": "scatter3d",
                "mode": "text",
                **_places(np.array([[x, y0, lifted] for x in marked])),
                "text": [f"{x:g} m".replace("-", "−") for x in marked],
                "textfont": {"size": 11, "color": "#7d8c74"},
            }
            | quiet
        ),
    ]


def _way(stage: Stage, scene: Scene) -> list[Trace]:
    height = stage.ground(scene)
    ground = scene.path.copy()
    ground[:, 2] = height + 8e-3 * scene.span
    hover = "path: %{x:.2f} m ahead, %{y:.2f} m to the left, %{z:.2f} m up<extra></extra>"
    found = [
        Trace(
            _lines([scene.path])
            | {"line": {"color": TRACK, "width": 3}, "hovertemplate": hover, "showlegend": False}
        ),
        Trace(
            _lines([ground])
            | {
                "line": {"color": TRACK, "width": 2, "dash": "dot"},
                "hovertemplate": "ground track: %{x:.2f} m<extra></extra>",
                "showlegend": False,
            }
        ),
    ]
    if scene.mode is not None:
        found.append(
            Trace(
                _lines([scene.undisturbed])
                | {
                    "line": {"color": "#6d7680", "width": 3, "dash": "dash"},
                    "hovertemplate": "undisturbed path: %{z:.2f} m up<extra></extra>",
                    "showlegend": False,
                }
            )
        )
    return found


def _wings(stage: Stage, scene: Scene, *, bar: bool) -> Trace:
    faces = _strips(scene.chords.shape[2], 2)
    values = np.repeat(scene.border_values[..., None], 2, axis=3)
    colour, most = scene.colour, stage.largest_value
    fixed: Attributes = {
        "type": "mesh3d",
        **_faces(faces),
        "colorscale": VALUES,
        "cmin": -most,
        "cmax": most,
        "showscale": bar,
        "lighting": _SMOOTH,
        "lightposition": {"x": -200, "y": -400, "z": 1000},
        "flatshading": False,
        "hovertemplate": f"{colour.label}: %{{intensity:.3g}} {colour.unit}<extra></extra>",
        "name": "wings",
    }
    if bar:
        fixed["colorbar"] = {
            "title": {"text": f"{colour.label} ({colour.unit})", "side": "right"},
            "thickness": 14,
            "len": 0.55,
            "outlinewidth": 0,
            "x": 0.99,
        }
    return Trace(
        fixed, lambda k: _points(scene.chords[k]) | {"intensity": _small(values[k].ravel())}
    )


def _shadow(stage: Stage, scene: Scene) -> Trace:
    chords = scene.chords.copy()
    chords[..., 2] = stage.ground(scene) + 1.2e-2 * scene.span
    fixed: Attributes = {
        "type": "mesh3d",
        **_faces(_strips(chords.shape[2], 2)),
        "color": "#54604c",
        "opacity": 0.35,
        "hoverinfo": "skip",
        "lighting": {"ambient": 1.0, "diffuse": 0.0, "specular": 0.0},
        "z": _small(chords[0, ..., 2].ravel()),
    }
    return Trace(fixed, lambda k: {key: _points(chords[k])[key] for key in "xy"})


def _wake(stage: Stage, scene: Scene) -> Trace:
    lines, values = stage.wake(scene)
    most = stage.largest_value
    colour = scene.colour
    fixed: Attributes = {
        "type": "scatter3d",
        "mode": "lines",
        "opacity": 0.7,
        "hovertemplate": f"wake, shed at {colour.label} %{{line.color:.3g}} {colour.unit}"
        "<extra></extra>",
        "showlegend": False,
    }
    look: Attributes = {"colorscale": VALUES, "cmin": -most, "cmax": most, "width": 3}

    def at(k: int) -> Attributes:
        shades = np.concatenate([lines_end for row in values[k] for lines_end in (row, row[-1:])])
        return _joined(lines[k]) | {"line": look | {"color": _small(shades)}}

    return Trace(fixed, at)


def _skeleton(scene: Scene) -> list[Trace]:
    along = np.linspace(0, scene.edges.shape[3] - 1, _POINTS_ALONG_AN_EDGE).round().astype(int)

    def edges(k: int) -> Attributes:
        return _joined(scene.edges[k].reshape(-1, *scene.edges.shape[3:])[:, along])

    def sections(k: int) -> Attributes:
        return _joined(scene.chords[k][:, 1:].reshape(-1, 2, 3))

    def feathers(k: int) -> Attributes:
        return _joined(scene.feathers[k].reshape(-1, 2, 3))

    def bones(k: int) -> Attributes:
        return _joined(scene.bones[k])

    lines: Attributes = {"type": "scatter3d", "mode": "lines", "showlegend": False}
    quiet = lines | {"hoverinfo": "skip"}
    return [
        Trace(quiet | {"line": {"color": _SECTION, "width": 1}}, sections),
        Trace(quiet | {"line": {"color": EDGE, "width": 3}}, edges),
        Trace(
            lines
            | {
                "line": {"color": FEATHER, "width": 3},
                "hovertemplate": "feather or section<extra></extra>",
            },
            feathers,
        ),
        Trace(
            lines
            | {
                "mode": "lines+markers",
                "line": {"color": BONE, "width": 7},
                "marker": {"color": BONE, "size": 3.5},
                "hovertemplate": "bones and joints<extra></extra>",
            },
            bones,
        ),
    ]


def _trunk(scene: Scene) -> list[Trace]:
    solid: Attributes = {"type": "mesh3d", "lighting": _SMOOTH, "hoverinfo": "skip"}
    found = [
        Trace(solid | _faces(scene.body_faces) | {"color": BODY}, lambda k: _points(scene.body[k]))
    ]
    if scene.tail is not None:
        tail = scene.tail
        one = _faces(np.array([[0, 1, 2]]))
        found.append(Trace(solid | one | {"color": TAIL}, lambda k: _points(tail[k])))
    return found


def _forces(stage: Stage, scene: Scene) -> list[Trace]:
    tips = stage.tips(scene)
    sizes = np.linalg.norm(scene.arrow_forces, axis=2)

    def shafts(k: int) -> Attributes:
        lines = np.stack([scene.arrow_points[k], tips[k]], axis=1)
        return _joined(lines) | {"text": np.repeat([f"{f:.3g}" for f in sizes[k]], 3).tolist()}

    faces = _cones(tips.shape[1])
    return [
        Trace(
            {
                "type": "scatter3d",
                "mode": "lines",
                "line": {"color": FORCE, "width": 5},
                "hovertemplate": "force of the air here: %{text} N<extra></extra>",
                "showlegend": False,
            },
            shafts,
        ),
        Trace(
            {
                "type": "mesh3d",
                **_faces(faces),
                "color": FORCE,
                "lighting": _SMOOTH,
                "hoverinfo": "skip",
            },
            lambda k: _points(_heads(scene.arrow_points[k], tips[k])),
        ),
    ]


def _heads(roots: FloatArray, tips: FloatArray) -> FloatArray:
    """Vertices (A, 1 + S, 3) m of the heads of arrows (A, 3): tip, then around its base."""
    along = tips - roots
    length = np.linalg.norm(along, axis=1, keepdims=True)
    unit = along / np.maximum(length, np.finfo(float).tiny)
    # Square to the arrow, from whichever axis it is furthest from.
    other = np.eye(3)[np.abs(unit).argmin(axis=1)]
    aside = np.cross(unit, other)
    aside /= np.maximum(np.linalg.norm(aside, axis=1, keepdims=True), np.finfo(float).tiny)
    upright = np.cross(unit, aside)
    angles = 2.0 * np.pi * np.arange(_HEAD_SIDES) / _HEAD_SIDES
    round_about = (
        np.cos(angles)[:, None] * aside[:, None] + np.sin(angles)[:, None] * upright[:, None]
    )
    base = tips[:, None] - _HEAD_LENGTH * along[:, None]
    base = base + _HEAD_WIDTH * length[:, None] * round_about
    return np.concatenate([tips[:, None], base], axis=1)


def _cones(count: int) -> IntArray:
    around = np.arange(_HEAD_SIDES)
    one = np.column_stack([np.zeros_like(around), 1 + around, 1 + (around + 1) % _HEAD_SIDES])
    return np.concatenate([one + (1 + _HEAD_SIDES) * k for k in range(count)])


def _strips(length: int, count: int) -> IntArray:
    """Triangles (T, 3) of `count` strips between two rows of `length` points, taken in turn."""
    here = 2 * np.arange(length - 1)
    quads = np.column_stack([here, here + 1, here + 3, here + 2])
    one = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return np.concatenate([one + 2 * length * k for k in range(count)])


def _mesh(points: FloatArray, faces: IntArray) -> Attributes:
    return {"type": "mesh3d", **_points(points), **_faces(faces)}


def _lines(lines: list[FloatArray]) -> Attributes:
    return {"type": "scatter3d", "mode": "lines", **_joined(np.array(lines))}


def _joined(lines: FloatArray) -> Attributes:
    """Lines (L, P, 3) as one, with a gap after each."""
    gap = np.full((len(lines), 1, 3), np.nan)
    return _points(np.concatenate([lines, gap], axis=1))


def _points(points: FloatArray) -> Attributes:
    """Coordinates of points (..., 3)."""
    return _places(points.reshape(-1, 3))


def _places(points: FloatArray) -> Attributes:
    return {key: _small(values) for key, values in zip("xyz", points.T, strict=True)}


def _faces(faces: IntArray) -> Attributes:
    return {key: of.astype(np.uint16) for key, of in zip("ijk", faces.T, strict=True)}


def _small(values: FloatArray) -> FloatArray:
    """Values as a page stores them: pictures need no more digits, and half the bytes."""
    return np.asarray(values, dtype=np.float32)
