"""
Wider and narrower wingbeats
============================

Speed, climb rate, path angle and power of the ibis over the amplitude of its flap, each flight
found from the one before.
"""

import matplotlib.pyplot as plt
import numpy as np

import birdmb
from birdmb.figures import plot_performance

AMPLITUDE = "shoulder.flap.amplitude_deg"

study = birdmb.parameter_study(
    birdmb.load_bird("ibis"), AMPLITUDE, np.arange(30.0, 61.0, 6.0).tolist()
)
print("amplitude (deg)  speed (m/s)  climb rate (m/s)  path angle (deg)  power (W)")
for value in study[AMPLITUDE].values:
    at = study.sel({AMPLITUDE: value})
    print(
        f"{value:15.1f}  {at.mean_speed:11.3f}  {at.mean_climb_rate:+16.3f}  "
        f"{np.degrees(at.path_angle):+16.2f}  {at.power:9.2f}"
    )

# %%

plot_performance(study)

# %%

plt.show()
