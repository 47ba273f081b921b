"""How true the error bars of collocated cycles are: against the same with four times the nodes.

Birds and joint sets of all kinds, drawn at random from a fixed seed around the shipped ones. Prints
for each the nodes, the largest error bar of the multipliers and the largest true error over its
bar; then how many true errors exceed their bars, and by how much bars are too large in the median.

    python benchmarks/error_bars.py [--birds 48]
"""

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy.optimize import linear_sum_assignment

import birdmb
from birdmb.errors import BirdmbError

TOPOLOGIES = Path(__file__).resolve().parents[1] / "topologies"
JOINTS = ("shoulder.flap", "shoulder.sweep", "shoulder.pitch", "elbow.sweep", "forearm.roll")
# Multipliers below this are zero to any disturbance that a flight meets.
SMALLEST = 1e-12


def birds(count: int) -> Iterator[tuple[str, birdmb.MultibodyModel | birdmb.RigidModel]]:
    """Models with names, the kinds by turns."""
    random = np.random.default_rng(1)
    shipped = {
        name: birdmb.load_bird(TOPOLOGIES / f"{name}.toml")
        for name in ("ibis", "ibis_tail", "ibis_hinged_feathers")
    }
    for number in range(count):
        name = ("ibis", "ibis_tail", "ibis", "ibis_hinged_feathers")[number % 4]
        bird = shipped[name].with_values(
            {
                "wing.discretisation.elements": int(random.integers(6, 13)),
                "body.mass": shipped[name].body.mass * random.uniform(0.8, 1.3),
                "shoulder.flap.amplitude_deg": random.uniform(25.0, 45.0),
            }
        )
        if number % 4 == 1 or number % 8 == 0:
            yield f"{number} {name}, rigid", birdmb.RigidModel(bird)
            continue
        soft = random.choice(JOINTS, size=int(random.integers(1, 3)), replace=False)
        if name != "ibis_hinged_feathers":
            for joint in soft:
                stiffness, damping = 10 ** random.uniform(0.7, 2.0), 10 ** random.uniform(-1.5, 0.0)
                bird = bird.with_joint(str(joint), stiffness=stiffness, damping=damping)
            name += f" with soft {', '.join(soft)}"
        yield f"{number} {name}", birdmb.MultibodyModel(bird)


def paired(one: birdmb.LimitCycle, other: birdmb.LimitCycle) -> np.ndarray:
    """Distances (n,) of the multipliers of one cycle from those of another."""
    apart = np.abs(np.subtract.outer(one.multipliers, other.multipliers))
    rows, columns = linear_sum_assignment(apart)
    return apart[rows, columns]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--birds", type=int, default=48)
    exceeding, ratios, compared = 0, [], 0
    for name, model in birds(parser.parse_args().birds):
        try:
            cycle = birdmb.find_limit_cycle(model, method="collocation")
            exact = birdmb.find_limit_cycle(
                model, cycle, method="collocation", nodes=4 * cycle.nodes + 1, accuracy=1e-9
            )
        except BirdmbError as error:
            print(f"{name}: {str(error)[:90]}", flush=True)
            continue
        true, bars = paired(cycle, exact), cycle.multiplier_errors
        shown = np.abs(exact.multipliers) > SMALLEST
        worst = float((true[shown] / bars[shown]).max())
        of_states = float(np.abs((cycle.x0 - exact.x0) / cycle.state_scale).max())
        compared += 1
        exceeding += worst > 1 or of_states > cycle.state_error
        ratios += (bars[shown] / np.maximum(true[shown], np.finfo(float).tiny)).tolist()
        print(
            f"{name}: {cycle.nodes} nodes, |Lambda|max {abs(cycle.multipliers[0]):.6g} "
            f"+- {bars[0]:.1e}, true error / bar {worst:.2g}, of the states "
            f"{of_states / cycle.state_error:.2g} of {cycle.state_error:.1e}",
            flush=True,
        )
    print(
        f"{compared} cycles compared; {exceeding} with an error beyond its bar; a bar is "
        f"{np.median(ratios):.3g} times the true error in the median"
    )


if __name__ == "__main__":
    main()
