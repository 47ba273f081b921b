"""
The edge of an instability tongue
=================================

The equation of Mathieu: its zero solution as an orbit, and where that loses its stability.
"""

import matplotlib.pyplot as plt
import numpy as np

from birdmb import OdeModel, floquet, stability_boundary
from birdmb.orbits import Steps


def mathieu(a: float, q: float, damping: float = 0.0) -> OdeModel:
    """x'' + damping x' + (a - 2 q cos 2t) x = 0."""
    return OdeModel(
        lambda t, s: [s[1], -damping * s[1] - (a - 2 * q * np.cos(2 * t)) * s[0]],
        ("x", "v"),
        period=np.pi,
        guess=[0.0, 0.0],
        state_scale=[1.0, 1.0],
    )


for a, q in ((1, 0.5), (2, 1), (3, 2), (4, 5)):
    orbit = floquet(mathieu(a, q), [0.0, 0.0], segments=5)
    pair = ", ".join(f"{value:.9f}" for value in orbit.multipliers)
    print(f"a = {a}, q = {q}: {orbit.stability:9s} multipliers {pair}")

# %%
# For each a, the q at which the first tongue begins, with some damping.

boundary = stability_boundary(
    lambda q, a: mathieu(a, q, damping=0.1),
    (0.0, 1.0),
    np.linspace(0.6, 1.4, 9),
    first_name="q",
    second_name="a",
    steps=Steps(first=0.1, longest=0.2),
)
print(boundary.to_xarray()["first_parameter"].to_series())

# %%

boundary.plot()

# %%

plt.show()
