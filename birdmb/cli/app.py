"""The commands and their options."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from birdmb.cli.outcome import reported

app = typer.Typer(
    name="birdmb",
    help=(
        "Limit cycles, Floquet multipliers and power of flapping birds.\n\n"
        "A topology file (TOML) describes the bird; `birdmb check` says what it describes, "
        "`birdmb cycle` finds the flight that repeats itself every wingbeat and says whether it is "
        "stable."
    ),
    epilog=(
        "Examples:\n\n"
        "birdmb check topologies/ibis.toml\n\n"
        "birdmb cycle topologies/ibis_compliant_shoulder.toml --out results\n\n"
        "birdmb cycle topologies/ibis.toml --set body.mass=1.3 --json"
    ),
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="markdown",
    context_settings={"help_option_names": ["-h", "--help"]},
)


class ModelName(StrEnum):
    """Which model flies the bird."""

    MULTIBODY = "multibody"
    RIGID = "rigid"


class Method(StrEnum):
    """How the orbit is searched for."""

    NEWTON = "newton"
    LEVENBERG_MARQUARDT = "levenberg-marquardt"


Topology = Annotated[Path, typer.Argument(help="Topology file of the bird (TOML).")]
Assignments = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="Change a value of the bird by its dotted name: body.mass=1.3, "
        "shoulder.flap.stiffness=20, wing.discretisation=published. Repeatable.",
    ),
]


def _show_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version  # noqa: PLC0415

        typer.echo(f"birdmb {version('birdmb')}")
        raise typer.Exit


@app.callback()
def _everywhere(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_show_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
) -> None:
    pass


@app.command(
    epilog=(
        "Exit status: 0 found; 1 no limit cycle found (the flight diverged, or the search did not "
        "converge); 2 wrong topology, value or option; 130 interrupted.\n\n"
        'With --json a failure is an object with the key "error", and as far as the search got: '
        '"x" (name to value), "residual", "iterations".\n\n'
        "Example: birdmb cycle topologies/ibis.toml --set shoulder.flap.stiffness=20 --out results"
    )
)
def cycle(
    topology: Topology,
    model: Annotated[
        ModelName,
        typer.Option(
            metavar="MODEL",
            help="multibody: body and wings with mass, joints prescribed or compliant (Exudyn). "
            "rigid: massless wings, all joints prescribed.",
        ),
    ] = ModelName.MULTIBODY,
    assignments: Assignments = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Write the result (cycle.nc) and figures (PNG) into this directory.",
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print one JSON object to standard output, no tables.")
    ] = False,
    segments: Annotated[
        int,
        typer.Option(
            min=1, metavar="N", help="Shooting segments; more tame strongly unstable flights."
        ),
    ] = 1,
    tolerance: Annotated[
        float,
        typer.Option(
            metavar="X", help="Closure error accepted, in units of the states' typical sizes."
        ),
    ] = 1e-9,
    max_iterations: Annotated[
        int, typer.Option(min=1, metavar="N", help="Iterations allowed.")
    ] = 50,
    method: Annotated[
        Method,
        typer.Option(
            metavar="METHOD",
            help="newton, or levenberg-marquardt: takes longer, starts from further away.",
        ),
    ] = Method.NEWTON,
    steps_per_beat: Annotated[
        int | None,
        typer.Option(
            min=4,
            metavar="N",
            help="Integration steps per wingbeat.",
            show_default="the model chooses",
        ),
    ] = None,
) -> None:
    """Find the limit cycle of a bird, its Floquet multipliers, speed and power.

    The search starts from a guess of its own. Progress goes to standard error, the result to
    standard output.
    """
    with reported(as_json=json):
        from birdmb.cli.birds import requested_bird  # noqa: PLC0415

        bird = requested_bird(topology, assignments or [])

        from birdmb.cli.cycle import Search, run  # noqa: PLC0415 - not before the bird is sound

        run(
            bird,
            Search(
                model=model.value,
                segments=segments,
                tolerance=tolerance,
                max_iterations=max_iterations,
                method=method.value,
                steps_per_beat=steps_per_beat,
            ),
            out=out,
            as_json=json,
        )


@app.command(
    epilog="Exit status: 0 a possible bird, warnings or not; 2 not a possible bird.\n\n"
    "Example: birdmb check topologies/ibis.toml --set segments.hand.mass=0.02"
)
def check(topology: Topology, assignments: Assignments = None) -> None:
    """Validate a topology file and say what bird it describes.

    Masses, span, joints with their drivers, springs and dampers, discretisation, and warnings.
    """
    with reported():
        from birdmb.cli.birds import requested_bird  # noqa: PLC0415

        bird = requested_bird(topology, assignments or [])

        from birdmb.cli.check import run  # noqa: PLC0415

        run(bird)


def main() -> None:
    """Run the command line."""
    app()
