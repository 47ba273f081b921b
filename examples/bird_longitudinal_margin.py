"""The ibis with its shoulders further forward or aft: Floquet multipliers.

The longitudinal margin is the distance of the shoulders ahead of the centre of mass, by 0.15 m.

Run `python examples/bird_longitudinal_margin.py [DIRECTORY]`; the figure goes to the directory.
"""

import sys
from pathlib import Path

import numpy as np

import birdmb
from birdmb.figures import plot_multiplier_locus
from birdmb.studies import parameter_study

IBIS = Path(__file__).parent.parent / "topologies" / "ibis.toml"


def main(directory: Path) -> None:
    # Downwards from a cycle that is found from scratch: each of the others starts from the last.
    margins = np.arange(0.40, 0.195, -0.01)
    study = parameter_study(birdmb.load_bird(IBIS), "wing.root.x", 0.15 * margins)
    study = study.assign_coords({"longitudinal margin": ("wing.root.x", margins)})
    study = study.swap_dims({"wing.root.x": "longitudinal margin"})
    print("margin  speed (m/s)  climb rate (m/s)  multipliers (* outside the model's validity)")
    for margin in margins:
        at = study.sel({"longitudinal margin": margin})
        multipliers = at.multiplier_real.values + 1j * at.multiplier_imag.values
        print(
            f"{margin:6.2f}  {at.mean_speed:11.3f}  {at.mean_climb_rate:+16.3f}  "
            + "  ".join(f"{value:.3f}" for value in multipliers)
            + (" *" if at.warning.item() else "")
        )
    directory.mkdir(parents=True, exist_ok=True)
    plot_multiplier_locus(study).savefig(directory / "longitudinal_margin.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "results"))
