"""A flying bird as a film (MP4, GIF), drawn by matplotlib in parallel projection."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize, to_rgb
from matplotlib.figure import Figure

from birdmb._typing import FloatArray
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
from birdmb.errors import OutputError
from birdmb.figures.wing import View

_FRAMES_A_SECOND = 25
_WIDTH, _HEIGHT, _DPI = 9.6, 5.4, 100  # inches, and their dots
_SKY = "#e6eef6"
# From behind, from the right and from above, as the page begins.
_VIEW = View.along("oblique", (-0.74, -0.66, 0.62), (0.0, 0.0, 1.0))
# Of the picture, in spans, where the camera flies along.
_HALF_WIDTH = 1.05
_TO_SCALE: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1.0}
_NO_FFMPEG = (
    "films in MP4 are made by ffmpeg, which is not on this machine: pip install 'birdmb[movie]' "
    "brings one, or give a file that ends in .gif."
)


def movie(stage: Stage, ending: str) -> bytes:
    """The film as the content of a file, `ending` in ".mp4" or ".gif".

    Raises:
        OutputError: ffmpeg, which MP4 needs, is not there or fails.
    """
    with matplotlib.rc_context():
        writer = _writer(ending)
        figure, pictures = _figure(stage)
        with tempfile.TemporaryDirectory() as scratch:
            path = Path(scratch) / f"flight{ending}"
            try:
                with writer.saving(figure, str(path), _DPI):
                    for k in range(_shown(stage)):
                        for picture in pictures:
                            picture.draw(k)
                        writer.grab_frame(facecolor=_SKY)
                return path.read_bytes()
            except (OSError, RuntimeError) as error:
                raise OutputError(f"the film cannot be made ({error}).") from error


def _shown(stage: Stage) -> int:
    """Number of frames in the film: the last is the first, if it goes round."""
    return stage.frames - (1 if stage.frames > 1 else 0)


def _writer(ending: str) -> AbstractMovieWriter:
    if ending == ".gif":
        return PillowWriter(fps=_FRAMES_A_SECOND)
    try:
        import imageio_ffmpeg  # noqa: PLC0415 - an extra

        matplotlib.rcParams["animation.ffmpeg_path"] = imageio_ffmpeg.get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        pass
    if not FFMpegWriter.isAvailable():
        raise OutputError(_NO_FFMPEG)
    # Players know no other pixels.
    return FFMpegWriter(fps=_FRAMES_A_SECOND, codec="h264", extra_args=["-pix_fmt", "yuv420p"])


def _figure(stage: Stage) -> tuple[Figure, list[_Picture]]:
    figure = Figure(figsize=(_WIDTH, _HEIGHT), facecolor=_SKY)
    count = len(stage.scenes)
    norm = Normalize(-stage.largest_value, stage.largest_value)
    pictures = []
    for i, scene in enumerate(stage.scenes):
        axes = figure.add_axes((0.9 * i / count, 0.06, 0.9 / count, 0.8))
        axes.set_axis_off()
        axes.set_aspect("equal")
        words = "\n".join([scene.title, scene.flight, *scene.remarks])
        figure.text(0.9 * (i + 0.5) / count, 0.98, words, ha="center", va="top", fontsize=9)
        pictures.append(_Picture(axes, stage, scene, norm))
    bar = figure.colorbar(
        ScalarMappable(norm, VALUES), cax=figure.add_axes((0.915, 0.25, 0.014, 0.5))
    )
    colour = stage.scenes[0].colour
    bar.set_label(f"{colour.label} ({colour.unit})", fontsize=9)
    bar.ax.tick_params(labelsize=8)
    figure.text(
        0.01,
        0.015,
        f"force of the air: {stage.metres_per_newton:g} m per N; ground: every {stage.grid:g} m",
        fontsize=7,
        color="0.4",
    )
    return figure, pictures


class _Picture:
    """One bird on its axes, drawn anew at every frame."""

    def __init__(self, axes: Axes, stage: Stage, scene: Scene, norm: Normalize) -> None:
        self._axes, self._stage, self._scene, self._norm = axes, stage, scene, norm
        self._box, self._tips = stage.box(scene), stage.tips(scene)
        self._wake = stage.wake(scene)
        self._centres, self._half = self._frame()

    def draw(self, k: int) -> None:
        """Draw frame k."""
        axes, scene = self._axes, self._scene
        for artist in [*axes.collections, *axes.texts]:
            artist.remove()
        self._land(k)
        lines, values = (each[k] for each in self._wake)
        self._coloured(lines, values)
        self._lines(scene.path[None], TRACK, 1.0)
        if scene.mode is not None:
            self._lines(scene.undisturbed[None], "0.45", 1.0, style="--")
        self._bird(k)
        self._arrows(k)
        (x, y), (across, up) = self._centres[k], self._half
        axes.set_xlim(x - across, x + across)
        axes.set_ylim(y - up, y + up)
        beat, phase = divmod(float(scene.beats[k]) + 1e-9, 1.0)
        words = f"beat {int(beat) + 1}, {100.0 * phase:.0f} %, {scene.strokes[k]}"
        axes.text(0.03, 1.0, words, transform=axes.transAxes, fontsize=9, va="top")

    def _frame(self) -> tuple[FloatArray, FloatArray]:
        """Centres (F, 2) m of the pictures on paper, and half their width and height (2,) m."""
        # Not as it is now, drawn to scale within empty limits.
        width, height = self._axes.get_position(original=True).size * np.array([_WIDTH, _HEIGHT])
        if self._stage.view == "bird":
            across = _HALF_WIDTH * max(scene.span for scene in self._stage.scenes)
            half = across * np.array([1.0, height / width])
            return _VIEW(self._stage.steady(self._scene)), half
        corners = _VIEW(_corners(self._box[0]))
        low, high = corners.min(axis=0), corners.max(axis=0)
        up = max(0.5 * (high[1] - low[1]), 0.5 * (high[0] - low[0]) * height / width)
        middle = np.broadcast_to(0.5 * (low + high), (len(self._box), 2))
        return middle, 1.02 * up * np.array([width / height, 1.0])

    def _land(self, k: int) -> None:
        (x0, x1), (y0, y1), _ = self._box[k]
        height, step = self._stage.ground(self._scene), self._stage.grid
        corners = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
        self._fill([np.column_stack([corners, np.full(4, height)])], LAND)
        lines = [
            *([[x, y0, height], [x, y1, height]] for x in multiples(x0, x1, step)),
            *([[x0, y, height], [x1, y, height]] for y in multiples(y0, y1, step)),
        ]
        self._lines(np.array(lines), GRID, 0.7)
        shadow = _panels(self._scene.chords[k])
        shadow[..., 2] = height
        self._fill(list(shadow), "#b4bfae")

    def _bird(self, k: int) -> None:
        """Draw wings, body and tail, what is far from the eye first."""
        scene = self._scene
        panels = list(_panels(scene.chords[k]))
        shades = list(matplotlib.colormaps[VALUES](self._norm(scene.values[k].ravel())))
        for faces, colour in self._solids(k):
            panels.extend(faces)
            shades.extend(_lit(faces, colour))
        order = np.argsort([float((panel @ _VIEW.towards).mean()) for panel in panels])
        self._axes.add_collection(
            PolyCollection(
                [_VIEW(panels[i]) for i in order],
                facecolors=[shades[i] for i in order],
                edgecolors="face",
                linewidths=0.4,
                zorder=3,
            )
        )
        self._lines(scene.feathers[k].reshape(-1, 2, 3), FEATHER, 0.7, zorder=3)
        self._lines(scene.edges[k].reshape(-1, *scene.edges.shape[3:]), EDGE, 0.8, zorder=3)
        self._lines(scene.bones[k], BONE, 1.9, zorder=3)

    def _arrows(self, k: int) -> None:
        roots, tips = (_VIEW(each[k]) for each in (self._scene.arrow_points, self._tips))
        self._axes.quiver(
            *roots.T, *(tips - roots).T, color=FORCE, zorder=4, width=0.0035, **_TO_SCALE
        )

    def _coloured(self, lines: FloatArray, values: FloatArray) -> None:
        """Lines (L, W, 3) in the colours of values (L, W), where they are known."""
        seen = _VIEW(lines)
        pairs = np.stack([seen[:, :-1], seen[:, 1:]], axis=2).reshape(-1, 2, 2)
        means = 0.5 * (values[:, :-1] + values[:, 1:]).ravel()
        known = np.isfinite(pairs).all(axis=(1, 2))
        self._axes.add_collection(
            LineCollection(
                list(pairs[known]), array=means[known], norm=self._norm, cmap=VALUES, lw=0.8
            )
        )

    def _lines(
        self, lines: FloatArray, colour: str, width: float, *, style: str = "-", zorder: int = 2
    ) -> None:
        seen = list(_VIEW(lines))
        self._axes.add_collection(
            LineCollection(seen, colors=colour, lw=width, linestyles=style, zorder=zorder)
        )

    def _solids(self, k: int) -> list[tuple[FloatArray, str]]:
        """Triangles (T, 3, 3) m of body and tail, and their colours."""
        scene = self._scene
        found = [(scene.body[k][scene.body_faces], BODY)]
        if scene.tail is not None:
            found.append((scene.tail[k : k + 1], TAIL))
        return found

    def _fill(self, faces: list[FloatArray], colour: str) -> None:
        self._axes.add_collection(
            PolyCollection([_VIEW(face) for face in faces], color=colour, linewidths=0.0)
        )


def _panels(chords: FloatArray) -> FloatArray:
    """Corners (2 N, 4, 3) m of both wings' elements, of chords (2, N + 1, 2, 3)."""
    inner, outer = chords[:, :-1], chords[:, 1:]
    corners = [inner[:, :, 0], outer[:, :, 0], outer[:, :, 1], inner[:, :, 1]]
    return np.stack(corners, axis=2).reshape(-1, 4, 3)


def _corners(box: FloatArray) -> FloatArray:
    """Corners (8, 3) of a box (3, 2)."""
    return np.stack(np.meshgrid(*box, indexing="ij"), axis=-1).reshape(-1, 3)


def _lit(faces: FloatArray, colour: str) -> FloatArray:
    """Colours (T, 3) of triangles (T, 3, 3) under a light from above."""
    normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    sizes = np.maximum(np.linalg.norm(normals, axis=1), np.finfo(float).tiny)
    up = np.abs(normals[:, 2]) / sizes
    return np.asarray((0.68 + 0.32 * up[:, None]) * np.array(to_rgb(colour)))
