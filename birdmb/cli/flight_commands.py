"""The commands that find, trim, level and scale flights, and their options."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from birdmb.cli.completion import assigned_names
from birdmb.cli.drawing import requested_pictures
from birdmb.cli.options import (
    Assignments,
    ClimbRate,
    ExecutorName,
    Formats,
    Json,
    ModelChoice,
    ModelName,
    MotionChoice,
    MotionOption,
    Speed,
    Topology,
    Width,
    Workers,
    number,
)
from birdmb.cli.outcome import reported

_FASTEST = 1e3  # m/s

commands = typer.Typer()


class GustKind(StrEnum):
    """How a gust runs over time."""

    GAUSSIAN = "gaussian"
    COSINE = "cosine"
    STEP = "step"


class GustAxesChoice(StrEnum):
    """What the velocities of a gust are along."""

    WORLD = "world"
    BODY = "body"


@commands.command(
    epilog=(
        "Exit status: 0 at least one flight; 1 no limit cycle found, or none that is a flight; 2 "
        "wrong topology, value or option; 130 interrupted.\n\n"
        "With --json a list of objects, each as of `birdmb cycle --json`.\n\n"
        "Example: birdmb flights topologies/ibis.toml --model rigid --out flights"
    )
)
def flights(
    topology: Topology,
    model: ModelChoice = ModelName.MULTIBODY,
    motion: MotionOption = MotionChoice.PLANAR,
    assignments: Assignments = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Write each cycle (flight_1.nc, ...) into this directory; `birdmb cycle --guess` "
            "starts from such a file.",
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Find all limit cycles of a bird that many starts lead to, and tell flights from others.

    Starts over speed, incidence and path angle, then searches away from the cycles found. They are
    listed by speed, first the flights, then what moves backwards or on its tail. Nothing proves
    that there are no others.
    """
    with reported(as_json=json):
        from birdmb.cli.birds import requested_bird  # noqa: PLC0415 - slow to import

        bird = requested_bird(topology, assignments or [])

        from birdmb.cli.flights import run  # noqa: PLC0415 - not before the bird is sound

        run(bird, model.value, motion.value, out=out, as_json=json)


