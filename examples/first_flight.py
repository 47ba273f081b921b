"""
A first flight
==============

The ibis of the package, flown with massless wings: its limit cycle, the Floquet multipliers that
say whether it flies stably by itself, and the loads over a beat.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import birdmb

bird = birdmb.load_bird("ibis")
cycle = birdmb.find_limit_cycle(birdmb.RigidModel(bird))
print(f"{cycle.mean_speed:.2f} m/s, climbing {cycle.mean_climb_rate:+.2f} m/s: {cycle.stability}")
for multiplier, error in zip(cycle.multipliers, cycle.multiplier_errors, strict=True):
    print(f"{multiplier:.6f} ± {error:.0e}")

# %%
# The multiplier beyond 1 belongs to a disturbance that doubles within two beats.

cycle.plot()

# %%
# A beat holds states, loads and powers at even times. Forces are in body axes: x forward, y to the
# right, z down.

beat = cycle.beat
for index in (0, len(beat.loads) // 2):
    loads: birdmb.Loads = beat.loads[index]
    forward, _, down = loads.force
    print(f"t = {beat.times[index]:.3f} s: lift {-down:5.1f} N, forward {forward:5.2f} N")

# %%
# Any value of a bird has a dotted name, and a variation is a new bird. With a spring between the
# flap of the shoulder and its driver, wings of some mass swing in the air.

sprung = bird.with_joint("shoulder.flap", stiffness=20.0, damping=0.2)
compliant = birdmb.find_limit_cycle(birdmb.MultibodyModel(sprung))
print(compliant)

# %%
# What becomes of the bird when it is left alone: on its limit cycle, which is unstable, for four
# beats. Any state at any time can be asked for by name.

flight: birdmb.Flight = cycle.model.trajectory(cycle.x0, 0.0, 4 * cycle.period)
print(np.degrees(flight.at([0.0, 0.5, 1.0])["theta"]))

# %%
# A flight is kept in a file, with its bird and all settings, and comes back equal to the last bit.

with tempfile.TemporaryDirectory() as folder:
    path = cycle.save(Path(folder) / "cycle.nc")
    again = birdmb.load_cycle(path)
print(again)
assert np.array_equal(again.multipliers, cycle.multipliers)
plt.show()
