"""A wing and its mirror image in symmetric flight."""

import numpy as np

from birdmb.aerodynamics.pair import pair_loads, pair_wrench
from birdmb.aerodynamics.twist_loads import wing_wrench

THIN = np.array([2.0 * np.pi, 0.0, 0.0])  # profile: lift slope, zero-lift angle, moment


def element_loads(placed, density, profile_drag, u, w, q):
    """Loads of the wing's elements on a body that moves at u, w (m/s) and q (rad/s)."""
    twist = np.array([u, 0.0, w, 0.0, q, 0.0])
    return pair_loads(placed, placed, True, density, profile_drag, twist)[0]


def resultant(placed, loads):
    """F_x, F_z (N) and the pitching moment (N m) about G of both wings."""
    of_one = wing_wrench(placed.position, loads.wrench[:, :, None])
    return pair_wrench(of_one, of_one)[::2, 0]
