"""
A bird of one's own
===================

From the weighed and measured parts of a pigeon to its masses and inertias; then the same bird at
the size of a jackdaw.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt

import birdmb
from birdmb.figures import plot_wing_phases

HERE = Path(birdmb.__file__).parents[1] / "examples"

pigeon = birdmb.bird_from_morphology(HERE / "pigeon_morphology.toml")
print(f"{pigeon.name}: {pigeon.total_mass:.4f} kg, body {pigeon.body.mass:.4f} kg")
for name, segment in pigeon.segments.items():
    print(f"{name:8}{segment.length:.4f} m {1e3 * segment.mass:6.2f} g")

# %%
# What is not given follows from the allometric laws of birds.

scaled = birdmb.scale_bird(pigeon, mass=0.215, frequency=5.95)
print("\n".join(scaled.assumptions))

# %%
# A topology file keeps it, and can be edited by hand.

with TemporaryDirectory() as directory:
    path = scaled.bird.save(Path(directory) / "jackdaw.toml")
    print("\n".join(path.read_text(encoding="utf-8").splitlines()[:16]))
    again = birdmb.load_bird(path)
print(again == scaled.bird)

# %%
# Its wings over a beat.

plot_wing_phases(birdmb.find_limit_cycle(birdmb.RigidModel(again)))

# %%

plt.show()
