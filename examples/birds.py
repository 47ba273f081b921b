"""
The birds of the package
========================

Each flown with massless wings, on coarse ones. ``python examples/studies/all_birds.py`` prints the
table of :doc:`/birds`, by both models and on the wings as they are.
"""

import numpy as np

import birdmb

print(f"{'bird':24}{'m/s':>7}{'climb':>8}{'|Λ|max':>9}  verdict")
for name in birdmb.bird_names():
    bird = birdmb.load_bird(name).with_values({"wing.discretisation": 8})
    cycle = birdmb.find_limit_cycle(birdmb.RigidModel(bird))
    largest = np.abs(cycle.multipliers).max()
    print(
        f"{name:24}{cycle.mean_speed:7.2f}{cycle.mean_climb_rate:+8.2f}{largest:9.4f}  "
        f"{cycle.stability}"
    )
