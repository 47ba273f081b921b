"""Where a flying body is in the world, and how it is turned.

World axes: x along the first heading, y to the left, z up; m from the body's first place. Body
axes: x forward, y right, z down.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from birdmb._typing import FloatArray
from birdmb.models.motion import SPACE_STATES
from birdmb.studies.perturbed import path_in_space

# From axes forward, right and down to forward, left and up.
_UPRIGHT = np.array([1.0, -1.0, -1.0])
_PHI, _THETA = SPACE_STATES.index("phi"), SPACE_STATES.index("theta")


@dataclass(frozen=True)
class Placing:
    """The body at F instants.

    Attributes:
        position: (F, 3) m, the body's centre of mass in world axes.
        axes: (F, 3, 3), the body's axes in the columns, in world axes.
    """

    position: FloatArray
    axes: FloatArray

    def points(self, at: FloatArray) -> FloatArray:
        """Points (F, ..., 3) m in world axes, of points of the same shape in body axes."""
        turned = self.vectors(at)
        between = (1,) * (turned.ndim - 2)
        return np.asarray(turned + self.position.reshape(-1, *between, 3))

    def vectors(self, along: FloatArray) -> FloatArray:
        """Vectors (F, ..., 3) in world axes, of vectors of the same shape in body axes."""
        return np.einsum("fab,f...b->f...a", self.axes, along)


def place_body(times: FloatArray, space: FloatArray) -> Placing:
    """The body at `times` (F,) s in states in space (F, 8), as `birdmb.models.motion` has them."""
    path, heading = path_in_space(times, space)
    angles = np.column_stack([heading, space[:, _THETA], space[:, _PHI]])
    turned = Rotation.from_euler("ZYX", angles).as_matrix()
    x, height, right = path.T
    return Placing(
        position=np.column_stack([x, -right, height]),
        axes=_UPRIGHT[:, None] * turned,
    )
