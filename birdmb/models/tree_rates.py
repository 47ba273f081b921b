"""Accelerations of the multibody bird at many instants at once.

Exudyn gives the mass matrix and what inertia and gravity leave on the left-hand side; air, springs,
drivers and the partition into prescribed and free coordinates are one compiled call.
"""

import numpy as np

from birdmb._typing import BoolArray, FloatArray
from birdmb.aerodynamics.airframe import Airframe
from birdmb.models.exudyn_tree import BODY_COORDINATES, TreeInertia
from birdmb.models.failures import overflow_told, wing_misplaced
from birdmb.models.instants import Instants
from birdmb.models.rates_kernel import free_accelerations
from birdmb.models.springs import springs_of
from birdmb.topology import Bird
from birdmb.wing.arrays import WingArrays
from birdmb.wing.stacked import stacked_shapes


class TreeRates:
    """Right-hand sides of the equations of motion of a bird's tree.

    Args:
        bird: the bird.
        wing: its wing.
        turning: how many joints at the shoulder turn the wing as a whole.
        frame: constants of the air, tail and body.
        prescribed: which coordinates (c,) follow a given motion.
        instants: what time alone determines of the wing.
    """

    def __init__(
        self,
        bird: Bird,
        wing: WingArrays,
        turning: int,
        frame: Airframe,
        prescribed: BoolArray,
        instants: Instants,
    ) -> None:
        self._bird, self._wing = bird, wing
        self._turning, self._frame, self._prescribed = turning, frame, prescribed
        self._instants = instants
        self._right_wing = slice(BODY_COORDINATES, (prescribed.size + BODY_COORDINATES) // 2)
        self._springs = springs_of(bird)
        self.inertia = TreeInertia(bird)

    def accelerations(
        self, times: FloatArray, q: FloatArray, v: FloatArray, air: FloatArray
    ) -> FloatArray:
        """Accelerations (K, F) of the free coordinates of body and right wing.

        At `times` (K,) s, coordinates q and velocities v (K, c) of the tree, and velocities `air`
        (K, 2) m/s of the air in the world, forward and down.

        Raises:
            StateError: no lifting line fits the wing, the wings meet, or the motion is beyond
                floating point.
        """
        distinct, which = np.unique(times, return_inverse=True)
        instants = self._instants.stacked(distinct)
        shapes, shape_of = instants.shapes, which
        if shapes is None:
            angles, rates = (moving[:, self._right_wing] for moving in (q, v))
            each = zip(times.tolist(), angles, rates, strict=True)
            shapes = stacked_shapes([self._instants.shape(*moving) for moving in each])
            shape_of = np.arange(len(times))
        mass, bias = self.inertia.at(q, v)
        with overflow_told(self._bird, f"the acceleration at t = {times[0]:.4g} s"):
            found, clearance = free_accelerations(
                self._wing,
                shapes,
                shape_of,
                self._turning,
                self._frame,
                self._springs,
                self._prescribed,
                q,
                v,
                instants.angles[which],
                instants.rates[which],
                instants.accelerations[which],
                air,
                mass,
                bias,
            )
        misplaced = ~(clearance >= 0.0)
        if misplaced.any():
            k = int(np.argmax(misplaced))
            raise wing_misplaced(
                self._bird, float(times[k]), q[k, self._right_wing], float(clearance[k])
            )
        return found
