"""
Gusts
=====

The ibis with its tail spread, through upward gusts of three shapes, by the full model and by the
linear one. See :doc:`/gusts`.
"""

from collections.abc import Callable, Sequence

import matplotlib.pyplot as plt
import numpy as np

import birdmb

bird = birdmb.load_bird("ibis_tail").with_values({"wing.discretisation": 8})
cycle = birdmb.find_limit_cycle(birdmb.RigidModel(bird))
gusts: dict[str, Callable[[float], Sequence[float]]] = {
    "Gaussian": birdmb.GaussianGust(vertical=1.0),
    "1-cosine": birdmb.CosineGust(vertical=1.0),
    "step": birdmb.StepGust(vertical=1.0),
}
print("gust         largest deviation   from linear   height gained")
for name, gust in gusts.items():
    flight = birdmb.gust_response(cycle, gust, periods=8)
    size, apart = (
        float(np.abs(what / cycle.state_scale).max())
        for what in (flight.deviation, flight.deviation - flight.linear)
    )
    gained = float(flight.h[-1] - flight.orbit_h[-1])
    print(f"{name:12} {size:17.4f}   {apart:11.4f}   {gained:+11.3f} m")

# %%
# The deviations, and the Floquet modes in them.

flight = birdmb.gust_response(cycle, gusts["Gaussian"], periods=8)
birdmb.plot_gust_response(flight)

# %%

plt.show()
