"""
In a wind tunnel and in free flight
===================================

The ibis held in a wind tunnel at its mean state, and set free: loads over a beat.
"""

import matplotlib.pyplot as plt

import birdmb
from birdmb.figures import plot_tunnel_and_free_flight

cycle = birdmb.find_limit_cycle(birdmb.RigidModel(birdmb.load_bird("ibis")))
loads = birdmb.tunnel_and_free_flight(cycle)
print("                         tunnel: mean, from, to            free: mean, from, to")
for name in ("thrust", "lift", "pitching_moment", "wing_power"):
    numbers = [
        f"{round(values[:-1].mean(), 6) + 0.0:9.4f} {values.min():9.3f} {values.max():9.3f}"
        for values in loads[name].values
    ]
    print(f"{name:>15s} ({loads[name].attrs['units']:>3s})   " + "   ".join(numbers))

# %%

plot_tunnel_and_free_flight(cycle)

# %%

plt.show()
