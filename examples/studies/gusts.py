"""The ibis with its tail spread through an upward gust, rigid and with a sprung shoulder.

Run `python examples/studies/gusts.py [DIRECTORY] [--coarse]`; the figures go to the directory. It
also prints how the difference from the linear response falls as the gust does: with its square.
"""

import argparse
from pathlib import Path

import numpy as np

import birdmb

IBIS = Path(__file__).parents[2] / "topologies" / "ibis_tail.toml"


def main(directory: Path, *, coarse: bool) -> None:
    bird = birdmb.load_bird(IBIS)
    if coarse:
        bird = bird.with_values({"wing.discretisation": 4})
    sprung = bird.with_joint("shoulder.flap", stiffness=20.0, damping=0.2)
    directory.mkdir(parents=True, exist_ok=True)
    print("model       gust, m/s   largest deviation   from linear   ratio     height gained")
    for name, model in {
        "rigid": birdmb.RigidModel(bird),
        "multibody": birdmb.MultibodyModel(sprung),
    }.items():
        cycle = birdmb.find_limit_cycle(model)
        before = np.nan
        for strength in (2.0, 1.0) if coarse else (2.0, 1.0, 0.5, 0.25):
            flight = birdmb.gust_response(
                cycle, birdmb.GaussianGust(vertical=strength), periods=2 if coarse else 10
            )
            size, apart = (
                float(np.abs(what / cycle.state_scale).max())
                for what in (flight.deviation, flight.deviation - flight.linear)
            )
            gained = float(flight.h[-1] - flight.orbit_h[-1])
            ratio = f"{before / apart:6.2f}" if np.isfinite(before) else "      "
            print(
                f"{name:10}  {strength:9.2f}  {size:18.5f}  {apart:12.6f}  {ratio}  "
                f"{gained:+12.3f} m"
            )
            before = apart
            if strength == 1.0:
                figure = birdmb.plot_gust_response(flight)
                figure.savefig(directory / f"gust_{name}.png", dpi=150)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", nargs="?", type=Path, default=Path("results"))
    parser.add_argument("--coarse", action="store_true", help="few flights, coarse wings: quick")
    options = parser.parse_args()
    main(options.directory, coarse=options.coarse)
