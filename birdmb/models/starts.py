"""States from which to look for all flights of a bird."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from birdmb._typing import FloatArray

if TYPE_CHECKING:
    from birdmb.models.wing_model import BirdModel

# Parts of the speed at which the wings carry the weight with this lift coefficient; degrees. What
# is most likely first.
_LIFT_COEFFICIENT = 0.5
SPEEDS = (1.0, 1.5, 0.7, 2.2, 0.4)
INCIDENCES = (5.0, 15.0, -5.0)
PATH_ANGLES = (0.0, -20.0, 20.0, -60.0, 60.0)
_TYPICAL_SPEED = 10.0  # m/s, without weight or air
_BANK = 0.5  # rad, of turns
# Where each start is dear.
FEW_SPEEDS = (1.0, 1.6, 0.65)
FEW_INCIDENCES = (5.0,)
FEW_PATH_ANGLES = (0.0, -25.0)


def steady_states(
    model: BirdModel,
    speeds: tuple[float, ...],
    incidences: tuple[float, ...],
    path_angles: tuple[float, ...],
) -> FloatArray:
    """States (S, 4) u, w, q, theta of steady flights, all combinations.

    `speeds` are parts of the one at which the wings carry the weight, angles are in degrees; raises
    `StateError` where the wing has no area.
    """
    weight = model.mass * model.bird.gravity
    lift = 0.5 * model.aero.density * model.wing_area * _LIFT_COEFFICIENT  # at 1 m/s
    typical = float(np.sqrt(weight / lift)) if weight and lift else _TYPICAL_SPEED
    v, alpha, gamma = (
        axis.ravel()
        for axis in np.meshgrid(
            typical * np.array(speeds),
            np.radians(incidences),
            np.radians(path_angles),
            indexing="ij",
        )
    )
    return np.column_stack([v * np.cos(alpha), v * np.sin(alpha), np.zeros(v.size), alpha + gamma])


def steady_turns(space: FloatArray, gravity: float) -> FloatArray:
    """States in space (2 S, 8) of coordinated turns to the right and to the left.

    Of straight flights (S, 8), each banked so that its lift turns the path: tan(bank) = V omega/g.
    """
    speed = np.hypot(space[:, 0], space[:, 2])
    turns = []
    for bank in (_BANK, -_BANK):
        rate = gravity * np.tan(bank) / speed
        turn = space.copy()
        turn[:, 4], turn[:, 5], turn[:, 6] = rate * np.sin(bank), rate * np.cos(bank), bank
        turns.append(turn)
    return np.vstack(turns)
