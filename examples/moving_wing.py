"""
A wing that heaves and pitches
==============================

Loads of a plane wing moved in a stream, as in the experiments that the loads are held against. See
:doc:`/validation`.
"""

import matplotlib.pyplot as plt
import numpy as np

import birdmb

wing = birdmb.PlaneWing.rectangular(span=0.3048, chord=0.1016)
pitch = np.radians(15) * np.exp(1j * np.radians(60))  # 60 degrees ahead of heave
motion = birdmb.WingMotion(frequency=5.0, heave=[0, 0.061], pitch=[0, pitch], pitch_axis=0.75)
loads: birdmb.MovingWingLoads = birdmb.moving_wing_loads(wing, motion, speed=3.048, density=1000.0)
print(f"mean thrust coefficient {loads.mean_thrust_coefficient:.3f}")
print(f"efficiency {loads.efficiency:.3f}")

# %%

figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
axes.plot(loads.times * motion.frequency, loads.lift, label="lift")
axes.plot(loads.times * motion.frequency, loads.thrust, "--", label="thrust")
axes.set(xlabel="periods", ylabel="force, N")
axes.legend()
plt.show()
