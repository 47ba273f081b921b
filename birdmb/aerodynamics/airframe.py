"""What the body, its tail and the wings' profile add to the loads of the lifting line."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.body_drag import BodyDrag, body_drag, body_drag_force
from birdmb.aerodynamics.slender_body import SlenderBody, slender_body, slender_body_loads
from birdmb.aerodynamics.tail import TailSurface, tail_force, tail_surface
from birdmb.topology import Bird


class AeroConstants(NamedTuple):
    """Constants of the air and of all that is not the wing's shape."""

    density: float  # kg/m3
    profile_drag: float  # drag coefficient of the wing's sections
    tail: TailSurface
    body: BodyDrag
    slender: SlenderBody


def aero_constants(bird: Bird) -> AeroConstants:
    """The constants of a bird; what its topology leaves out has no loads."""
    bird = bird.assembled
    return AeroConstants(
        density=bird.air.density,
        profile_drag=bird.drag.profile_coefficient,
        tail=tail_surface(bird),
        body=body_drag(bird),
        slender=slender_body(bird),
    )


@kernel
def tail_wind(tail: TailSurface, induced: FloatArray, twist: FloatArray) -> FloatArray:
    """Wind (3,) m/s at the tail of a body that moves with a `twist` (6,).

    `induced` (2,) m/s is what the wing's vortices add along x and z.
    """
    u, v, w, p, q, r = twist
    return np.array(
        [
            -u - q * tail.z + induced[0],
            -v - r * tail.x + p * tail.z,
            -w + q * tail.x + induced[1],
        ]
    )


@kernel
def airframe_loads(
    aero: AeroConstants, induced: FloatArray, twist: FloatArray, directions: IntArray
) -> FloatArray:
    """Wrench (6, 1 + D) of tail and body that move with a `twist` (6,); see `twist_loads`.

    `induced` (2, 1 + D) m/s is the velocity along x and z that the wing's vortices induce at the
    tail, with its derivatives: by the components `directions` (d,), then by what else it depends
    on. The tail lies in the plane of symmetry, where opposite circulations of both wings induce a
    velocity along y alone; it is left out, for it would only turn friction.
    """
    tail = aero.tail
    columns = induced.shape[1]
    total = np.zeros((6, columns))
    if tail.span > 0.0:
        force = tail_force(tail, aero.density, tail_wind(tail, induced[:, 0], twist))
        total[:3, 0] = force[:, 0]
        slope = np.zeros(3)
        for m in range(columns - 1):
            component = directions[m] if m < directions.size else -1
            slope[0], slope[1], slope[2] = induced[0, m + 1], 0.0, induced[1, m + 1]
            if 0 <= component < 3:
                slope[component] -= 1.0
            elif component == 3:
                slope[1] += tail.z
            elif component == 4:
                slope[0] -= tail.z
                slope[2] += tail.x
            elif component == 5:
                slope[1] -= tail.x
            for i in range(3):
                total[i, m + 1] = (
                    force[i, 1] * slope[0] + force[i, 2] * slope[1] + force[i, 3] * slope[2]
                )
        for m in range(columns):
            fx, fy, fz = total[0, m], total[1, m], total[2, m]
            total[3, m] = -tail.z * fy
            total[4, m] = tail.z * fx - tail.x * fz
            total[5, m] = tail.x * fy
    by_velocity = body_loads(aero, twist[:3])
    for i in range(6):
        total[i, 0] += by_velocity[i, 0]
        for m in range(directions.size):
            if directions[m] < 3:
                total[i, m + 1] += by_velocity[i, directions[m] + 1]
    return total


@kernel
def body_loads(aero: AeroConstants, velocity: FloatArray) -> FloatArray:
    """Wrench (6, 4) of the body at a velocity (3,) m/s: value, derivatives by the velocity."""
    loads = slender_body_loads(aero.slender, aero.density, velocity)
    loads[:3] += body_drag_force(aero.body, velocity)
    return loads
