"""The commands that list, make and scale birds, and their options."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from birdmb.cli.completion import birds_and_files
from birdmb.cli.drawing import requested_pictures
from birdmb.cli.options import Formats, Json, Width, number
from birdmb.cli.outcome import reported

commands = typer.Typer()


@commands.command(epilog="Exit status: 0.\n\nExample: birdmb birds")
def birds(json: Json = False) -> None:
    """List the birds that come with the package, which every command takes by their names."""
    with reported(as_json=json):
        from birdmb.cli.birds_list import run  # noqa: PLC0415 - slow to import

        run(as_json=json)


@commands.command(
    epilog="Exit status: 0; 2 wrong name or option, or a file that is there or cannot be written."
    "\n\nExamples:\n\nbirdmb new mine.toml --like ibis\n\n"
    "birdmb new pigeon.toml --from examples/pigeon_morphology.toml"
)
def new(
    file: Annotated[Path, typer.Argument(help="Topology file to make (TOML).")],
    like: Annotated[
        str | None,
        typer.Option(
            metavar="BIRD",
            autocompletion=birds_and_files,
            help="A bird of the package, or a topology file, to copy; with --from, whose gait and "
            "joints to take.",
        ),
    ] = None,
    morphology: Annotated[
        Path | None,
        typer.Option(
            "--from",
            metavar="FILE",
            help="A morphology file (TOML), from whose weighed and measured parts masses, centres "
            "of mass and inertias follow.",
        ),
    ] = None,
) -> None:
    """Make a topology file of one's own, from another one with its comments or from morphology."""
    with reported():
        from birdmb.cli.new import run  # noqa: PLC0415 - slow to import

        run(file, like, morphology)


@commands.command(
    epilog="Exit status: 0; 2 wrong value, or a file that cannot be written.\n\n"
    "Example: birdmb scale --mass 0.35 --span 0.65 --frequency 7 --like ibis --out small.toml"
)
def scale(
    mass: Annotated[
        float | None,
        typer.Option(
            metavar="M",
            help="Mass of the whole bird, kg.",
            show_default="that of the span",
            callback=number("--mass", 1e-9, 1e5, "birds weigh 1e-9 to 1e5 kg"),
        ),
    ] = None,
    span: Annotated[
        float | None,
        typer.Option(
            metavar="B",
            help="Span with the wings stretched out, m.",
            show_default="that of the mass",
            callback=number("--span", 1e-4, 1e3, "wings span 0.1 mm to 1 km"),
        ),
    ] = None,
    frequency: Annotated[
        float | None,
        typer.Option(
            metavar="F",
            help="Wingbeats per second, Hz.",
            show_default="that of the mass",
            callback=number("--frequency", 1e-6, 1e6, "mosquitoes have 800"),
        ),
    ] = None,
    like: Annotated[
        str,
        typer.Option(
            metavar="BIRD",
            autocompletion=birds_and_files,
            help="The bird of the package, or file, to scale.",
        ),
    ] = "ibis",
    out: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write it here.", show_default="standard output"),
    ] = None,
) -> None:
    """Scale a bird to another mass, span or frequency; what is not given follows from allometry."""
    with reported():
        from birdmb.cli.scale import run  # noqa: PLC0415 - slow to import

        run(mass, span, frequency, like, out)


@commands.command(
    epilog=(
        "Exit status: 0 fitted; 2 a table that tells no gait, or a wrong topology or option; 130 "
        "interrupted.\n\n"
        "Example: birdmb kinematics points.csv --like pigeon --frame forward-left-up -o mine.toml"
    )
)
def kinematics(
    file: Annotated[
        Path,
        typer.Argument(
            help="Table of points or joint angles over time (CSV, NetCDF or C3D), see "
            "docs/kinematics.md."
        ),
    ],
    like: Annotated[
        str,
        typer.Option(
            metavar="BIRD",
            autocompletion=birds_and_files,
            help="The bird of the package, or topology file, whose joints move so.",
        ),
    ],
    frame: Annotated[
        str | None,
        typer.Option(
            metavar="AXES",
            help="Where the axes x, y and z of points point to: body (forward, right, down), "
            "forward-left-up and the like, or body axes as in --frame=+x-y-z. Not needed beside "
            "markers on the body.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            metavar="FILE",
            help="Write the topology with the fitted gait, its comments kept.",
        ),
    ] = None,
    rate: Annotated[
        float | None,
        typer.Option(
            metavar="HZ",
            help="Frames per second, where there is no column time.",
            callback=number("--rate", 1e-3, 1e6, "no camera is as fast"),
        ),
    ] = None,
    unit: Annotated[
        str | None,
        typer.Option(
            metavar="UNIT", help="Of the points: m, cm or mm.", show_default="the file's, or m"
        ),
    ] = None,
    markers: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Places of markers whose names do not tell it (TOML), as "
            '`p1 = { feather = "1" }` or `back = { body = [0, 0, -0.03] }`.',
        ),
    ] = None,
    frequency: Annotated[
        float | None,
        typer.Option(
            metavar="HZ",
            help="Wingbeat frequency, if it is known, as of one averaged beat.",
            show_default="found",
            callback=number("--frequency", 1e-6, 1e6, "mosquitoes have 800"),
        ),
    ] = None,
    harmonics: Annotated[
        int | None,
        typer.Option(
            min=1, metavar="N", help="Harmonics of each joint.", show_default="all significant"
        ),
    ] = None,
    lengths: Annotated[
        bool, typer.Option("--lengths", help="Give segments their measured lengths.")
    ] = False,
    figure: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Draw measured beside fitted into this file: PNG, PDF or SVG by its ending.",
        ),
    ] = None,
    formats: Formats = None,
    width: Width = None,
    json: Json = False,
) -> None:
    """Fit the gait of a bird to a measured flight: points, or joint angles, over some beats.

    Says how sure offsets, amplitudes and phases are, how far each marker is from the fitted wing,
    and which joints the data do not tell: these keep the topology's own motion.
    """
    with reported(as_json=json):
        from birdmb.cli.kinematics import run  # noqa: PLC0415 - slow to import

        run(
            file,
            like,
            out=out,
            figure=figure,
            pictures=requested_pictures(formats, width, figure),
            as_json=json,
            options={
                "frame": frame,
                "rate": rate,
                "unit": unit,
                "markers": markers,
                "frequency": frequency,
                "harmonics": harmonics,
                "lengths": lengths,
            },
        )
