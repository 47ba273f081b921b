"""
A resonance curve through its folds
===================================

The forced oscillator of Duffing, followed in the frequency through both folds of its resonance.
"""

import matplotlib.pyplot as plt
import numpy as np

from birdmb import OdeModel, continue_branch


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

# %%

branch.plot("amplitude")

# %%

plt.show()
