"""What feathers on hinges do to stability: softer, slack at zero or pre-twisted against the air.

`python examples/studies/feathers.py [DIR] [--coarse]` prints the table of docs/compliance.md about
them and keeps it in DIR (default results/) as CSV.
"""

import argparse
import csv
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

import birdmb

TOPOLOGY = Path(__file__).parents[2] / "topologies" / "ibis_hinged_feathers.toml"
FEATHERS = ("5", "3")
ELEMENTS = 8
STIFFNESSES = (1, 2, 4, 8)


def mean_torques(bird: birdmb.Bird) -> np.ndarray:
    """Torques (2,) N m of the air about the hinges, mean over a beat, if they stay at zero."""
    still = bird.with_values({f"feathers.{name}.hinge.rest": 0.0 for name in FEATHERS})
    beat = birdmb.find_limit_cycle(birdmb.RigidModel(still)).beat
    return np.mean([loads.right.joint_torques[-2:] for loads in beat.loads[:-1]], axis=0)


def flown(bird: birdmb.Bird) -> list[str]:
    """|multiplier|, speed, climb and the range of either hinge in degrees."""
    try:
        cycle = birdmb.find_limit_cycle(birdmb.MultibodyModel(bird), max_iterations=20)
    except birdmb.ConvergenceError:
        return ["not found"]
    cells = [f"{abs(cycle.multipliers[0]):.3f}"]
    cells += [f"{cycle.mean_speed:.2f}", f"{cycle.mean_climb_rate:.2f}"]
    for feather in bird.hinged_feathers:
        angle = np.degrees(cycle.beat.states[:, cycle.state_names.index(feather.hinge_name)])
        cells.append(f"{angle.min():+.1f}..{angle.max():+.1f}")
    return cells


def main(directory: Path, *, coarse: bool) -> None:
    """Print and keep the table."""
    console = Console(width=100)
    bird = birdmb.load_bird(TOPOLOGY).with_values(
        {"wing.discretisation": 4 if coarse else ELEMENTS}
    )
    torques = mean_torques(bird)
    console.print(
        "mean torque of the air about the hinges at zero: "
        + ", ".join(
            f"{torque:.3f} N m (feather {n})" for n, torque in zip(FEATHERS, torques, strict=True)
        )
    )
    columns = ["slack at", "k, N m/rad", "|Λ|max", "speed, m/s", "climb, m/s"]
    columns += [f"hinge {name}, °" for name in FEATHERS]
    table, rows = Table(*columns), []

    def add(slack: str, k: str, variant: birdmb.Bird) -> None:
        rows.append([slack, k, *flown(variant)])
        table.add_row(*rows[-1])

    for slack, moments in (("zero", 0 * torques), ("-torque/k", -torques)):
        for k in STIFFNESSES[-1:] if coarse else STIFFNESSES:
            values = {f"feathers.{name}.hinge.stiffness": k for name in FEATHERS}
            for name, moment in zip(FEATHERS, moments, strict=True):
                values[f"feathers.{name}.hinge.rest"] = moment / k
            add(slack, f"{k}", bird.with_values(values))
    firm = {f"feathers.{name}.hinge": None for name in FEATHERS}
    add("", "firm, no mass", bird.with_values(firm))
    console.print(table)
    directory.mkdir(parents=True, exist_ok=True)
    with (directory / "feathers.csv").open("w", newline="") as file:
        csv.writer(file).writerows([columns, *rows])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", nargs="?", type=Path, default=Path("results"))
    parser.add_argument("--coarse", action="store_true", help="few flights, coarse wings: quick")
    options = parser.parse_args()
    main(options.directory, coarse=options.coarse)
