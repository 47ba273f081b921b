"""
A gait from a measured flight
=============================

Points on a pigeon's wing, as cameras see them, and the gait that they tell. See
:doc:`/kinematics`.
"""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import birdmb

POINTS = Path(birdmb.__file__).parents[1] / "examples" / "pigeon_points.csv"

fit: birdmb.KinematicsFit = birdmb.fit_kinematics(POINTS, "pigeon", frame="forward-left-up")
print(f"{fit.frequency:.4f} ± {fit.frequency_error:.4f} Hz from {fit.beats} beats")
motion: birdmb.JointMotion
for name, motion in fit.joints.items():
    print(
        f"{name:16}{np.degrees(motion.offset):8.2f} ± {np.degrees(motion.offset_error):.2f}°  "
        f"amplitude {np.degrees(motion.amplitudes[:1])} °"
    )
print("not told by the points:", ", ".join(fit.undetermined) or "none")

# %%

fit.plot()

# %%
# The bird with that gait flies like any other.

print(birdmb.find_limit_cycle(birdmb.RigidModel(fit.bird)))

# %%
# What cannot be read, or tells no gait, is refused with a sentence.

try:
    birdmb.fit_kinematics({"time": [0.0, 0.1], "elbow": [[0.0, 0.1, 0.0]] * 2}, "pigeon")
except birdmb.KinematicsError as error:
    print(error)
plt.show()
