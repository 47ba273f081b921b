"""What scenes that are seen together share: lengths, colours, and where each camera looks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.ndimage import uniform_filter1d

from birdmb._typing import FloatArray
from birdmb.animation.scene import Scene
from birdmb.errors import ArgumentError
from birdmb.figures.wing import round_below

ViewName = Literal["bird", "path"]

# In spans: room behind, ahead, on either side, below and above the bird.
_BEHIND, _AHEAD, _ASIDE, _BELOW, _ABOVE = 2.1, 0.75, 0.72, 0.22, 0.08
_LONGEST_ARROW = 0.42
_WAKE_LINES = 7
_FINEST, _GRID_PER_SPAN = 0.1, 0.45


@dataclass(frozen=True)
class Stage:
    """Scenes on one scale of length, colour and force, frame by frame in the same phase.

    Attributes:
        scenes: one or two.
        view: "bird": the camera flies along; "path": it sees the whole flight.
    """

    scenes: tuple[Scene, ...]
    view: ViewName = "bird"

    def __post_init__(self) -> None:
        """Raise `ArgumentError` where the scenes do not fit each other or the view is unknown."""
        if self.view not in {"bird", "path"}:
            raise ArgumentError(f'view must be "bird" or "path", not "{self.view}".')
        first = self.scenes[0]
        for other in self.scenes[1:]:
            if other.colour.name != first.colour.name or other.beats.shape != first.beats.shape:
                raise ArgumentError(
                    "birds that are seen together need the same beats, frames and colour."
                )

    @property
    def frames(self) -> int:
        """Number of frames."""
        return len(self.scenes[0].times)

    @property
    def metres_per_newton(self) -> float:
        """Length of the force arrows."""
        span = max(scene.span for scene in self.scenes)
        largest = max(
            float(np.linalg.norm(scene.arrow_forces, axis=2).max()) for scene in self.scenes
        )
        return round_below(_LONGEST_ARROW * span / largest)

    @property
    def largest_value(self) -> float:
        """Largest modulus of the colours' values; 1 where all are zero."""
        return max(float(np.abs(scene.values).max()) for scene in self.scenes) or 1.0

    @property
    def grid(self) -> float:
        """Distance of the lines on the ground, m."""
        return max(_FINEST, round_below(_GRID_PER_SPAN * max(s.span for s in self.scenes)))

    @property
    def focus(self) -> FloatArray:
        """Place (3,) in the box that the camera looks at, -0.5 to 0.5 from side to side."""
        if self.view == "path":
            return np.zeros(3)
        return np.array([_BEHIND / (_BEHIND + _AHEAD) - 0.5 - 0.05, 0.0, -0.06])

    def ground(self, scene: Scene) -> float:
        """Height of the level on which the bird's track is drawn, m."""
        return scene.lowest - _BELOW * scene.span

    def box(self, scene: Scene) -> FloatArray:
        """Lowest and highest x, y, z (F, 3, 2) m of what the camera sees at each frame."""
        span = max(each.span for each in self.scenes)
        path = scene.path if self.view == "path" else self.steady(scene)
        low = path - np.array([_BEHIND if self.view == "bird" else _AHEAD, _ASIDE, 0.0]) * span
        high = path + np.array([_AHEAD, _ASIDE, 0.0]) * span
        heights = [self._heights(each) for each in self.scenes]
        low[:, 2] = self.ground(scene)
        high[:, 2] = low[:, 2] + max(top - bottom for bottom, top in heights)
        if self.view == "path":
            low[:], high[:] = low.min(axis=0), high.max(axis=0)
        return np.stack([low, high], axis=2)

    def steady(self, scene: Scene) -> FloatArray:
        """Path (F, 3) m of a camera that flies along, without what happens within a beat."""
        return _smooth(scene.path, scene.frames_per_beat)

    def tips(self, scene: Scene) -> FloatArray:
        """Tips (F, A, 3) m of the force arrows."""
        return scene.arrow_points + self.metres_per_newton * scene.arrow_forces

    def wake(self, scene: Scene) -> tuple[FloatArray, FloatArray]:
        """Lines (F, L, W, 3) m that the trailing edge left in still air, and colours (F, L, W).

        Over the last beat, NaN before the first frame; each point keeps the value of the colour
        that the wing had there.
        """
        borders = scene.chords.shape[2] - 1
        chosen = np.unique(np.linspace(1, borders, _WAKE_LINES).round().astype(int))
        count, window = len(scene.times), scene.frames_per_beat + 1
        edge = scene.chords[:, :, chosen, 1].reshape(count, -1, 3)
        values = scene.border_values[:, :, chosen].reshape(count, -1)
        at = np.arange(count)[:, None] - np.arange(window)[::-1]
        lines, colours = edge[np.maximum(at, 0)], values[np.maximum(at, 0)]
        lines[at < 0] = np.nan
        return lines.swapaxes(1, 2), colours.swapaxes(1, 2)

    def _heights(self, scene: Scene) -> tuple[float, float]:
        top = max(scene.highest, float(self.tips(scene)[..., 2].max()))
        return self.ground(scene), top + _ABOVE * scene.span


def multiples(first: float, last: float, step: float) -> FloatArray:
    """Multiples of a step from `first` to `last`: where the lines on the ground are."""
    return np.asarray(step * np.arange(np.ceil(first / step), np.floor(last / step) + 1))


def _smooth(path: FloatArray, frames: int) -> FloatArray:
    """A path (F, 3) without what happens within a beat."""
    trend = path[0] + np.linspace(0.0, 1.0, len(path))[:, None] * (path[-1] - path[0])
    return np.asarray(trend + uniform_filter1d(path - trend, frames, axis=0, mode="nearest"))
