"""
A sweep
=======

Level flights of the ibis over the stiffness and damping of its shoulder, on a coarse wing. See
:doc:`/sweeps`.
"""

from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt

import birdmb

bird = birdmb.load_bird("ibis").with_values({"wing.discretisation": 6})
directory = TemporaryDirectory()
store = Path(directory.name) / "study.db"
run = partial(birdmb.sweep, bird, store=store)
vary: dict[str, list[float]] = {
    "shoulder.flap.stiffness": [60, 40, 30],
    "shoulder.flap.damping": [0.3, 0.2],
}
level = birdmb.Trimming({"shoulder.flap.amplitude_deg": (35.0, 60.0)})

# Threads keep this example in one process; by default a sweep takes a process for each core.
with ThreadPoolExecutor(1) as executor:
    study = run(vary, trim=level, executor=executor)
data = study.to_xarray()
print(data.largest_modulus.to_series().unstack())
print(data["shoulder.flap.amplitude_deg"].to_series().unstack())

# %%
# What is finished is kept. A store takes further values of a parameter, and no other study.

try:
    run({"body.mass": [1.1, 1.2]}, workers=1)
except birdmb.SweepError as error:
    print(error)
opened = birdmb.Study.open(store)
print(opened.total, "points,", len(opened.failures), "without a flight")

# %%

study.plot("largest_modulus")

# %%

directory.cleanup()
plt.show()
