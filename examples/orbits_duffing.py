"""Forced Duffing oscillator: the resonance curve, followed through both of its folds.

Run `python examples/orbits_duffing.py [DIRECTORY]`; the figure goes to the directory.
"""

import sys
from pathlib import Path

import numpy as np

from birdmb.orbits import OdeModel, continue_branch


def duffing(frequency: float, damping: float = 0.2, force: float = 0.3) -> OdeModel:
    """x'' + damping x' + x + x**3 = force cos(frequency t)."""
    return OdeModel(
        lambda t, s: [
            s[1],
            -damping * s[1] - s[0] - s[0] ** 3 + force * np.cos(frequency * t),
        ],
        ("x", "v"),
        period=2 * np.pi / frequency,
        jacobian=lambda _t, s: [[0, 1], [-1 - 3 * s[0] ** 2, -damping]],
        guess=[0.3, 0.0],
    )


def main(directory: Path) -> None:
    directory.mkdir(parents=True, exist_ok=True)
    branch = continue_branch(
        duffing,
        (0.6, 2.0),
        parameter_name="frequency",
        observables={"amplitude": lambda cycle: float(np.ptp(cycle.trajectory().states[:, 0]) / 2)},
    )
    print(f"{len(branch.points)} orbits from frequency 0.6 to {branch.parameters[-1]:.6g}")
    for found in branch.bifurcations:
        amplitude = found.point.observables["amplitude"]
        print(f"{found.kind} at frequency {found.parameter:.7f}, amplitude {amplitude:.5f}")
    branch.plot("amplitude").savefig(directory / "duffing_resonance.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
