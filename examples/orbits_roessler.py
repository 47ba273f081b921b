"""
Period doubling and chaos
=========================

The system of Rössler: an autonomous cycle, its period doubling, and the chaos beyond.
"""

import matplotlib.pyplot as plt
import numpy as np

from birdmb import OdeModel, continue_branch, find_limit_cycle, largest_lyapunov_exponent
from birdmb.orbits import Steps


def roessler(c: float, a: float = 0.15, b: float = 0.2) -> OdeModel:
    """x' = -y - z, y' = x + a y, z' = b + z (x - c)."""
    return OdeModel(
        lambda _t, s: [-s[1] - s[2], s[0] + a * s[1], b + s[2] * (s[0] - c)],
        ("x", "y", "z"),
        jacobian=lambda _t, s: np.array([[0, -1, -1], [1, a, 0], [s[2], 0, s[0] - c]]),
        guess=[0.0, -4.6, 0.05],
    )


cycle = find_limit_cycle(roessler(3.5), period_guess=5.9, segments=2)
print(f"c = 3.5: period {cycle.period:.8f}, {cycle.stability}")
for value, error in zip(cycle.multipliers, cycle.multiplier_errors, strict=True):
    print(f"  multiplier {value.real: .9f} ± {error:.1e}")
cycle.plot()

# %%

branch = continue_branch(
    roessler, (3.5, 4.2), period_guess=5.9, parameter_name="c", steps=Steps(longest=0.2)
)
for found in branch.bifurcations:
    print(f"{found.kind} at c = {found.parameter:.7f} ± {found.parameter_error:.1e}")
branch.plot("y")

# %%
# A rough exponent, of twenty intervals; two hundred settle its third digit.

chaos = largest_lyapunov_exponent(roessler(10.0), [1.0, 1.0, 0.0], 6.0, 20)
print(f"c = 10: largest Lyapunov exponent {chaos.exponent:.4f} ± {chaos.error:.4f}")
plt.show()
