"""What the body, its tail and the wings' profile add to the loads of the lifting line."""

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.aerodynamics.body_drag import BodyDrag, body_drag, body_drag_force
from birdmb.aerodynamics.tail import TailSurface, tail_force, tail_surface
from birdmb.topology import Bird


class Airframe(NamedTuple):
    """Constants of the air and of all that is not the wing's shape."""

    density: float  # kg/m3
    profile: float  # drag coefficient of the wing's sections
    tail: TailSurface
    body: BodyDrag


def airframe(bird: Bird) -> Airframe:
    """The constants of a bird; what its topology leaves out has no loads."""
    return Airframe(
        density=bird.air.density,
        profile=bird.drag.profile_coefficient,
        tail=tail_surface(bird),
        body=body_drag(bird),
    )


@kernel
def tail_wind(
    tail: TailSurface, induced: FloatArray, u: float, w: float, q: float
) -> tuple[float, float]:
    """Wind (m/s) along x and z at the tail of a body that moves at u, w (m/s) and q (rad/s).

    `induced` (2,) m/s is what the wing's vortices add.
    """
    return -u - q * tail.z + induced[0], -w + q * tail.x + induced[1]


@kernel
def airframe_loads(
    frame: Airframe, induced: FloatArray, u: float, w: float, q: float
) -> FloatArray:
    """Loads (3, 4) of tail and body that move at u, w (m/s) and q (rad/s).

    Rows F_x, F_z (N), M_y (N m); columns: value, d/du, d/dw, d/dq. `induced` (2, 4) m/s is the
    velocity along x and z that the wing's vortices induce at the tail, with its derivatives.
    """
    tail = frame.tail
    total = np.zeros((3, 4))
    if tail.span > 0.0:
        wind_x, wind_z = tail_wind(tail, induced[:, 0], u, w, q)
        force = tail_force(tail, frame.density, wind_x, wind_z)
        slope_x, slope_z = induced[0].copy(), induced[1].copy()
        slope_x[1] -= 1.0
        slope_x[3] -= tail.z
        slope_z[2] -= 1.0
        slope_z[3] += tail.x
        for i in range(2):
            total[i, 0] = force[i, 0]
            for m in range(1, 4):
                total[i, m] = force[i, 1] * slope_x[m] + force[i, 2] * slope_z[m]
        for m in range(4):
            total[2, m] = tail.z * total[0, m] - tail.x * total[1, m]
    if frame.body.factor > 0.0:
        total[:2, :3] += body_drag_force(frame.body, u, w)
    return total
