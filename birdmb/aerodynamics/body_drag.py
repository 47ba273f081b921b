"""Drag of the body at its centre of mass (docs/model.md, section 9)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.topology import Bird

_SPEED_EXPONENT = 0.197


class BodyDrag(NamedTuple):
    """Drag = `factor` times the speed to the power of 2 - `falling`; factor 0 where there is none.

    `falling` is the power of the speed with which the coefficient falls.
    """

    factor: float
    falling: float


def body_drag(bird: Bird) -> BodyDrag:
    """The drag of a bird's body, from its own numbers or else from its mass.

    Frontal area S = 0.00813 m^(2/3) (Pennycuick, Obrecht and Fuller 1988) and
    C_d = 66.6 m^-0.511 FR^0.9015 S^1.063 Re^-0.197 with the fineness ratio FR = 6.0799 m^0.1523 and
    Re on the diameter of a round body of that frontal area (Maybury, PhD thesis, University of
    Bristol, 2000; masses in kg, S in m2). The mass is that of the body without its wings.
    """
    if not bird.drag.body:
        return BodyDrag(0.0, 0.0)
    mass, drag = bird.body.mass, bird.drag
    area = drag.frontal_area or 0.00813 * mass ** (2.0 / 3.0)
    pressure = 0.5 * bird.air.density * area
    if drag.body_coefficient is not None:
        return BodyDrag(pressure * drag.body_coefficient, 0.0)
    fineness = 6.0799 * mass**0.1523
    reynolds_per_speed = np.sqrt(4.0 * area / np.pi) / bird.air.kinematic_viscosity
    coefficient = 66.6 * mass**-0.511 * fineness**0.9015 * area**1.063
    return BodyDrag(
        float(pressure * coefficient * reynolds_per_speed**-_SPEED_EXPONENT), _SPEED_EXPONENT
    )


@kernel
def body_drag_force(drag: BodyDrag, velocity: FloatArray) -> FloatArray:
    """Drag (N) of a body that moves at a velocity (3,) m/s through the air, against that motion.

    Columns: value, derivatives with respect to the velocity; (3, 4).
    """
    force = np.zeros((3, 4))
    square = velocity[0] ** 2 + velocity[1] ** 2 + velocity[2] ** 2
    if drag.factor == 0.0 or square == 0.0:
        return force
    power = 1.0 - drag.falling
    strength = drag.factor * square ** (0.5 * power)
    for i in range(3):
        force[i, 0] = -strength * velocity[i]
        for j in range(3):
            force[i, j + 1] = -strength * power * velocity[i] * velocity[j] / square
        force[i, i + 1] -= strength
    return force
