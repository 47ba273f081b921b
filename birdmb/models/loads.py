"""Aerodynamic loads as users see them."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.airframe import AeroConstants
from birdmb.models.loads_kernel import StackedLoads, StackedWing
from birdmb.summary import Summarised

_WHOLE = tuple(name for name in StackedLoads._fields if name not in {"right", "left"})


@dataclass(frozen=True, repr=False)
class TailLoads(Summarised):
    """Loads of the tail at one instant, in body axes."""

    force: FloatArray
    """(3,) N."""
    position: FloatArray
    """(3,) m, centre of pressure from G."""
    angle_of_attack: float
    """rad, of the wind there to the plate, the downwash of the wings included."""
    downwash: float
    """m/s along z, induced by the wings' vortices."""


@dataclass(frozen=True, repr=False)
class WingLoads(Summarised):
    """Loads of one wing at one instant, in body axes; of the left one mirrored onto the right side.

    Arrays go from the root outwards.
    """

    position: FloatArray
    """(N, 3) m, control points from G."""
    node: FloatArray
    """(N + 1, 3) m, ends of the elements from G, from the centre line to the wing tip."""
    velocity: FloatArray
    """(N, 3) m/s, of the control points relative to the body."""
    chord: FloatArray
    """(N,) m."""
    width: FloatArray
    """(N,) m, along the span."""
    force: FloatArray
    """(N, 3) N, profile drag included."""
    moment: FloatArray
    """(N, 3) N m, of the sections' profile, about the control points."""
    profile_drag: FloatArray
    """(N, 3) N."""
    circulation: FloatArray
    """(N,) m2/s."""
    angle_of_attack: FloatArray
    """(N,) rad, between the chord and the wind in the section's plane, without the downwash."""
    speed: FloatArray
    """(N,) m/s, of the wind in the section's plane."""
    joint_torques: FloatArray
    """(A,) N m, of the air about each joint and each feather's hinge."""


@dataclass(frozen=True, repr=False)
class Loads(Summarised):
    """Loads of the air on a bird at one instant, in body axes (x forward, y right, z down)."""

    force: FloatArray
    """(3,) N, resultant of wings, tail and body."""
    moment: FloatArray
    """(3,) N m, of all of them about the body's centre of mass G."""
    tail: TailLoads | None
    """Of the tail; `None` where there is none, or where it is furled."""
    body_force: FloatArray
    """(3,) N, of the body, at G: its drag and side force."""
    body_moment: FloatArray
    """(3,) N m, of the body, about G."""
    power: float
    """W, that the wings' motion relative to the body takes: minus the work of force and moment."""
    right: WingLoads
    """Of the right wing."""
    left: WingLoads
    """Of the left wing, mirrored; in symmetric flight the same as the right one's."""


class LoadsAlong:
    """Loads of the air on a bird at K instants.

    Args:
        stack: the loads, each array stacked along a first axis.
        aero: constants of the air, tail and body.
    """

    def __init__(self, stack: StackedLoads, aero: AeroConstants) -> None:
        self.stack, self._aero = stack, aero

    def taken(self, instants: IntArray) -> LoadsAlong:
        """Those at some of the instants (P,)."""
        stack = self.stack
        right, left = (
            StackedWing(*(array[instants] for array in wing)) for wing in (stack.right, stack.left)
        )
        whole = {name: getattr(stack, name)[instants] for name in _WHOLE}
        return LoadsAlong(StackedLoads(**whole, right=right, left=left), self._aero)

    @cached_property
    def power(self) -> FloatArray:
        """Power (K,) W that the wings' motion relative to the body takes."""
        right, left = (
            (wing.force * wing.velocity + wing.moment * wing.spin).sum(axis=(1, 2))
            for wing in (self.stack.right, self.stack.left)
        )
        return np.asarray(-right - left)

    @property
    def joint_torques(self) -> FloatArray:
        """Torques (K, 2, A) N m about joints and hinges of the right wing and of the left one."""
        return np.stack([self.stack.right.joint_torques, self.stack.left.joint_torques], axis=1)

    def at(self, k: int) -> Loads:
        """Those at the k-th instant."""
        stack, tail = self.stack, self._aero.tail
        of_tail = TailLoads(
            force=stack.tail_force[k],
            position=np.array([tail.x, 0.0, tail.z]),
            angle_of_attack=float(stack.tail_angle[k]),
            downwash=float(stack.tail_downwash[k]),
        )
        return Loads(
            force=stack.force[k],
            moment=stack.moment[k],
            tail=of_tail if tail.span > 0.0 else None,
            body_force=stack.body_force[k],
            body_moment=stack.body_moment[k],
            power=float(self.power[k]),
            right=_wing_at(stack.right, k),
            left=_wing_at(stack.left, k),
        )

    def dissipation(self, twists: FloatArray) -> FloatArray:
        """Power (K, 4) W that each load takes from a bird that moves so in still air.

        Of the `DISSIPATORS`: "lift" is that of the lifting line, which is its induced drag,
        "profile" the drag of the wing's sections, "tail" and "body" all of theirs. Minus force
        times velocity of the point it acts at. `twists` (K, 6) m/s and rad/s are the body's.
        """
        stack, tail = self.stack, self._aero.tail
        wing, profile = np.zeros(len(twists)), np.zeros(len(twists))
        for side, each in ((1.0, stack.right), (-1.0, stack.left)):
            mirror = np.array([1.0, side, 1.0])
            moving = twists[:, :3] * mirror, twists[:, 3:] * mirror * side
            velocity = each.velocity + _point_velocity(*moving, each.position)
            spin = each.spin + moving[1][:, None]
            wing -= (each.force * velocity + each.moment * spin).sum(axis=(1, 2))
            profile -= (each.profile_drag * velocity).sum(axis=(1, 2))
        at_tail = np.broadcast_to([tail.x, 0.0, tail.z], (len(twists), 1, 3))
        tail_moves = _point_velocity(twists[:, :3], twists[:, 3:], at_tail)[:, 0]
        of_tail = -(stack.tail_force * tail_moves).sum(axis=1)
        of_body = np.hstack([stack.body_force, stack.body_moment])
        of_body = -(of_body * twists).sum(axis=1)
        return np.column_stack([wing - profile, profile, of_tail, of_body])


def _wing_at(stack: StackedWing, k: int) -> WingLoads:
    return WingLoads(**{f.name: getattr(stack, f.name)[k] for f in fields(WingLoads)})


def _point_velocity(velocity: FloatArray, spin: FloatArray, position: FloatArray) -> FloatArray:
    """Velocities (K, N, 3) m/s of points at `position` (K, N, 3) m fixed to a moving body."""
    return np.asarray(velocity[:, None, :] + np.cross(spin[:, None, :], position))
