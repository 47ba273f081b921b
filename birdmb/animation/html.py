"""A flying bird as one page of HTML that a browser turns, zooms and plays, without a network."""

from __future__ import annotations

import html
from importlib.resources import files
from typing import Any

import numpy as np
import plotly.graph_objects as go

from birdmb._typing import FloatArray
from birdmb.animation.stage import Stage
from birdmb.animation.traces import traces

_MILLISECONDS = 40  # a frame
# Of the camera, in plotly's units of the box: where it stands from what it looks at.
_STANDS = {"bird": (-0.74, -0.66, 0.58), "path": (-0.45, -1.3, 0.6)}
_FONT = "system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"
_INK, _FAINT = "#27303a", "#67727e"
# Plotly's own mark and its links lead to the network.
_CONFIG = {"displaylogo": False, "responsive": True, "plotlyServerURL": "", "topojsonURL": ""}


def figure_of(stage: Stage) -> go.Figure:
    """The figure, with a frame for each instant, a button that plays them and a slider."""
    count = len(stage.scenes)
    names = ["scene" if i == 0 else f"scene{i + 1}" for i in range(count)]
    parts = [
        trace
        for i, (scene, name) in enumerate(zip(stage.scenes, names, strict=True))
        for trace in traces(stage, scene, name, first=i == 0)
    ]
    moving = [i for i, part in enumerate(parts) if part.at is not None]
    boxes = [stage.box(scene) for scene in stage.scenes]
    frames = []
    for k in range(stage.frames):
        data = [parts[i].changed(k) for i in moving]
        ranges = {
            name: {f"{axis}axis": {"range": box[k, i].tolist()} for i, axis in enumerate("xyz")}
            for name, box in zip(names, boxes, strict=True)
        }
        layout = {} if stage.view == "path" else ranges
        frames.append(go.Frame(name=str(k), data=data, traces=moving, layout=layout))
    layout = _layout(stage) | {
        name: _scene(stage, box[0], i / count, (i + 1) / count)
        for i, (name, box) in enumerate(zip(names, boxes, strict=True))
    }
    return go.Figure(data=[part.whole(0) for part in parts], frames=frames, layout=layout)


def page(stage: Stage) -> str:
    """The whole page."""
    assets = files("birdmb.animation").joinpath("page")
    figure = figure_of(stage).to_html(
        config=_CONFIG,
        include_plotlyjs=True,
        include_mathjax=False,
        full_html=False,
        auto_play=False,
        default_width="100%",
        default_height="100%",
        post_script=assets.joinpath("player.js").read_text(encoding="utf-8"),
        div_id="flight",
    )
    title = html.escape("; ".join(scene.title for scene in stage.scenes))
    style = assets.joinpath("page.css").read_text(encoding="utf-8")
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{title}</title>\n<style>\n{style}</style>\n</head>\n<body>\n{figure}\n</body>\n"
        f"</html>\n"
    )


def _scene(stage: Stage, box: FloatArray, left: float, right: float) -> dict[str, Any]:
    hidden = {"visible": False, "showspikes": False}
    axes = {
        f"{axis}axis": {**hidden, "range": box[i].tolist(), "autorange": False}
        for i, axis in enumerate("xyz")
    }
    return {
        **axes,
        # True proportions of the box: plotly's "data" are those of all that is ever in it.
        "aspectmode": "manual",
        "aspectratio": dict(zip("xyz", _units(box).tolist(), strict=True)),
        "camera": _camera(stage, box),
        "domain": {"x": [left, right], "y": [0.0, 1.0]},
        "uirevision": "kept",
        "dragmode": "orbit",
    }


def _units(box: FloatArray) -> FloatArray:
    """Sides (3,) of a box in the units of plotly's camera."""
    sides = box[:, 1] - box[:, 0]
    return np.asarray(sides / np.prod(sides) ** (1.0 / 3.0))


def _camera(stage: Stage, box: FloatArray) -> dict[str, Any]:
    looks_at = _units(box) * stage.focus
    distance = len(stage.scenes) ** 0.4
    if stage.view == "path":
        distance *= max(1.0, 0.48 * float(_units(box).max()))
    eye = looks_at + distance * np.array(_STANDS[stage.view])
    return {
        "center": dict(zip("xyz", looks_at.tolist(), strict=True)),
        "eye": dict(zip("xyz", eye.tolist(), strict=True)),
        "up": {"x": 0, "y": 0, "z": 1},
    }