@commands.command(
    epilog=(
        "Exit status: 0 trimmed; 1 there is no trim within the bounds; 2 wrong topology, value or "
        "option; 130 interrupted.\n\n"
        "Example: birdmb trim topologies/ibis_tail.toml --model rigid --speed 13"
    )
)
def trim(
    topology: Topology,
    by: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=LOW:HIGH",
            autocompletion=assigned_names,
            help="Trim by this value of the bird, within the bounds; twice with a --speed.",
            show_default="the offset of the joint that turns the chords, -30 to 30 degrees; with "
            "a speed the amplitude of the one that flaps too, 15 to 70, or its gain",
        ),
    ] = None,
    climb_rate: ClimbRate = 0.0,
    speed: Speed = None,
    model: ModelChoice = ModelName.MULTIBODY,
    assignments: Assignments = None,
    out: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Write the topology file with the trimmed values and those of --set, its comments "
            "kept. A --set wing.discretisation is for the search alone.",
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Trim the flight of a bird: to level flight, at a wanted speed, or to a climb rate."""
    with reported(as_json=json):
        from birdmb.cli.birds import requested_bird  # noqa: PLC0415 - slow to import
        from birdmb.cli.variations import requested_bounds  # noqa: PLC0415 - slow to import

        bird = requested_bird(topology, assignments or [])
        bounds = requested_bounds(bird, by, speed, "--by") if by else None

        from birdmb.cli.trim import run  # noqa: PLC0415 - not before all of it is sound

        run(
            bird,
            topology,
            assignments or [],
            bounds,
            climb_rate,
            speed,
            model=model.value,
            out=out,
            as_json=json,
        )


@commands.command(
    epilog=(
        "Exit status: 0 flown; 1 no limit cycle found, or the flight in the gust ended early; 2 "
        "wrong topology, value or option; 130 interrupted.\n\n"
        "Example: birdmb gust topologies/ibis_tail.toml --model rigid --vertical 1 --beats 40 "
        "--out results"
    )
)
def gust(
    topology: Topology,
    kind: Annotated[
        GustKind,
        typer.Option(
            metavar="KIND",
            help="gaussian: rises and falls like exp(-((t - at)/length)^2/2); cosine: (1 - cos)/2, "
            "once; step: steady from then on.",
        ),
    ] = GustKind.GAUSSIAN,
    vertical: Annotated[
        float,
        typer.Option(
            metavar="V",
            help="Largest velocity upwards, m/s.",
            callback=number("--vertical", -_FASTEST, _FASTEST, "no air is as fast"),
        ),
    ] = 0.0,
    horizontal: Annotated[
        float,
        typer.Option(
            metavar="V",
            help="Largest velocity forwards, a tail wind, m/s.",
            callback=number("--horizontal", -_FASTEST, _FASTEST, "no air is as fast"),
        ),
    ] = 0.0,
    lateral: Annotated[
        float,
        typer.Option(
            metavar="V",
            help="Largest velocity to the right, m/s; with --motion free.",
            callback=number("--lateral", -_FASTEST, _FASTEST, "no air is as fast"),
        ),
    ] = 0.0,
    at: Annotated[
        float | None,
        typer.Option(
            metavar="T",
            help="When it is strongest (gaussian) or begins, s.",
            show_default="0.25 of a gaussian one, else 0",
            callback=number("--at", -1e6, 1e6, "the flight begins at 0 s"),
        ),
    ] = None,
    length: Annotated[
        float | None,
        typer.Option(
            metavar="T",
            help="Standard deviation (gaussian) or duration (cosine), s.",
            show_default="0.05 and 0.25",
            callback=number("--length", 1e-4, 1e6, "shorter ones need finer steps than there are"),
        ),
    ] = None,
    axes: Annotated[
        GustAxesChoice,
        typer.Option(
            metavar="AXES",
            help="world: along the horizon and the vertical; body: along the body's x axis and "
            "against its z axis, which turn with it.",
        ),
    ] = GustAxesChoice.WORLD,
    beats: Annotated[
        int, typer.Option(min=1, max=1000, metavar="N", help="Wingbeats to follow the flight.")
    ] = 10,
    model: ModelChoice = ModelName.MULTIBODY,
    motion: MotionOption = MotionChoice.PLANAR,
    assignments: Assignments = None,
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Write gust.nc and figures into this directory."),
    ] = None,
    formats: Formats = None,
    width: Width = None,
    json: Json = False,
) -> None:
    """Fly a bird from its limit cycle through a gust, by the full model and by the linear one.

    The gust is the same everywhere at a time. Figures: the deviations with the Floquet modes in
    them, and the states themselves beside those of the undisturbed flight.
    """
    with reported(as_json=json):
        from birdmb.cli.birds import requested_bird  # noqa: PLC0415 - slow to import

        pictures = requested_pictures(formats, width)
        bird = requested_bird(topology, assignments or [])

        from birdmb.cli.gust import GustOptions, run  # noqa: PLC0415 - not before all is sound

        run(
            bird,
            model.value,
            motion.value,
            GustOptions(
                kind=kind.value,
                vertical=vertical,
                horizontal=horizontal,
                lateral=lateral,
                at=at,
                length=length,
                axes=axes.value,
                beats=beats,
            ),
            out=out,
            pictures=pictures,
            as_json=json,
        )


@commands.command(
    epilog=(
        "Exit status: 0 every flight is finished, levelled or with the reason why it cannot be; 2 "
        "wrong topology, value or option, or a store of another study; 130 interrupted.\n\n"
        "Example: birdmb tail-study topologies/ibis_tail.toml --store tail.db --every 5 "
        "--out results"
    )
)
def tail_study(
    topology: Topology,
    store: Annotated[
        Path,
        typer.Option(
            metavar="FILE",
            help="Keep every finished flight in this file (SQLite). If there is one, only what is "
            "missing in it is computed.",
        ),
    ],
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUES",
            autocompletion=assigned_names,
            help="Values, as of `birdmb sweep --vary`, of tail.opening_deg and of one or two more.",
            show_default="an opening of 0 to 45 degrees, the flap amplitude 1.1 to 0.7 times the "
            "bird's own, the offset of the sweep up to 3 degrees to either side",
        ),
    ] = None,
    trim: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=LOW:HIGH",
            autocompletion=assigned_names,
            help="Level the flight by this value of the bird, within the bounds.",
            show_default="the offset of the joint that turns the chords, -30 to 30 degrees",
        ),
    ] = None,
    limit: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=LARGEST",
            help="Count flights only up to this modulus of a quantity, angles in degrees: "
            "mean_pitch=6, forearm.roll.offset_deg=12, largest_tail_angle=5. Repeatable.",
            show_default="largest_tail_angle=5, the tail's validity",
        ),
    ] = None,
    every: Annotated[
        int,
        typer.Option(min=1, metavar="N", help="Take one of N values, for a coarse study."),
    ] = 1,
    workers: Workers = None,
    executor: ExecutorName = "processes",
    assignments: Assignments = None,
    out: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Write dataset (NetCDF) and figures into this directory."),
    ] = None,
    formats: Formats = None,
    width: Width = None,
) -> None:
    """Level the flight for many tail openings and gaits: what stability costs (rigid bird).

    Figures: the manifold of level flights, the least cost at each speed, the Pareto front of cost
    and stability, and the opening of the tail at which flight becomes stable.
    """
    with reported():
        from birdmb.cli.birds import requested_bird  # noqa: PLC0415 - slow to import
        from birdmb.cli.variations import (  # noqa: PLC0415 - slow to import
            requested_bounds,
            requested_limits,
            requested_variations,
        )

        pictures = requested_pictures(formats, width)
        bird = requested_bird(topology, assignments or [])
        varied = requested_variations(vary) if vary else None
        bounds = requested_bounds(bird, trim, None, "--trim") if trim else None
        limits = requested_limits(limit or ["largest_tail_angle=5"])

        from birdmb.cli.tail_study import run  # noqa: PLC0415 - not before all of it is sound

        run(
            bird,
            store,
            vary=varied,
            trim=bounds,
            limits=limits,
            every=every,
            workers=workers,
            executor=executor,
            out=out,
            pictures=pictures,
        )
