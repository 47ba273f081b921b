"""Which joint's compliance helps stability, and what the wings' mass does to it.

`python examples/studies/compliance.py [DIR] [--coarse]` prints the tables of docs/compliance.md and
keeps them in DIR (default results/) as CSV.
"""

import argparse
import csv
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

import birdmb

IBIS = Path(__file__).parents[2] / "topologies" / "ibis.toml"
ELEMENTS = 12
STIFFNESSES = {
    "shoulder.pitch": (5, 10, 20, 40, 80),
    "shoulder.flap": (10, 15, 20, 40, 80),
    "shoulder.sweep": (5, 10, 20, 40, 80),
    "elbow.sweep": (2, 5, 10, 20, 40),
    "forearm.roll": (1, 2, 5, 10, 20),
    "wrist.sweep": (1, 2, 5, 10, 20),
}
# N m s/rad per N m/rad: enough to damp what the air does not, the same for all.
DAMPING_PER_STIFFNESS = 0.005
MASS_FRACTIONS = (0.0, 0.01, 0.02, 0.04, 0.06, 0.08, 0.1)


def flown(model: birdmb.RigidModel | birdmb.MultibodyModel) -> tuple[float, float, float] | str:
    """Largest modulus of a multiplier, speed (m/s) and climb rate (m/s), or why there is none."""
    try:
        cycle = birdmb.find_limit_cycle(model, max_iterations=20)
    except birdmb.BirdmbError as error:
        return type(error).__name__
    return float(abs(cycle.multipliers[0])), cycle.mean_speed, cycle.mean_climb_rate


def with_wing_mass(bird: birdmb.Bird, fraction: float) -> birdmb.Bird:
    """The bird with both wings weighing this fraction of it, the whole unchanged."""
    total = bird.body.mass
    values: dict[str, object] = {"body.mass": (1 - fraction) * total}
    for bone in ("humerus", "forearm", "hand"):
        segment = getattr(bird.segments, bone)
        mass = fraction * total / 6
        values[f"segments.{bone}.mass"] = mass
        inertia = np.array(segment.inertia) * (mass / segment.mass)
        values[f"segments.{bone}.inertia"] = inertia.tolist()
    return bird.with_values(values)


def main(directory: Path, *, coarse: bool) -> None:
    """Print and keep both tables."""
    console, rows = Console(width=100), []
    bird = birdmb.load_bird(IBIS).with_values({"wing.discretisation": 4 if coarse else ELEMENTS})
    rigid_joints = flown(birdmb.MultibodyModel(bird))
    console.print(f"all joints prescribed: |Λ|max, speed, climb rate = {rigid_joints}")
    table = Table("joint", "k, N m/rad", "|Λ|max", "speed, m/s", "climb, m/s")
    for joint, stiffnesses in STIFFNESSES.items():
        for k in stiffnesses[-1:] if coarse else stiffnesses:
            sprung = bird.with_joint(joint, stiffness=k, damping=DAMPING_PER_STIFFNESS * k)
            found = flown(birdmb.MultibodyModel(sprung))
            cells = [found] if isinstance(found, str) else [f"{value:.3f}" for value in found]
            table.add_row(joint, f"{k:g}", *cells)
            rows.append([joint, k, *cells])
    console.print(table)

    table = Table("mass of the wings, of the bird's", "|Λ|max", "speed, m/s", "climb, m/s")
    for fraction in MASS_FRACTIONS[:2] if coarse else MASS_FRACTIONS:
        kind = birdmb.MultibodyModel if fraction else birdmb.RigidModel
        found = flown(kind(with_wing_mass(bird, fraction) if fraction else bird))
        cells = [found] if isinstance(found, str) else [f"{value:.3f}" for value in found]
        table.add_row(f"{fraction:.0%}", *cells)
        rows.append(["wing mass", fraction, *cells])
    console.print(table)
    directory.mkdir(parents=True, exist_ok=True)
    with (directory / "compliance.csv").open("w", newline="") as file:
        csv.writer(file).writerows(rows)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", nargs="?", type=Path, default=Path("results"))
    parser.add_argument("--coarse", action="store_true", help="few flights, coarse wings: quick")
    options = parser.parse_args()
    main(options.directory, coarse=options.coarse)
