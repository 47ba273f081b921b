"""
Following a flight past a fold
==============================

The ibis with an ever softer shoulder, on a coarse wing: followed, not searched for, its flight
turns back where a search would only find nothing. See :doc:`/stiffness_branch`.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt

import birdmb
from birdmb.figures import plot_bird_branch
from birdmb.orbits import Steps

STIFFNESS = "shoulder.flap.stiffness"
bird = birdmb.load_bird("ibis_compliant_shoulder").with_values({"wing.discretisation": 6})

directory = TemporaryDirectory()
store = Path(directory.name) / "branch.nc"
branch = birdmb.bird_branch(
    bird, STIFFNESS, (7.0, 4.0), store=store, steps=Steps(first=0.2, longest=0.3), max_points=12
)
for point in branch.points[::2]:
    print(
        f"{point.parameter:7.3f} N m/rad  {point.observables['mean_speed']:6.2f} m/s  "
        f"|Λ|max {abs(point.multipliers[0]):.4f}  {point.stability}"
    )
for found in branch.bifurcations:
    print(f"{found.kind} at {found.parameter:.4f} ± {found.parameter_error:.0e} N m/rad")

# %%
# Every point is in the file as soon as it is found; a branch that was read goes on with
# ``resume``.

kept = birdmb.load_branch(store)
print(len(kept.points), kept.parameter_name, kept.stopped)
directory.cleanup()

# %%

plot_bird_branch(branch)

# %%

plt.show()
