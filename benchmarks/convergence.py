"""Errors of limit cycles over the number of nodes (collocation) and of time steps (shooting).

Against collocation with 151 nodes. Prints them and draws docs/figures/orbit_errors.png:

    python benchmarks/convergence.py
"""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt

import birdmb

ROOT = Path(__file__).resolve().parents[1]
NODES = (9, 13, 17, 21, 25, 31, 37, 45, 55)
STEPS = (30, 40, 60, 80, 120, 160, 240)
EXACT = 151
BIRDS = (
    ("ibis", birdmb.RigidModel, "ibis, rigid", {}),
    (
        "ibis_compliant_shoulder",
        birdmb.MultibodyModel,
        "ibis, shoulder compliant",
        {"integrator": "explicit"},
    ),
)


def errors(cycle: birdmb.LimitCycle, exact: birdmb.LimitCycle) -> tuple[float, float]:
    """Of the states, in their typical sizes, and of the largest multiplier."""
    # Shooting knows states at its steps: all the numbers of steps share these.
    count = 200 if cycle.method == "collocation" else 5
    times = exact.period * np.arange(count) / count
    difference = cycle.trajectory(times).states - exact.trajectory(times).states
    of_states = np.abs(difference / exact.state_scale).max()
    return float(of_states), float(abs(cycle.multipliers[0] - exact.multipliers[0]))


def main() -> None:
    """Print the errors and draw them."""
    mpl.use("agg")
    figure, panels = plt.subplots(1, 2, figsize=(9.0, 3.6), sharey=True, layout="constrained")
    looks = ({"color": "C0"}, {"color": "C3", "mfc": "w"})
    for (name, kind, label, options), look in zip(BIRDS, looks, strict=True):
        bird = birdmb.load_bird(ROOT / "topologies" / f"{name}.toml")
        exact = birdmb.find_limit_cycle(kind(bird), nodes=EXACT)
        print(f"{label}: |Lambda|max = {abs(exact.multipliers[0]):.9f}")
        collocated, shot = [], []
        for nodes in NODES:
            cycle = birdmb.find_limit_cycle(kind(bird), exact, nodes=nodes)
            collocated.append(errors(cycle, exact))
            print(
                f"  {nodes:4d} nodes: states {collocated[-1][0]:.1e}, bar {cycle.state_error:.1e}; "
                f"multiplier {collocated[-1][1]:.1e}, bar {cycle.multiplier_errors[0]:.1e}"
            )
        for steps in STEPS:
            model = kind(bird, steps_per_beat=steps, **options)
            cycle = birdmb.find_limit_cycle(model, exact.x0, method="shooting", tolerance=1e-12)
            shot.append(errors(cycle, exact))
            print(f"  {steps:4d} steps: states {shot[-1][0]:.1e}, multiplier {shot[-1][1]:.1e}")
        for panel, numbers, found in ((panels[0], NODES, collocated), (panels[1], STEPS, shot)):
            of_states, of_multiplier = np.array(found).T
            panel.semilogy(numbers, of_states, "o-", label=f"states, {label}", **look)
            panel.semilogy(numbers, of_multiplier, "s--", label=f"|Λ|max, {label}", **look)
    panels[0].set(xlabel="nodes a beat", ylabel="error", title="collocation")
    panels[1].set(xlabel="integration steps a beat", title="shooting", xscale="log")
    panels[1].set_xticks(STEPS, [str(n) for n in STEPS])
    panels[1].minorticks_off()
    for panel in panels:
        panel.grid(alpha=0.3)
    panels[0].legend(frameon=False, fontsize=8)
    figure.savefig(ROOT / "docs" / "figures" / "orbit_errors.png", dpi=150)


if __name__ == "__main__":
    main()
