"""Where the study's tables and pictures go, and what its parts share."""

import csv
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from rich.console import Console
from rich.table import Table

import birdmb
from birdmb.models.wing_model import BirdModel

RIGID, MULTIBODY = birdmb.RigidModel, birdmb.MultibodyModel
FEW: dict[str, object] = {"wing__discretisation": 16, "air__wake_points": 4}
COARSE: dict[str, object] = {"wing.discretisation": 4, "air.wake_points": 4}


@dataclass(frozen=True)
class Report:
    """Where tables and pictures go.

    Attributes:
        out: the directory.
        coarse: whether all is to be quick.
        console: prints the tables.
    """

    out: Path
    coarse: bool
    console: Console

    def bird(self, name: str, **values: object) -> birdmb.Bird:
        """A bird of the package, with values by dotted names (`__` for the dot)."""
        given = {key.replace("__", "."): value for key, value in values.items()}
        return birdmb.load_bird(name).with_values({**(COARSE if self.coarse else {}), **given})

    def table(
        self, name: str, title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]
    ) -> None:
        """Print a table, and keep it."""
        table = Table(*columns, title=title)
        for row in rows:
            table.add_row(*row)
        self.console.print(table)
        with (self.out / f"memory_{name}.csv").open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([columns, *rows])

    def picture(self, name: str, figure: Figure) -> None:
        """Keep a picture."""
        figure.savefig(self.out / f"memory_{name}.png", dpi=120)


def largest(multipliers: np.ndarray) -> float:
    """Largest modulus."""
    return float(np.abs(multipliers).max())


def in_both(
    bird: birdmb.Bird, model: Callable[[birdmb.Bird], BirdModel]
) -> birdmb.MemoryEffect | None:
    """A bird's flight without and with memory; `None` if one of them is not found."""
    try:
        cycle = birdmb.find_limit_cycle(model(bird))
        assert isinstance(cycle, birdmb.FlightCycle)
        return birdmb.memory_effect(cycle)
    except birdmb.BirdmbError:
        return None
