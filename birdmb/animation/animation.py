"""A flight, or two side by side, as a moving picture."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from birdmb.animation.colours import ColourName
from birdmb.animation.scene import Scene, flight_scene, usual_beats, usual_frames
from birdmb.animation.stage import Stage, ViewName
from birdmb.arguments import checked
from birdmb.errors import ArgumentError
from birdmb.files import write_whole
from birdmb.models import FlightCycle

if TYPE_CHECKING:
    import plotly.graph_objects as go

_MOST_BIRDS = 2
_ENDINGS = {
    ".html": "a page for a browser",
    ".mp4": "a film",
    ".gif": "a film without a player",
    ".vtm": "an instant for ParaView",
    ".pvd": "a flight for ParaView",
}


@dataclass(frozen=True)
class Animation:
    """A moving picture; a notebook shows it as a cell's last line.

    Attributes:
        stage: what there is to see.
    """

    stage: Stage

    @property
    def scenes(self) -> tuple[Scene, ...]:
        """The flights, frame by frame, in world axes."""
        return self.stage.scenes

    @property
    def figure(self) -> go.Figure:
        """The plotly figure, to change or to put elsewhere."""
        from birdmb.animation.html import figure_of  # noqa: PLC0415 - slow to import

        return figure_of(self.stage)

    @property
    def page(self) -> str:
        """One page of HTML that plays without a network."""
        from birdmb.animation.html import page  # noqa: PLC0415 - slow to import

        return page(self.stage)

    def save(self, path: str | Path, *, phase: float = 0.0) -> list[Path]:
        """Write it as what the file's ending says: .html, .mp4, .gif, .vtm or .pvd.

        Args:
            path: file to write; others of .vtm and .pvd go into a directory beside it.
            phase: part of the first beat, 0 to 1, at which a .vtm shows the flight.

        Returns:
            What was written, the file itself first.

        Raises:
            ArgumentError: another ending, or a phase out of bounds.
            OutputError: the file cannot be written, or what writes it is not installed.
        """
        path = Path(path)
        ending = require_ending(path)
        if ending == ".html":
            return [write_whole(path, self.page.encode())]
        if ending in {".mp4", ".gif"}:
            from birdmb.animation.movie import movie  # noqa: PLC0415 - slow to import

            return [write_whole(path, movie(self.stage, ending))]
        from birdmb.animation.vtk import write_instant, write_series  # noqa: PLC0415 - an extra

        if ending == ".pvd":
            return write_series(self.stage, path)
        if not 0.0 <= phase <= 1.0:
            raise ArgumentError(f"phase must be from 0 to 1, not {phase}.")
        return write_instant(self.stage, path, phase)

    def _repr_html_(self) -> str:
        inner = html.escape(self.page)
        style = "width:100%;height:620px;border:0"
        return f'<iframe title="a flight" style="{style}" srcdoc="{inner}"></iframe>'


def require_ending(path: Path) -> str:
    """Ending of a file that an animation can be written into; raises `ArgumentError`."""
    ending = path.suffix.lower()
    if ending not in _ENDINGS:
        listed = ", ".join(f"{each} ({what})" for each, what in _ENDINGS.items())
        raise ArgumentError(f"{path}: the file's ending must be one of {listed}.")
    return ending


@checked
def animate(
    cycles: Sequence[FlightCycle],
    *,
    beats: int | None = None,
    frames: int | None = None,
    colour: ColourName = "circulation",
    mode: int | None = None,
    scale: float | None = None,
    view: ViewName = "bird",
) -> Animation:
    """The moving picture of one flight, or of two side by side, each at the same phase of its beat.

    Args:
        cycles: one or two limit cycles of birds.
        beats: see `birdmb.animation.scene.flight_scene`, as of the next four.
        frames: pictures of each beat.
        colour: what the wings are coloured by: "circulation", "incidence" or "load".
        mode: position of a Floquet mode along which to fly.
        scale: its amplitude at the start.
        view: "bird": the camera flies along; "path": it sees the whole flight.

    Raises:
        ArgumentError: wrong numbers or names, or another number of cycles.
        StateError: a disturbed flight leaves what the model can tell.
    """
    if not 1 <= len(cycles) <= _MOST_BIRDS:
        raise ArgumentError(f"an animation shows one bird or two, not {len(cycles)}.")
    beats = usual_beats(mode) if beats is None else beats
    frames = usual_frames(beats, len(cycles)) if frames is None else frames
    scenes = [
        flight_scene(cycle, beats=beats, frames=frames, colour=colour, mode=mode, scale=scale)
        for cycle in cycles
    ]
    return Animation(Stage(tuple(scenes), view))
