"""The commands `birdmb sweep` and `birdmb plot` and their options."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from birdmb.cli.completion import assigned_names
from birdmb.cli.drawing import requested_pictures
from birdmb.cli.options import (
    Assignments,
    ClimbRate,
    Damping,
    DampingChoice,
    ExecutorName,
    Formats,
    Method,
    MethodChoice,
    ModelChoice,
    ModelName,
    MotionChoice,
    MotionOption,
    Segments,
    Speed,
    StepsPerBeat,
    Tolerance,
    Topology,
    Width,
    Workers,
)
from birdmb.cli.outcome import reported

commands = typer.Typer()


@commands.command(
    epilog=(
        "Exit status: 0 every point is finished, with a limit cycle or the reason why there is "
        "none; 2 wrong topology, value or option, or a store of another study; 130 interrupted.\n\n"
        "Example: birdmb sweep topologies/ibis_compliant_shoulder.toml --vary "
        "shoulder.flap.stiffness=60:5:24 --vary shoulder.flap.damping=0.2,0.1,0 --store study.db"
    )
)
def sweep(
    topology: Topology,
    vary: Annotated[
        list[str],
        typer.Option(
            metavar="NAME=VALUES",
            autocompletion=assigned_names,
            help="Vary a value of the bird by its dotted name: NAME=FIRST:LAST:COUNT or "
            "NAME=VALUE,VALUE,... Repeatable, for a grid. Begin where the bird flies well: points "
            "start from the flights before them.",
        ),
    ],
    store: Annotated[
        Path,
        typer.Option(
            metavar="FILE",
            help="Keep every finished point in this file (SQLite). If there is one, only what is "
            "missing in it is computed.",
        ),
    ],
    trim: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=LOW:HIGH",
            autocompletion=assigned_names,
            help="Trim the flight of every point by this value of the bird, within the bounds: to "
            "level flight, or as --climb-rate and --speed say. Twice if a speed is wanted.",
        ),
    ] = None,
    climb_rate: ClimbRate = 0.0,
    speed: Speed = None,
    workers: Workers = None,
    executor: ExecutorName = "processes",
    model: ModelChoice = ModelName.MULTIBODY,
    motion: MotionOption = MotionChoice.PLANAR,
    assignments: Assignments = None,
    method: MethodChoice = Method.AUTO,
    damping: DampingChoice = Damping.LINE_SEARCH,
    segments: Segments = None,
    tolerance: Tolerance = 1e-9,
    max_iterations: Annotated[
        int, typer.Option(min=1, metavar="N", help="Iterations allowed at a point.")
    ] = 50,
    steps_per_beat: StepsPerBeat = None,
    keep_to_sheet: Annotated[
        bool,
        typer.Option(
            "--keep-to-sheet",
            help="Follow the flight of the neighbour by smaller steps where the flight found is "
            "on another sheet; where that sheet ends, the point has failed.",
        ),
    ] = False,
) -> None:
    """Find the limit cycles over a grid of values, in parallel; a run that was stopped goes on.

    Every finished point is stored at once, one without a limit cycle with the reason. The results
    do not depend on the number of workers or on interruptions.
    """
    with reported():
        from birdmb.cli.birds import requested_bird  # noqa: PLC0415 - slow to import
        from birdmb.cli.variations import requested_trim, requested_variations  # noqa: PLC0415 - slow to import

        variations = requested_variations(vary)
        first = {name: values[0] for name, values in variations.items()}
        bird = requested_bird(topology, assignments or [], first)
        trimming = requested_trim(bird, trim or [], climb_rate, speed)

        from birdmb.cli.sweep import run  # noqa: PLC0415 - not before all of it is sound

        run(
            bird,
            variations,
            store,
            workers=workers,
            executor=executor,
            model=model.value,
            motion=motion.value,
            steps_per_beat=steps_per_beat,
            trim=trimming,
            search={
                # Steps are of the time integration: who gives them wants it.
                "method": "shooting"
                if steps_per_beat is not None and method == Method.AUTO
                else method.value,
                "damping": damping.value,
                "segments": segments,
                "tolerance": tolerance,
                "max_iterations": max_iterations,
                "keep_to_sheet": keep_to_sheet,
            },
        )


@commands.command(
    epilog=(
        "Exit status: 0 drawn; 2 no study, or no such quantity; 130 interrupted.\n\n"
        "Example: birdmb plot study.db --quantity largest_modulus --out figures"
    )
)
def plot(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE", help="Store of a study, finished or not, or NetCDF file of any result."
        ),
    ],
    quantity: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="largest_modulus, time_constant, power, mean_climb_rate, mean_speed, residual, "
            "... Repeatable.",
            show_default="the first four in one figure",
        ),
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE",
            help="Fix a parameter, where more than two were varied. Repeatable.",
        ),
    ] = None,
    out: Annotated[
        Path,
        typer.Option(
            metavar="DIR",
            help="Write the figures and the dataset (NetCDF) into this directory.",
            show_default="the current one",
        ),
    ] = Path(),
    formats: Formats = None,
    width: Width = None,
) -> None:
    """Draw a sweep (lines over one parameter, maps over two), a branch or a limit cycle."""
    with reported():
        from birdmb.cli.plot import run  # noqa: PLC0415 - slow to import

        run(file, quantity or [], at or [], out, requested_pictures(formats, width))
