"""The ibis after a disturbance along each mode of its limit cycle, over five beats.

Run `python examples/bird_perturbed_flight.py [DIRECTORY]`; the figure goes to the directory.
"""

import sys
from pathlib import Path

import numpy as np

import birdmb
from birdmb.figures import plot_perturbed_flight
from birdmb.studies import perturbed_flight

IBIS = Path(__file__).parent.parent / "topologies" / "ibis.toml"


def main(directory: Path) -> None:
    cycle = birdmb.find_limit_cycle(birdmb.RigidModel(birdmb.load_bird(IBIS)))
    flight = perturbed_flight(cycle, amplitude=0.05, periods=5)
    print(
        "multiplier        size of the disturbance after 0 to 5 beats (state scale)   height lost"
    )
    for mode in flight.mode.values:
        at = flight.sel(mode=mode)
        deviation = at.deviation.sel(time=cycle.period * flight.beat, method="nearest")
        sizes = np.linalg.norm(deviation / cycle.state_scale, axis=-1)
        lost = float(flight.orbit_h[-1] - at.h[-1])
        print(
            f"{cycle.multipliers[mode]:.4f}  "
            + "".join(f"{size:10.5f}" for size in sizes)
            + f"  {lost:+9.3f} m"
        )
    directory.mkdir(parents=True, exist_ok=True)
    plot_perturbed_flight(flight).savefig(directory / "perturbed_flight.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "results"))
