"""Accelerations of the multibody bird at many instants at once, in one or two compiled calls."""

from __future__ import annotations

import numpy as np

from birdmb._typing import BoolArray, FloatArray
from birdmb.aerodynamics.airframe import Airframe
from birdmb.models.exudyn_tree import BODY_COORDINATES, TreeInertia, tree_links
from birdmb.models.failures import overflow_told, wing_misplaced
from birdmb.models.instants import Instants
from birdmb.models.rates_kernel import Constants, Drivers, Motion, free_accelerations
from birdmb.models.row_groups import groups_of
from birdmb.models.springs import springs_of
from birdmb.topology import Bird
from birdmb.wing.arrays import WingArrays


class TreeRates:
    """Right-hand sides of the equations of motion of a bird's tree.

    Args:
        bird: the bird.
        wing: its wing.
        rigid_joint_count: how many joints at the shoulder turn the wing as a whole.
        frame: constants of the air, tail and body.
        prescribed: which coordinates (c,) of the tree follow a given motion.
        instants: what time alone determines of the wing.
    """

    def __init__(
        self,
        bird: Bird,
        wing: WingArrays,
        rigid_joint_count: int,
        frame: Airframe,
        prescribed: BoolArray,
        instants: Instants,
    ) -> None:
        self._bird, self._rigid_joint_count, self._instants = bird, rigid_joint_count, instants
        right = prescribed[: (prescribed.size + BODY_COORDINATES) // 2]
        self._constants = Constants(
            wing, tree_links(bird), frame, springs_of(bird), right, rigid_joint_count
        )
        self.inertia = TreeInertia(bird)

    def accelerations(self, times: FloatArray, motion: Motion) -> FloatArray:
        """Accelerations (K, F) of the free coordinates of body and right wing.

        At `times` (K,) s. The body's are in space, in body axes.

        Raises:
            StateError: no lifting line fits the wing, the wings meet, or the motion is beyond
                floating point.
        """
        distinct, time_of = np.unique(times, return_inverse=True)
        instants = self._instants.stacked(distinct)
        shapes, shape_of = instants.shapes, time_of
        if shapes is None:
            alike = groups_of(time_of, motion.angles[:, self._rigid_joint_count :])
            first, shape_of = alike.first, alike.of
            shapes = self._instants.shapes(times[first], motion.angles[first], motion.rates[first])
        drivers = Drivers(instants.angles, instants.rates, instants.accelerations)
        with overflow_told(self._bird, f"the acceleration at t = {times[0]:.4g} s"):
            found, clearance = free_accelerations(
                self._constants, shapes, shape_of, time_of, drivers, motion
            )
        misplaced = ~(clearance >= 0.0)
        if misplaced.any():
            k = int(np.argmax(misplaced))
            raise wing_misplaced(self._bird, float(times[k]), motion.angles[k], float(clearance[k]))
        return found
