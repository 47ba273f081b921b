"""A wing and its mirror image in symmetric flight."""

import numpy as np

from birdmb.aerodynamics.pair import pair_loads, pair_wrench
from birdmb.aerodynamics.twist_loads import wing_wrench


def element_loads(placed, density, profile, u, w, q):
    """Loads of the wing's elements on a body that moves at u, w (m/s) and q (rad/s)."""
    twist = np.array([u, 0.0, w, 0.0, q, 0.0])
    return pair_loads(placed, placed, True, density, profile, twist)[0]


def resultant(placed, force):
    """F_x, F_z (N) and the pitching moment (N m) about G of both wings."""
    of_one = wing_wrench(placed.position, force[:, :, None])
    return pair_wrench(of_one, of_one)[::2, 0]
