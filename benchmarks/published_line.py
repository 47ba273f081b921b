"""What the published lifting line does to the lift: `python benchmarks/published_line.py`.

Lift of the ibis at mid-downstroke on its limit cycle, with both lines, over the number of elements.
"""

from pathlib import Path

from rich.console import Console
from rich.table import Table

import birdmb

IBIS = Path(__file__).parent.parent / "topologies" / "ibis.toml"
STATE = (18.06763, -1.9976, -0.11247, -0.11714)


def main() -> None:
    """Print the table."""
    ibis = birdmb.load_bird(IBIS)
    table = Table("elements", "one-step line, N", "orthogonal line, N")
    for elements in (8, 16, 32, 64, 128, 256):
        lift = []
        for scheme in ("one-step", "orthogonal"):
            numbers = {"scheme": scheme, "elements": elements, "rounding": 0.5}
            bird = ibis.with_values({"wing.discretisation": numbers})
            lift.append(-birdmb.RigidModel(bird).loads(0.0, STATE).force[2])
        table.add_row(str(elements), *(f"{newton:.3f}" for newton in lift))
    Console().print(table)


if __name__ == "__main__":
    main()
