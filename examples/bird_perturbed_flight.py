"""
After a disturbance
===================

The ibis after a disturbance along each mode of its limit cycle, over five beats, by the full model.
"""

import matplotlib.pyplot as plt
import numpy as np

import birdmb
from birdmb.figures import plot_perturbed_flight

cycle = birdmb.find_limit_cycle(birdmb.RigidModel(birdmb.load_bird("ibis")))
flight = birdmb.perturbed_flight(cycle, amplitude=0.05, periods=5)
print("multiplier        size of the disturbance after 0 to 5 beats (state scale)   height lost")
for mode in flight.mode.values:
    at = flight.sel(mode=mode)
    deviation = at.deviation.sel(time=cycle.period * flight.beat, method="nearest")
    sizes = np.linalg.norm(deviation / cycle.state_scale, axis=-1)
    lost = float(flight.orbit_h[-1] - at.h[-1])
    print(
        f"{cycle.multipliers[mode]:.4f}  "
        + "".join(f"{size:10.5f}" for size in sizes)
        + f"  {lost:+9.3f} m"
    )

# %%

plot_perturbed_flight(flight)

# %%

plt.show()
