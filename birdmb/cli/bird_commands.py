"""The commands that list, make and scale birds, and their options."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from birdmb.cli.options import Json, number
from birdmb.cli.outcome import reported

commands = typer.Typer()


@commands.command(epilog="Exit status: 0.\n\nExample: birdmb birds")
def birds(json: Json = False) -> None:
    """List the birds that come with the package, which every command takes by their names."""
    with reported(as_json=json):
        from birdmb.cli.birds_list import run  # noqa: PLC0415

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
        from birdmb.cli.new import run  # noqa: PLC0415

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
        str, typer.Option(metavar="BIRD", help="The bird of the package, or file, to scale.")
    ] = "ibis",
    out: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write it here.", show_default="standard output"),
    ] = None,
) -> None:
    """Scale a bird to another mass, span or frequency; what is not given follows from allometry."""
    with reported():
        from birdmb.cli.scale import run  # noqa: PLC0415

        run(mass, span, frequency, like, out)