def _layout(stage: Stage) -> dict[str, Any]:
    return {
        "font": {"family": _FONT, "color": _INK, "size": 13},
        "paper_bgcolor": "rgba(0,0,0,0)",
        "margin": {"l": 0, "r": 0, "t": 74, "b": 118},
        "uirevision": "kept",
        "modebar": {
            "bgcolor": "rgba(0,0,0,0)",
            "color": "#8a97a3",
            "activecolor": _INK,
            "orientation": "v",
        },
        "annotations": [*_titles(stage), _caption(stage)],
        "sliders": [_slider(stage)],
        "updatemenus": [_buttons()],
    }


def _titles(stage: Stage) -> list[dict[str, Any]]:
    count = len(stage.scenes)
    found = []
    for i, scene in enumerate(stage.scenes):
        lines = [f"<b>{html.escape(scene.title)}</b>", scene.flight, *scene.remarks]
        small = f"<span style='font-size:12px;color:{_FAINT}'>"
        text = "<br>".join([lines[0], *(f"{small}{html.escape(t)}</span>" for t in lines[1:])])
        found.append(
            {
                "text": text,
                "x": (i + 0.5) / count,
                "y": 1.0,
                "yshift": 70,
                "xref": "paper",
                "yref": "paper",
                "xanchor": "center",
                "yanchor": "top",
                "showarrow": False,
                "font": {"size": 16},
            }
        )
    return found


def _caption(stage: Stage) -> dict[str, Any]:
    text = (
        f"orange: force of the air, {stage.metres_per_newton:g} m per N · lines on the ground "
        f"every {stage.grid:g} m · the body's shape is indicative<br>wake lines: where the "
        "trailing edge was in still air, in the colour that the wing had there"
    )
    return {
        "text": text,
        "x": 0.5,
        "y": 0.0,
        "yshift": -112,
        "xref": "paper",
        "yref": "paper",
        "xanchor": "center",
        "yanchor": "bottom",
        "showarrow": False,
        "font": {"size": 11, "color": _FAINT},
    }


def _animation(duration: int) -> dict[str, Any]:
    return {
        "mode": "immediate",
        "frame": {"duration": duration, "redraw": True},
        "transition": {"duration": 0},
    }


def _slider(stage: Stage) -> dict[str, Any]:
    first = stage.scenes[0]
    steps = []
    for k, beat in enumerate(first.beats):
        number, phase = divmod(float(beat) + 1e-9, 1.0)
        words = f"beat {int(number) + 1}, {100.0 * phase:.0f} %"
        strokes = list(dict.fromkeys(scene.strokes[k] for scene in stage.scenes))
        label = f"{words}, {' and '.join(strokes)}"
        steps.append({"label": label, "method": "animate", "args": [[str(k)], _animation(0)]})
    # The labels say all of it above the slider; below it they would run into each other.
    return {
        "steps": steps,
        "active": 0,
        "x": 0.09,
        "len": 0.86,
        "y": 0.0,
        "pad": {"t": 14, "b": 0},
        "currentvalue": {"xanchor": "left", "font": {"size": 13, "color": _INK}},
        "font": {"size": 1, "color": "rgba(0,0,0,0)"},
        "ticklen": 0,
        "minorticklen": 0,
        "bgcolor": "#d5dde5",
        "activebgcolor": "#2f5d8a",
        "bordercolor": "#b7c3cf",
        "transition": {"duration": 0},
    }


def _buttons() -> dict[str, Any]:
    return {
        "type": "buttons",
        "direction": "right",
        "showactive": False,
        "x": 0.01,
        "y": 0.0,
        "xanchor": "left",
        "yanchor": "top",
        "pad": {"t": 34},
        "bgcolor": "#ffffff",
        "bordercolor": "#b7c3cf",
        "font": {"size": 15, "color": _INK},
        "buttons": [
            {
                "label": "▶",
                "method": "animate",
                "args": [None, {**_animation(_MILLISECONDS), "fromcurrent": True}],
            },
            {
                "label": "❚❚",
                "method": "animate",
                "args": [[None], _animation(0)],
            },
        ],
    }
