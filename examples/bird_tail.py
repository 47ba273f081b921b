"""
What a tail costs
=================

Level flights of the ibis over the opening of its tail, and the opening from which they are stable,
on coarse wings. See :doc:`/tail`.
"""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt

import birdmb
from birdmb.figures import plot_stability_openings

bird = birdmb.load_bird("ibis_tail").with_values({"wing.discretisation": 6})
vary = {"shoulder.flap.amplitude_deg": [42.0, 40.0], "tail.opening_deg": [40.0, 25.0, 10.0]}
with TemporaryDirectory() as directory, ThreadPoolExecutor(1) as executor:
    study = birdmb.tail_study(bird, Path(directory) / "tail.db", vary, executor=executor)
    data = study.to_xarray()
print(data[["mean_speed", "power", "largest_modulus"]].to_dataframe().round(4).to_string())

# %%
# The limit itself is followed, here over the amplitude of the flap.

curves = birdmb.stability_openings(
    bird, {"shoulder.flap.amplitude_deg": (38.0, 42.0)}, openings=(10.0, 25.0), seeds=1
)
plot_stability_openings(curves, bird.name)

# %%

plt.show()
