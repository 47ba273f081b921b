"""What square and pointed tips do to the lift: `python benchmarks/wing_tips.py`.

Lift of a straight, flat wing in steady flight, by the angle of its last feather to straight aft and
the number of elements, with the edge at the tip taken for a tip edge and for a leading edge.
"""

from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

import birdmb
from birdmb.aerodynamics.elements import place_elements
from birdmb.aerodynamics.pair import pair_loads
from birdmb.aerodynamics.twist_loads import wing_wrench
from birdmb.wing.arrays import WingArrays, wing_arrays
from birdmb.wing.shape import wing_shape

IBIS = Path(__file__).parent.parent / "topologies" / "ibis.toml"
LENGTHS = ((0.1, 0.1, 0.1, 0.1), (0.1, 0.15, 0.2, 0.25), (0.2, 0.1, 0.3, 0.15))
ANGLES = (0, 15, 30, 45, 60, 90)
ELEMENTS = (16, 32, 64, 128)
DENSITY, SPEED, ALPHA = 1.225, 10.0, 0.05
STILL = np.zeros(6)


def main() -> None:
    """Print a table for each set of feathers."""
    ibis = birdmb.load_bird(IBIS)
    for lengths in LENGTHS:
        title = f"Lift in N, feathers of {', '.join(f'{length:g}' for length in lengths)} m"
        table = Table("last feather", "tip", *(f"{n} elements" for n in ELEMENTS), title=title)
        for angle in ANGLES:
            values = {"feathers.1.rest_angle_deg": float(angle)}
            for name, length in zip("7531", lengths, strict=True):
                values[f"feathers.{name}.length"] = length
                values.setdefault(f"feathers.{name}.rest_angle_deg", 0.0)
            wing = wing_arrays(ibis.with_values(values))
            for square in (True, False):
                lifts = [lift(wing._replace(square_tip=square), n) for n in ELEMENTS]
                taken = " (taken)" if square == wing.square_tip else ""
                tip = ("square" if square else "pointed") + taken
                table.add_row(f"{angle}°", tip, *lifts)
        Console().print(table)


def lift(wing: WingArrays, elements: int) -> str:
    """Lift of both wings in N, if there is a line."""
    shape = wing_shape(wing, STILL, STILL, elements, 0.5, False)
    if not shape.converged:
        return "no line"
    placed = place_elements(shape, wing.root)
    twist = np.array([SPEED * np.cos(ALPHA), 0.0, SPEED * np.sin(ALPHA), 0.0, 0.0, 0.0])
    force = pair_loads(placed, placed, True, DENSITY, 0.0, twist)[0].force
    wrench = 2.0 * wing_wrench(placed.position, force[:, :, None])[:, 0]
    return f"{wrench[0] * np.sin(ALPHA) - wrench[2] * np.cos(ALPHA):.4f}"


if __name__ == "__main__":
    main()
