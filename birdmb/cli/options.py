"""Arguments and options that several commands share."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from typing import Annotated

import typer

from birdmb.cli.completion import assigned_names, birds_and_files
from birdmb.cli.outcome import InputError, reported

MOST_STEPS = 10_000  # per wingbeat; the tables of a beat fill the memory


class ModelName(StrEnum):
    """Which model flies the bird."""

    MULTIBODY = "multibody"
    RIGID = "rigid"


class MotionChoice(StrEnum):
    """Which motions of the body are free."""

    PLANAR = "planar"
    FREE = "free"


class Method(StrEnum):
    """How the limit cycle is searched for."""

    AUTO = "auto"
    COLLOCATION = "collocation"
    SHOOTING = "shooting"


class Damping(StrEnum):
    """How steps of Newton's method are shortened."""

    LINE_SEARCH = "line-search"
    LEVENBERG_MARQUARDT = "levenberg-marquardt"


def number(
    option: str, low: float, high: float, why: str
) -> Callable[[float | None], float | None]:
    """A callback of an option whose number must be from `low` to `high`, for the reason `why`.

    Typer's own ranges let nan through.
    """

    def check(value: float | None) -> float | None:
        with reported():
            if value is not None and not low <= value <= high:
                raise InputError(f"{option} must be {low:g} to {high:g}, not {value:g}: {why}.")
        return value

    return check


Topology = Annotated[
    str,
    typer.Argument(
        help="Topology file (TOML), or the name of a bird of the package.",
        autocompletion=birds_and_files,
    ),
]
Assignments = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        autocompletion=assigned_names,
        help="Change a value of the bird by its dotted name: body.mass=1.3, "
        "shoulder.flap.stiffness=20, wing.discretisation=published. Repeatable.",
    ),
]
ModelChoice = Annotated[
    ModelName, typer.Option(metavar="MODEL", help="multibody or rigid, as for `birdmb cycle`.")
]
MotionOption = Annotated[
    MotionChoice,
    typer.Option(
        "--motion",
        metavar="MOTION",
        help="planar: symmetric longitudinal flight. free: in space, with lateral modes, each "
        "wing by itself.",
    ),
]
Segments = Annotated[
    int | None,
    typer.Option(
        min=1,
        max=128,  # as many as a beat has integration steps
        metavar="N",
        help="Shooting segments; more tame strongly unstable flights. Given, shooting is taken.",
        show_default="1, if shooting is taken",
    ),
]
MethodChoice = Annotated[
    Method,
    typer.Option(
        metavar="METHOD",
        help="collocation: fast, for smooth motions; shooting: by the time integration; auto: "
        "collocation where it can, else shooting.",
    ),
]
DampingChoice = Annotated[
    Damping,
    typer.Option(
        metavar="HOW",
        help="How steps of Newton's method are shortened: line-search, or levenberg-marquardt: "
        "takes longer, starts from further away.",
    ),
]
Tolerance = Annotated[
    float,
    typer.Option(
        metavar="X",
        help="Closure error accepted, in units of the states' typical sizes.",
        callback=number(
            "--tolerance",
            1e-15,
            1e-2,
            "a flight that closes no better is no limit cycle, and round-off is not undercut",
        ),
    ),
]
StepsPerBeat = Annotated[
    int | None,
    typer.Option(
        min=4,
        max=MOST_STEPS,
        metavar="N",
        help="Integration steps per wingbeat.",
        show_default="the model chooses",
    ),
]
Json = Annotated[
    bool, typer.Option("--json", help="Print one JSON object to standard output, no tables.")
]
Formats = Annotated[
    str | None,
    typer.Option(
        "--format",
        metavar="LIST",
        help="Formats of figures, one or more of png, pdf and svg: pdf,svg.",
        show_default="png",
    ),
]
Width = Annotated[
    str | None,
    typer.Option(
        "--width",
        metavar="WIDTH",
        help="Draw figures for a page or column as wide as this: 90mm, 18cm or 3.5in. Text is 6 pt "
        "or larger, panels stand below one another where they must.",
        show_default="for a screen",
    ),
]
ClimbRate = Annotated[
    float,
    typer.Option(
        metavar="V",
        help="Climb rate to trim to, m/s.",
        callback=number("--climb-rate", -1e3, 1e3, "no bird is as fast"),
    ),
]
Speed = Annotated[
    float | None,
    typer.Option(
        metavar="V",
        help="Speed to trim to, m/s.",
        show_default="any",
        callback=number("--speed", 1e-3, 1e3, "a bird flies forwards, and no faster"),
    ),
]
ExecutorName = Annotated[
    str,
    typer.Option(
        "--executor",
        metavar="NAME",
        help="What computes: processes (of this computer), dask (a cluster of its own), "
        "dask://HOST:PORT (the scheduler of one that runs), or mpi (the ranks of `mpiexec -n N "
        "birdmb ...`). The store is written here alone; keep it on a local disk, for SQLite is not "
        "for network file systems.",
    ),
]
Workers = Annotated[
    int | None,
    typer.Option(
        min=1,
        max=1024,
        metavar="N",
        help="Processes that compute.",
        show_default="one for each core",
    ),
]
