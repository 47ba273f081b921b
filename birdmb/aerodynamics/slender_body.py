"""Side force and moment of a slender body that moves obliquely (docs/model.md, section 9)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.topology import Bird


class SlenderBody(NamedTuple):
    """The body beside its drag; zeros where it has no such loads."""

    side_area: float  # m2, times the coefficient of the side force
    volume: float  # m3


def slender_body(bird: Bird) -> SlenderBody:
    """The slender body of a bird, as its topology gives it."""
    body = bird.body
    return SlenderBody((body.side_area or 0.0) * body.side_coefficient, body.volume or 0.0)


@kernel
def slender_body_loads(body: SlenderBody, density: float, velocity: FloatArray) -> FloatArray:
    """Wrench (6, 4) on a body that moves at a velocity (3,) m/s: value, derivatives by it.

    Side force -1/2 rho V S C v, at G; and the moment of a slender body in ideal flow, whose added
    mass across its axis is that of its volume and along it none: rho vol (0, u w, -u v), which
    turns the body across the stream (Munk, NACA Report 184, 1924).
    """
    loads = np.zeros((6, 4))
    u, v, w = velocity
    speed = np.sqrt(u * u + v * v + w * w)
    if speed > 0.0:
        strength = -0.5 * density * body.side_area
        loads[1, 0] = strength * speed * v
        for i in range(3):
            loads[1, i + 1] = strength * velocity[i] / speed * v
        loads[1, 2] += strength * speed
    added = density * body.volume
    loads[4, 0], loads[4, 1], loads[4, 3] = added * u * w, added * w, added * u
    loads[5, 0], loads[5, 1], loads[5, 2] = -added * u * v, -added * v, -added * u
    return loads
