"""The ibis with wider and narrower wingbeats: speed, climb rate, path angle and power.

Run `python examples/bird_flap_amplitude.py [DIRECTORY]`; the figure goes to the directory.
"""

import sys
from pathlib import Path

import numpy as np

import birdmb
from birdmb.figures import plot_performance
from birdmb.studies import parameter_study

IBIS = Path(__file__).parent.parent / "topologies" / "ibis.toml"
AMPLITUDE = "shoulder.flap.amplitude_deg"


def main(directory: Path) -> None:
    study = parameter_study(birdmb.load_bird(IBIS), AMPLITUDE, np.arange(30.0, 61.0, 3.0))
    print("amplitude (deg)  speed (m/s)  climb rate (m/s)  path angle (deg)  power (W)")
    for value in study[AMPLITUDE].values:
        at = study.sel({AMPLITUDE: value})
        print(
            f"{value:15.1f}  {at.mean_speed:11.3f}  {at.mean_climb_rate:+16.3f}  "
            f"{np.degrees(at.path_angle):+16.2f}  {at.power:9.2f}"
        )
    directory.mkdir(parents=True, exist_ok=True)
    plot_performance(study).savefig(directory / "flap_amplitude.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "results"))
