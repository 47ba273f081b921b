"""The commands and their options."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from birdmb.cli.bird_commands import commands as bird_commands
from birdmb.cli.completion import dotted_names
from birdmb.cli.drawing import ignore_settings, requested_pictures
from birdmb.cli.flight_commands import commands as flight_commands
from birdmb.cli.options import (
    MOST_STEPS,
    Assignments,
    Damping,
    DampingChoice,
    Formats,
    Json,
    Method,
    MethodChoice,
    ModelChoice,
    ModelName,
    MotionChoice,
    MotionOption,
    Segments,
    StepsPerBeat,
    Tolerance,
    Topology,
    Width,
    number,
)
from birdmb.cli.outcome import InputError, reported
from birdmb.cli.show_command import commands as show_command
from birdmb.cli.study_commands import commands as study_commands

_LARGEST = 1e15  # of all numbers in a topology file

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
    pretty_exceptions_enable=False,
    rich_markup_mode="markdown",
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _show_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version  # noqa: PLC0415 - slow to import

        typer.echo(f"birdmb {version('birdmb')}")
        raise typer.Exit


@app.callback()
def _everywhere(
    version: Annotated[  # noqa: ARG001 - its callback answers
        bool,
        typer.Option(
            "--version", callback=_show_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
) -> None:
    with reported():
        ignore_settings()


@app.command(
    epilog=(
        "Exit status: 0 found; 1 no limit cycle found (the flight diverged, or the search did not "
        "converge), or what was found is no flight; 2 wrong topology, value or option; 130 "
        "interrupted.\n\n"
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
    motion: MotionOption = MotionChoice.PLANAR,
    assignments: Assignments = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Write the result (cycle.nc) and figures into this directory.",
        ),
    ] = None,
    formats: Formats = None,
    width: Width = None,
    json: Json = False,
    segments: Segments = None,
    tolerance: Tolerance = 1e-9,
    max_iterations: Annotated[
        int, typer.Option(min=1, metavar="N", help="Iterations allowed.")
    ] = 50,
    method: MethodChoice = Method.AUTO,
    damping: DampingChoice = Damping.LINE_SEARCH,
    steps_per_beat: StepsPerBeat = None,
    guess: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Start from this cycle (cycle.nc of --out, or of another bird), or from one of a "
            "branch (file of `birdmb branch`, with --point).",
            show_default="a guess of its own",
        ),
    ] = None,
    point: Annotated[
        int | None,
        typer.Option(
            metavar="N", help="Which flight of a branch to start from: 1 the first, -1 the last."
        ),
    ] = None,
    memory: Annotated[
        bool,
        typer.Option(
            "--memory",
            help="Fly the bird once more with the other air.wake, unsteady or quasi-steady, and "
            "say what the memory of the air changes.",
        ),
    ] = False,
) -> None:
    """Find the limit cycle of a bird, its Floquet multipliers, speed and power.

    The search starts from a guess of its own, and where that leads to no flight, from many others
    (`birdmb flights` shows all that these lead to). Progress goes to standard error, the result to
    standard output.
    """
    with reported(as_json=json):
        from birdmb.cli.birds import requested_bird  # noqa: PLC0415 - slow to import

        pictures = requested_pictures(formats, width)
        bird = requested_bird(topology, assignments or [])

        from birdmb.cli.cycle import run  # noqa: PLC0415 - not before the bird is sound
        from birdmb.cli.saved_guess import requested_guess  # noqa: PLC0415 - slow to import
        from birdmb.cli.searching import Search  # noqa: PLC0415 - slow to import

        run(
            bird,
            Search(
                model=model.value,
                motion=motion.value,
                segments=segments,
                tolerance=tolerance,
                max_iterations=max_iterations,
                method=method.value,
                damping=damping.value,
                steps_per_beat=steps_per_beat,
            ),
            guess=requested_guess(guess, point),
            out=out,
            pictures=pictures,
            as_json=json,
            with_memory=memory,
        )


@app.command(
    epilog="Exit status: 0 a possible bird, warnings or not; 2 not a possible bird.\n\n"
    "Example: birdmb check topologies/ibis.toml --set segments.hand.mass=0.02"
)
def check(topology: Topology, assignments: Assignments = None, json: Json = False) -> None:
    """Validate a topology file and say what bird it describes.

    Masses, span, joints with their drivers, springs and dampers, discretisation, and warnings.
    """
    with reported(as_json=json):
        from birdmb.cli.birds import requested_bird  # noqa: PLC0415 - slow to import

        bird = requested_bird(topology, assignments or [])

        from birdmb.cli.check import run  # noqa: PLC0415 - slow to import

        run(bird, as_json=json)


@app.command(
    epilog=(
        "Exit status: 0 followed, to an end of the range or not; 1 no flight at the start of the "
        "range; 2 wrong topology, value or option; 130 interrupted.\n\n"
        "Example: birdmb branch topologies/ibis_compliant_shoulder.toml --parameter "
        "shoulder.flap.stiffness --from 60 --to 2 --out results"
    )
)
def branch(
    topology: Topology,
    parameter: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            autocompletion=dotted_names,
            help="Dotted name of the number to vary: shoulder.flap.stiffness, gait.frequency, "
            "wing.root.x.",
        ),
    ],
    start: Annotated[
        float,
        typer.Option(
            "--from",
            metavar="X",
            help="Where the branch starts.",
            callback=number("--from", -_LARGEST, _LARGEST, "no value of a bird is larger"),
        ),
    ],
    stop: Annotated[
        float,
        typer.Option(
            "--to",
            metavar="X",
            help="Which way it goes, and the end of the range.",
            callback=number("--to", -_LARGEST, _LARGEST, "no value of a bird is larger"),
        ),
    ],
    model: ModelChoice = ModelName.MULTIBODY,
    assignments: Assignments = None,
    max_points: Annotated[
        int, typer.Option(min=2, metavar="N", help="Flights allowed, those resumed from included.")
    ] = 200,
    store: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Keep the branch in this file (NetCDF), saved after every point.",
            show_default="branch.nc in the directory of --out",
        ),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with the branch in that file, if there is one.")
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Write a picture (branch.png) into this directory."),
    ] = None,
    formats: Formats = None,
    width: Width = None,
    json: Json = False,
    method: MethodChoice = Method.AUTO,
    segments: Segments = None,
    tolerance: Tolerance = 1e-9,
    longest_step: Annotated[
        float,
        typer.Option(
            callback=number("--longest-step", 1e-6, 10.0, "1 is about the whole range"),
            metavar="X",
            help="Longest step along the branch, in parameter ranges and typical sizes of states.",
        ),
    ] = 0.1,
    steps_per_beat: Annotated[
        int | None,
        typer.Option(
            min=4,
            max=MOST_STEPS,
            metavar="N",
            help="Integration steps per wingbeat. Given, shooting is taken.",
            show_default="the most the model chooses over the range",
        ),
    ] = None,
) -> None:
    """Follow the limit cycle of a bird in one parameter, past folds, and find where stability ends.

    Each flight is a line on standard error and is saved at once; a run that was stopped goes on
    with --resume, on the very same branch. Folds, period doublings and Neimark-Sacker bifurcations
    between the flights are located.
    """
    with reported(as_json=json):
        from birdmb.cli.birds import requested_bird  # noqa: PLC0415 - slow to import

        pictures = requested_pictures(formats, width)
        bird = requested_bird(topology, assignments or [], {parameter: start})

        from birdmb.cli.branch import Following, run  # noqa: PLC0415 - slow to import

        run(
            bird,
            Following(
                parameter=parameter,
                start=start,
                stop=stop,
                model=model.value,
                max_points=max_points,
                method=method.value,
                segments=segments,
                tolerance=tolerance,
                steps_per_beat=steps_per_beat,
                longest_step=longest_step,
            ),
            store=store,
            resume=resume,
            out=out,
            pictures=pictures,
            as_json=json,
        )


@app.command(
    epilog="Exit status: 0; 2 wrong option, or a file that cannot be written.\n\n"
    "Example: birdmb schema --out birdmb.schema.json"
)
def schema(
    markdown: Annotated[
        bool, typer.Option("--markdown", help="The page docs/format.md instead of the schema.")
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write it here.", show_default="standard output"),
    ] = None,
) -> None:
    """Print the JSON schema of topology files, with which editors complete keys and mark mistakes.

    A topology file whose first line is `#:schema ./birdmb.schema.json` names its schema.
    """
    with reported():
        from birdmb.cli.schema import run  # noqa: PLC0415 - slow to import

        run(markdown, out)


@app.command(
    epilog="Exit status: 0 all that should agree does; 1 something does not; 2 wrong option; "
    "130 interrupted.\n\nExamples:\n\nbirdmb validate\n\nbirdmb validate --chapter 5 --json"
    "\n\nbirdmb validate --experiments --case A"
)
def validate(
    chapter: Annotated[
        str | None,
        typer.Option(metavar="N", help="This chapter (5) or appendix (A) only."),
    ] = None,
    long: Annotated[bool, typer.Option("--all", help="Those that take minutes, too.")] = False,
    experiments: Annotated[
        bool,
        typer.Option(
            "--experiments",
            help="Experiments, exact solutions and other authors' computations instead, with "
            "quasi-steady and unsteady air (docs/validation.md).",
        ),
    ] = False,
    case: Annotated[
        str | None, typer.Option(metavar="LETTER", help="This experiment only, such as A.")
    ] = None,
    json: Json = False,
    markdown: Annotated[
        bool, typer.Option("--markdown", help="Print the tables of docs/thesis.md.")
    ] = False,
) -> None:
    """Print what the thesis published against what is computed here, with the command behind it.

    Each number passes within its tolerance; else it differs, or the thesis contradicts itself or
    its own program, with the reason. Takes half a minute, with --all some minutes, with
    --experiments a few. `python -m birdmb.reproduction` draws figures and tables.
    """
    with reported(as_json=json):
        if experiments:
            if chapter is not None or long or markdown:
                raise InputError("--experiments goes with --case and --json alone.")

            from birdmb.cli.experiments import run as run_experiments  # noqa: PLC0415 - slow

            run_experiments(case, as_json=json)
            return
        if case is not None:
            raise InputError("--case chooses an experiment; give --experiments with it.")

        from birdmb.cli.validate import run  # noqa: PLC0415 - slow to import

        run(chapter, long=long, as_json=json, as_markdown=markdown)


app.add_typer(study_commands)
app.add_typer(flight_commands)
app.add_typer(show_command)
app.add_typer(bird_commands)
