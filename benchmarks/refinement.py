"""How results depend on elements, rounding and steps: `python benchmarks/refinement.py`."""

from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

import birdmb
from birdmb.orbits.search import SearchMethod

IBIS = Path(__file__).parent.parent / "topologies" / "ibis.toml"
FINEST = 192


def row(
    model: birdmb.RigidModel, guess: np.ndarray, method: SearchMethod = "auto"
) -> tuple[np.ndarray, np.ndarray]:
    """x0 (4,) and multipliers (4,) of the limit cycle."""
    cycle = birdmb.find_limit_cycle(model, guess, method=method)
    return cycle.x0, cycle.multipliers


def described(x0: np.ndarray, multipliers: np.ndarray, reference: np.ndarray) -> list[str]:
    """Cells of a row: states, multipliers, distance to the finest of the multipliers."""
    real, pair, _, small = multipliers
    return [
        *(f"{x:.4f}" for x in x0),
        f"{real.real:.5f}",
        f"{pair.real:.5f} ± {abs(pair.imag):.5f}i",
        f"{small.real:.5f}",
        f"{np.abs(multipliers - reference).max():.1e}",
    ]


def main() -> None:
    """Print the three tables."""
    console = Console(width=120)
    ibis = birdmb.load_bird(IBIS)
    columns = ("u", "w", "q", "theta", "Λ1", "Λ2,3", "Λ4", "max |ΔΛ|")
    guess = birdmb.find_limit_cycle(birdmb.RigidModel(ibis)).x0

    finest = birdmb.RigidModel(ibis.with_values({"wing.discretisation": FINEST}))
    _, reference = row(finest, guess)
    table = Table("elements", *columns, title=f"Elements a wing, against {FINEST}")
    for n in (8, 12, 16, 24, 32, 48, 64, 96):
        model = birdmb.RigidModel(ibis.with_values({"wing.discretisation": n}))
        table.add_row(str(n), *described(*row(model, guess), reference))
    published = birdmb.RigidModel(ibis.with_values({"wing.discretisation": "published"}))
    table.add_row("published", *described(*row(published, guess), reference))
    console.print(table)

    table = Table(
        "rounding", *columns, title="Rounding of the edges' corners, 64 elements, against 0.1"
    )
    reference = None
    for rounding in (0.1, 0.2, 0.3, 0.5, 0.7, 1.0):
        numbers = {"scheme": "orthogonal", "elements": 64, "rounding": rounding}
        model = birdmb.RigidModel(ibis.with_values({"wing.discretisation": numbers}))
        x0, multipliers = row(model, guess)
        reference = multipliers if reference is None else reference
        table.add_row(f"{rounding:g}", *described(x0, multipliers, reference))
    console.print(table)

    table = Table("steps", *columns, title="Steps per beat of shooting, against 960")
    _, reference = row(birdmb.RigidModel(ibis, steps_per_beat=960), guess, "shooting")
    for steps in (30, 60, 120, 240):
        model = birdmb.RigidModel(ibis, steps_per_beat=steps)
        table.add_row(str(steps), *described(*row(model, guess, "shooting"), reference))
    console.print(table)


if __name__ == "__main__":
    main()
