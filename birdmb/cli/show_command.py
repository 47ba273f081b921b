"""The command `birdmb show` and its options."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from birdmb.cli.completion import birds_and_files
from birdmb.cli.options import Assignments, ModelName, MotionChoice, number
from birdmb.cli.outcome import reported

commands = typer.Typer()


class ColourChoice(StrEnum):
    """What the wings are coloured by."""

    CIRCULATION = "circulation"
    INCIDENCE = "incidence"
    LOAD = "load"


class ViewChoice(StrEnum):
    """Where the camera is."""

    BIRD = "bird"
    PATH = "path"


@commands.command(
    epilog=(
        "Exit status: 0 shown; 1 no limit cycle found, or what was found is no flight; 2 wrong "
        "file, topology, value or option; 130 interrupted.\n\n"
        "Examples:\n\nbirdmb show ibis\n\nbirdmb show ibis_tail --model rigid --motion free "
        "--mode 1 --scale 0.5 --view path\n\n"
        "birdmb show ibis ibis_compliant_shoulder --colour load --out two.html\n\n"
        "birdmb show results/cycle.nc --out flight.gif"
    )
)
def show(
    flight: Annotated[
        str,
        typer.Argument(
            help="Saved cycle (cycle.nc of `birdmb cycle --out`), topology file (TOML) or name of "
            "a bird of the package.",
            autocompletion=birds_and_files,
        ),
    ],
    beside: Annotated[
        str | None,
        typer.Argument(
            help="Another one, shown beside it at the same phase of the beat.",
            autocompletion=birds_and_files,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Write this file. Its ending says what: .html a page that a browser turns, zooms "
            "and plays, without a network; .mp4 (needs ffmpeg) and .gif films; .vtm an instant "
            "and .pvd a flight for ParaView (need the extra birdmb\\[vtk]).",
            show_default="NAME.html in the current directory",
        ),
    ] = None,
    colour: Annotated[
        ColourChoice,
        typer.Option(
            metavar="BY",
            help="Colour the wings by circulation, by incidence (the angle of attack) or by load "
            "(force per area).",
        ),
    ] = ColourChoice.CIRCULATION,
    beats: Annotated[
        int | None,
        typer.Option(
            min=1, max=100, metavar="N", help="Wingbeats to show.", show_default="3, of a mode 6"
        ),
    ] = None,
    frames: Annotated[
        int | None,
        typer.Option(
            min=8,
            max=48,
            metavar="N",
            help="Pictures of a beat.",
            show_default="30, fewer of a long flight",
        ),
    ] = None,
    mode: Annotated[
        int | None,
        typer.Option(
            min=1,
            metavar="N",
            help="Fly along a Floquet mode, which grows or decays: 1 is the first that `birdmb "
            "cycle` lists.",
        ),
    ] = None,
    scale: Annotated[
        float | None,
        typer.Option(
            metavar="X",
            help="Amplitude of the mode at the start, in typical sizes of the states (10 m/s, 2 "
            "m/s, 1 rad/s, 0.2 rad of the body).",
            show_default="such that it stays below 1",
            callback=number("--scale", 1e-9, 1e3, "it is in units of the states' typical sizes"),
        ),
    ] = None,
    view: Annotated[
        ViewChoice,
        typer.Option(
            metavar="VIEW", help="bird: the camera flies along. path: it sees the whole flight."
        ),
    ] = ViewChoice.BIRD,
    phase: Annotated[
        float,
        typer.Option(
            metavar="PERCENT",
            help="Of a .vtm: the phase of the beat, in per cent.",
            callback=number("--phase", 0.0, 100.0, "it is in per cent of a beat"),
        ),
    ] = 0.0,
    model: Annotated[
        ModelName | None,
        typer.Option(
            metavar="MODEL",
            help="multibody or rigid, as for `birdmb cycle`; of topologies.",
            show_default="multibody",
        ),
    ] = None,
    motion: Annotated[
        MotionChoice | None,
        typer.Option(
            metavar="MOTION",
            help="planar or free, as for `birdmb cycle`; of topologies.",
            show_default="planar",
        ),
    ] = None,
    assignments: Assignments = None,
    opened: Annotated[
        bool, typer.Option("--open", help="Open what was written, a page in the browser.")
    ] = False,
) -> None:
    """Show a bird in flight: a page in which the mouse turns it, a film, or files for ParaView.

    Wings over the beat in colour, bones, feathers, tail, forces of the air, wake lines, ground
    track. Of a topology, the flight is found first, as by `birdmb cycle`.
    """
    with reported():
        from birdmb.cli.show import Picture, Wanted, run  # noqa: PLC0415 - slow to import

        run(
            Wanted(
                (flight,) if beside is None else (flight, beside),
                None if model is None else model.value,
                None if motion is None else motion.value,
                tuple(assignments or ()),
            ),
            Picture(
                colour=colour.value,
                beats=beats,
                frames=frames,
                mode=mode,
                scale=scale,
                view=view.value,
                phase=phase / 100.0,
            ),
            out=out,
            opened=opened,
        )
