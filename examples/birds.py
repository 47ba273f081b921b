"""
The birds of the package
========================

Each flown with massless wings, on coarse ones. ``python examples/studies/all_birds.py`` prints the
table of :doc:`/birds`, by both models and on the wings as they are.
"""

import matplotlib.pyplot as plt
import numpy as np

import birdmb

moduli = {}
print(f"{'bird':24}{'m/s':>7}{'climb':>8}{'|Λ|max':>9}  verdict")
for name in birdmb.bird_names():
    bird = birdmb.load_bird(name).with_values({"wing.discretisation": 8})
    cycle = birdmb.find_limit_cycle(birdmb.RigidModel(bird))
    moduli[name] = largest = np.abs(cycle.multipliers).max()
    print(
        f"{name:24}{cycle.mean_speed:7.2f}{cycle.mean_climb_rate:+8.2f}{largest:9.4f}  "
        f"{cycle.stability}"
    )

# %%

figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
axes.barh(list(moduli), list(moduli.values()), color="0.6")
axes.axvline(1.0, color="black", lw=0.8)
axes.set(xlabel="|Λ|max: a disturbance grows beyond 1", xlim=(0.8, None))
axes.invert_yaxis()
plt.show()
