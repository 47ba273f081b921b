"""The ibis held in a wind tunnel at its mean state, and in free flight: loads over a beat.

Run `python examples/bird_wind_tunnel.py [DIRECTORY]`; the figure goes to the directory.
"""

import sys
from pathlib import Path

import birdmb
from birdmb.figures import plot_tunnel_and_free_flight
from birdmb.studies import tunnel_and_free_flight

IBIS = Path(__file__).parent.parent / "topologies" / "ibis.toml"


def main(directory: Path) -> None:
    cycle = birdmb.find_limit_cycle(birdmb.RigidModel(birdmb.load_bird(IBIS)))
    loads = tunnel_and_free_flight(cycle)
    print("                         tunnel: mean, from, to            free: mean, from, to")
    for name in ("thrust", "lift", "pitching_moment", "wing_power"):
        numbers = [
            f"{round(values[:-1].mean(), 6) + 0.0:9.4f} {values.min():9.3f} {values.max():9.3f}"
            for values in loads[name].values
        ]
        print(f"{name:>15s} ({loads[name].attrs['units']:>3s})   " + "   ".join(numbers))
    directory.mkdir(parents=True, exist_ok=True)
    plot_tunnel_and_free_flight(cycle).savefig(directory / "wind_tunnel.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "results"))
