"""Arguments and options that several commands share."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


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
ModelChoice = Annotated[
    ModelName, typer.Option(metavar="MODEL", help="multibody or rigid, as for `birdmb cycle`.")
]
Segments = Annotated[
    int,
    typer.Option(
        min=1, metavar="N", help="Shooting segments; more tame strongly unstable flights."
    ),
]
Tolerance = Annotated[
    float,
    typer.Option(
        metavar="X", help="Closure error accepted, in units of the states' typical sizes."
    ),
]
StepsPerBeat = Annotated[
    int | None,
    typer.Option(
        min=4,
        metavar="N",
        help="Integration steps per wingbeat.",
        show_default="the model chooses",
    ),
]
Json = Annotated[
    bool, typer.Option("--json", help="Print one JSON object to standard output, no tables.")
]
ClimbRate = Annotated[float, typer.Option(metavar="V", help="Climb rate to trim to, m/s.")]
Speed = Annotated[
    float | None,
    typer.Option(metavar="V", help="Speed to trim to, m/s.", show_default="any"),
]
Workers = Annotated[
    int | None,
    typer.Option(
        min=1, metavar="N", help="Processes that compute.", show_default="one for each core"
    ),
]
