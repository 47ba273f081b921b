"""Accelerations of the multibody bird at many instants at once, in one or two compiled calls."""

from __future__ import annotations

import numpy as np

from birdmb._typing import BoolArray, FloatArray, IntArray
from birdmb.aerodynamics.airframe import AeroConstants
from birdmb.aerodynamics.wake_lags import WakeLags
from birdmb.models.air_kernel import Constants, Drivers, Motion, Shapes
from birdmb.models.exudyn_tree import TreeInertia, tree_links
from birdmb.models.failures import overflow_told, wing_misplaced
from birdmb.models.instants import Instants, StackedInstants
from birdmb.models.rates_kernel import free_accelerations
from birdmb.models.row_groups import groups_of
from birdmb.models.springs import Springs
from birdmb.models.tree_forces import TreeLoads, tree_loads
from birdmb.topology import Bird
from birdmb.wing.arrays import WingArrays, joint_arrays


class TreeRates:
    """Right-hand sides of the equations of motion of a bird's tree.

    Args:
        bird: the bird.
        wing: its right wing, of which only what both sides share is read.
        instants: what time alone determines of the right and of the left wing.
        body_coordinates: those of the body, as for `bird_links`.
        is_mirrored: whether both wings always move as mirror images.
        rigid_joint_count: how many joints at the shoulder turn a wing as a whole.
        aero: constants of the air, tail and body.
        springs: of the joints and hinges of the right wing, then of the left one.
        prescribed: which coordinates (c,) of the tree follow a given motion.
        lags: where the wings' lags are kept; nowhere if the air has no memory.
    """

    def __init__(
        self,
        bird: Bird,
        wing: WingArrays,
        instants: tuple[Instants, Instants],
        *,
        body_coordinates: IntArray,
        is_mirrored: bool,
        rigid_joint_count: int,
        aero: AeroConstants,
        springs: Springs,
        prescribed: BoolArray,
        lags: WakeLags,
    ) -> None:
        self._bird, self._instants, self._coordinates = bird, instants, body_coordinates
        self._is_mirrored, self._rigid_joint_count = is_mirrored, rigid_joint_count
        both, body = springs.damping.size, body_coordinates.size
        count = both // 2 if is_mirrored else both
        self._joints = both // 2
        self.constants = Constants(
            joint_arrays(wing),
            tree_links(bird, body_coordinates, is_mirrored=is_mirrored),
            aero,
            Springs(*(each[:count] for each in springs)),
            prescribed[: body + count],
            rigid_joint_count,
            is_mirrored,
            lags,
        )
        self.inertia = TreeInertia(bird, body_coordinates)

    def accelerations(self, times: FloatArray, motion: Motion) -> tuple[FloatArray, FloatArray]:
        """Accelerations (K, F) of the free coordinates of body and wings, rates (K, L) of the lags.

        At `times` (K,) s. The body's are in space, in body axes.

        Raises:
            StateError: no lifting line fits a wing, the wings meet, or the motion is beyond
                floating point.
        """
        distinct, time_of = np.unique(times, return_inverse=True)
        drivers, instants = self.drivers_at(distinct)
        with overflow_told(self._bird, f"the acceleration at t = {times[0]:.4g} s"):
            shapes = self.shapes_at(instants, times, time_of, motion.angles, motion.rates)
            found, lag_rates, clearance = free_accelerations(
                self.constants, shapes, time_of, drivers, motion
            )
        self._refuse_misplaced(times, motion.angles, clearance)
        return found, lag_rates

    def loads(
        self, t: float, q: FloatArray, v: FloatArray, lags: FloatArray, air: FloatArray
    ) -> TreeLoads:
        """What air, springs and dampers do at t (s); see `tree_loads`."""
        times, body = np.array([t]), self._coordinates.size
        drivers, instants = self.drivers_at(times)
        count = drivers.angles.shape[1]
        angles, rates = q[None, body : body + count], v[None, body : body + count]
        by_time = all(each.shapes is not None for each in instants)
        if not (by_time or (np.isfinite(angles).all() and np.isfinite(rates).all())):
            angles, rates = drivers.angles, drivers.rates  # any will do: there are no forces
        with overflow_told(self._bird, f"the force of the air at t = {t:.4g} s"):
            shapes = self.shapes_at(instants, times, np.zeros(1, np.int64), angles, rates)
            loads, clearance = tree_loads(
                self.constants, shapes, drivers, self._coordinates, q, v, lags, air
            )
        if not clearance.min() >= 0.0:
            self._refuse_misplaced(times, angles, clearance[None])
        return loads

    def driver_accelerations(self, t: float) -> FloatArray:
        """Accelerations (n,) of the drivers, 0 for the body; only prescribed joints follow."""
        right, left = (each.stacked(np.array([t])).accelerations[0] for each in self._instants)
        return np.concatenate([np.zeros(self._coordinates.size), right, left])

    def shapes(self, times: FloatArray, angles: FloatArray, rates: FloatArray) -> Shapes:
        """Shapes of both wings at `times` (K,), `angles` and `rates` (K, 2, A).

        Those with the joints at zero that turn them, and which (2, K) of them each instant has.
        """
        distinct, time_of = np.unique(times, return_inverse=True)
        _, instants = self.drivers_at(distinct)
        flat = len(times), -1
        return self.shapes_at(instants, times, time_of, angles.reshape(flat), rates.reshape(flat))

    def drivers_at(self, distinct: FloatArray) -> tuple[Drivers, list[StackedInstants]]:
        """Drivers at times (P,) s of both wings together, and what these determine of each."""
        sides = self._instants[:1] if self._is_mirrored else self._instants
        instants = [each.stacked(distinct) for each in sides]
        if self._is_mirrored:
            (right,) = instants
            return Drivers(right.angles, right.rates, right.accelerations), instants
        angles, rates, accelerations, _ = zip(*instants, strict=True)
        return Drivers(*map(np.hstack, (angles, rates, accelerations))), instants

    def shapes_at(
        self,
        instants: list[StackedInstants],
        times: FloatArray,
        time_of: IntArray,
        angles: FloatArray,
        rates: FloatArray,
    ) -> Shapes:
        """Shapes of angles and rates (K, C) at `times` (K,), the distinct ones being `time_of`."""
        stacks, of = [], []
        for side, each in enumerate(instants):
            own = slice(side * self._joints, (side + 1) * self._joints)
            if each.shapes is not None:
                stacks.append(each.shapes)
                of.append(time_of)
                continue
            own_angles, own_rates = angles[:, own], rates[:, own]
            shaping = [own_angles[:, self._rigid_joint_count :]]
            if self.constants.lags.kept.size:
                # What changes of a shape's velocity is not linear in the rates.
                shaping.append(own_rates[:, self._rigid_joint_count :])
            alike = groups_of(time_of, np.hstack(shaping))
            first = alike.first
            stacks.append(
                self._instants[side].shapes(
                    times[first],
                    own_angles[first],
                    own_rates[first],
                    each.accelerations[time_of[first]],
                )
            )
            of.append(alike.of)
        return Shapes((stacks[0], stacks[-1]), np.array((of[0], of[-1])))

    def _refuse_misplaced(
        self, times: FloatArray, angles: FloatArray, clearance: FloatArray
    ) -> None:
        """Raise `StateError` where one of the wings has no clearance (K, 2)."""
        misplaced = ~(clearance >= 0.0)
        if misplaced.any():
            k, side = np.unravel_index(int(np.argmax(misplaced)), misplaced.shape)
            own = angles[k, : self._joints]
            if side == 1 and not self._is_mirrored:
                own = angles[k, self._joints :]
            raise wing_misplaced(self._bird, float(times[k]), own, float(clearance[k, side]))
