"""The modes of the ibis: which states take part in which Floquet mode of its flight.

Run `python examples/orbits_bird.py [DIRECTORY]`; the figure goes to the directory.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import birdmb
from birdmb.orbits import FloquetResult

IBIS = Path(__file__).parent.parent / "topologies" / "ibis_compliant_shoulder.toml"


def print_modes(title: str, orbit: FloquetResult) -> None:
    print(title)
    print("multiplier               error  doubles/halves (s)   " + "  ".join(orbit.state_names))
    for i, value in enumerate(orbit.multipliers):
        shares = "  ".join(
            f"{share:{len(name)}.2f}"
            for name, share in zip(orbit.state_names, orbit.participation[:, i], strict=True)
        )
        print(
            f"{value.real:+.3e} {value.imag:+.3e}i  {orbit.multiplier_errors[i]:.0e}  "
            f"{orbit.doubling_times[i]:18.4f}   {shares}"
        )


def draw_participation(orbit: FloquetResult) -> Figure:
    figure = Figure(figsize=(8, 4), layout="constrained")
    axes = figure.subplots()
    bottom = np.zeros(len(orbit.multipliers))
    for name, share in zip(orbit.state_names, orbit.participation, strict=True):
        axes.bar(range(len(share)), share, bottom=bottom, label=name)
        bottom += share
    names = [
        f"{value.real:.3g}{value.imag:+.2g}i" if value.imag else f"{value.real:.3g}"
        for value in orbit.multipliers
    ]
    axes.set_xticks(range(len(names)), names)
    axes.set(xlabel="Floquet multiplier", ylabel="participation")
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    return figure


def main(directory: Path) -> None:
    bird = birdmb.load_bird(IBIS)
    rigid = birdmb.RigidModel(bird)
    x0 = birdmb.find_limit_cycle(rigid).x0
    # An orbit that is known needs no search: its state at one time is enough.
    print_modes("rigid bird", birdmb.floquet(rigid, x0, segments=5))
    # Segments keep the small multipliers of the joint apart from round-off.
    flight = birdmb.find_limit_cycle(birdmb.MultibodyModel(bird), segments=5)
    print_modes("compliant shoulder", flight)
    directory.mkdir(parents=True, exist_ok=True)
    draw_participation(flight).savefig(directory / "bird_modes.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "results"))
