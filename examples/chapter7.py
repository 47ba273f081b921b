"""Chapter 7 of the thesis: does the multibody bird become the rigid one as its wings lose weight?

`python examples/chapter7.py [DIR]` prints the table of docs/chapter7.md and saves its figure in DIR
(default results/).
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from rich.console import Console
from rich.table import Table

import birdmb

MASSLESS = Path(__file__).parent.parent / "topologies" / "ibis_massless.toml"
MASSES = 10.0 ** np.arange(-2, -14, -1)


def with_segment_mass(bird: birdmb.Bird, mass: float) -> birdmb.Bird:
    """The bird with segments of this mass in kg, their inertias in proportion."""
    values: dict[str, object] = {}
    for bone in ("humerus", "forearm", "hand"):
        segment = getattr(bird.segments, bone)
        values[f"segments.{bone}.mass"] = mass
        inertia = np.array(segment.inertia) * (mass / segment.mass)
        values[f"segments.{bone}.inertia"] = inertia.tolist()
    return bird.with_values(values)


def main(directory: Path) -> None:
    """Print the table and save the figure."""
    bird = birdmb.load_bird(MASSLESS)
    # Enough steps on either side for the models' own errors to stay below the smallest gap.
    rigid = birdmb.find_limit_cycle(
        birdmb.RigidModel(bird, steps_per_beat=960), tolerance=1e-11, jacobian="variational"
    )
    table = Table("segment mass, kg", "u", "w", "q", "theta", "largest gap of a multiplier")
    gaps = []
    for mass in MASSES:
        model = birdmb.MultibodyModel(with_segment_mass(bird, mass), steps_per_beat=120)
        cycle = birdmb.find_limit_cycle(model, rigid.x0, tolerance=1e-11)
        states = cycle.x0 - rigid.x0
        multipliers = np.abs(
            np.sort_complex(cycle.multipliers) - np.sort_complex(rigid.multipliers)
        )
        gaps.append([np.abs(states / model.state_scale).max(), multipliers.max()])
        cells = [f"{gap:+.2e}" for gap in states]
        table.add_row(f"{mass:.0e}", *cells, f"{multipliers.max():.1e}")
    console = Console(width=100)
    console.print(
        "Rigid bird: ", np.array2string(rigid.x0, precision=6), rigid.multipliers.round(6)
    )
    console.print(table)

    figure = Figure(figsize=(6, 4), layout="constrained")
    axes = figure.subplots()
    labels = ("largest gap of a state, in units of the state scale", "largest gap of a multiplier")
    for values, label, marker in zip(np.transpose(gaps), labels, "os", strict=True):
        axes.loglog(MASSES, values, marker=marker, label=label)
    first = gaps[3][0] / MASSES[3]
    axes.loglog(MASSES, first * MASSES, color="0.7", zorder=0, label="first order")
    axes.set(xlabel="mass of a wing segment (kg)", ylabel="multibody against rigid")
    axes.legend(frameon=False)
    directory.mkdir(parents=True, exist_ok=True)
    figure.savefig(directory / "chapter7.png", dpi=150)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "results"))
