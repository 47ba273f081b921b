"""Loads of wings whose air remembers, on a body that moves in space (compiled kernels).

Lift is that of the bound circulation in the wind at the quarter chord, with what trailing and shed
vortices induce in it: rho Gamma U along the normal, and the suction of the leading edge along the
chord. With it come profile drag and moment, the loads of `birdmb.aerodynamics.apparent_mass` but
for those of accelerations, and, where flow separates, drag and moment of
`birdmb.aerodynamics.separation`. In steady motion they are those of `twist_loads`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.apparent_mass import ApparentInertia, apparent_wrenches
from birdmb.aerodynamics.elements import Elements
from birdmb.aerodynamics.section_motion import SectionMotion
from birdmb.aerodynamics.separation import section_wrenches
from birdmb.aerodynamics.twist_loads import element_wrenches, mirror_sign, mirrored, wing_flow
from birdmb.aerodynamics.unsteady_circulation import Unsteady


class SideFlow(NamedTuple):
    """What the N elements of one side meet, with derivatives, and the loads of its turning."""

    wind: FloatArray  # (N, 3, 1 + d) m/s, at the quarter chord
    driving: FloatArray  # (N, 1 + d) m/s, normal velocity at three quarters of the chord
    speed: FloatArray  # (N, 1 + d) m/s, there, in the section's plane
    angle_of_attack: FloatArray  # (N,) rad, there
    apparent: FloatArray  # (N, 6, 1 + d) N and N m, of `apparent_wrenches`


@kernel
def side_flow(
    elements: Elements,
    velocity: FloatArray,
    motion: SectionMotion,
    air: ApparentInertia,
    twist: FloatArray,
    directions: IntArray,
    is_mirrored: bool,
) -> SideFlow:
    """Flow about a wing whose control points move at `velocity` (N, 3) m/s relative to the body.

    A mirrored one meets the mirrored `twist` (6,); derivatives are by the twist itself.
    """
    own = mirrored(twist) if is_mirrored else twist
    rear = Elements(
        _rear_points(elements),
        motion.rear_velocity,
        elements.chord_direction,
        elements.normal,
        elements.span_direction,
        elements.chord,
        elements.profile,
        elements.node,
        elements.width,
        elements.induced_y,
        elements.induced_z,
    )
    flow = wing_flow(rear, motion.rear_velocity, own, directions)
    at_quarter = wing_flow(elements, velocity, own, directions)
    apparent = apparent_wrenches(elements, motion, air, own, directions)
    n, columns = flow.bound.shape
    driving, speed = np.empty((n, columns)), np.empty((n, columns))
    for e in range(n):
        span, wind = elements.span_direction[e], flow.wind[e]
        per_velocity = 0.5 * elements.profile[e, 0] * elements.chord[e]
        across = span[0] * wind[0, 0] + span[1] * wind[1, 0] + span[2] * wind[2, 0]
        for m in range(columns):
            driving[e, m] = flow.bound[e, m] / per_velocity
            change = 0.0
            for i in range(3):
                change += (wind[i, 0] - across * span[i]) * wind[i, m]
            speed[e, m] = change / flow.speed[e]
        speed[e, 0] = flow.speed[e]
    if is_mirrored:
        for m in range(directions.size):
            sign = mirror_sign(directions[m])
            for each in (driving, speed):
                each[:, m + 1] *= sign
            at_quarter.wind[:, :, m + 1] *= sign
            apparent[:, :, m + 1] *= sign
    return SideFlow(at_quarter.wind, driving, speed, flow.angle_of_attack, apparent)


@kernel
def _rear_points(elements: Elements) -> FloatArray:
    points = elements.position.copy()
    for e in range(points.shape[0]):
        for i in range(3):
            points[e, i] += 0.5 * elements.chord[e] * elements.chord_direction[e, i]
    return points


@kernel
def side_wrenches(
    elements: Elements,
    flow: SideFlow,
    unsteady: Unsteady,
    induced_y: FloatArray,
    induced_z: FloatArray,
    first: int,
    density: float,
    profile_drag: float,
) -> FloatArray:
    """Forces and moments (N, 6, 1 + D) on a side's elements, whose rows begin with the `first`.

    `induced_y` and `induced_z` (M, 1 + D) m/s are the velocities that trailing vortices induce.
    """
    n, given = elements.chord.size, flow.driving.shape[1]
    columns = unsteady.circulation.shape[1]
    rows = slice(first, first + n)
    wind = np.zeros((n, 3, columns))
    wind[:, :, :given] = flow.wind
    gamma, shed = unsteady.circulation[rows], unsteady.shed[rows]
    loads = element_wrenches(
        elements, wind, gamma, induced_y[rows], induced_z[rows], density, profile_drag
    )
    loads[:, :, :given] += flow.apparent
    if unsteady.section.size > 0:
        loads += section_wrenches(elements, flow.speed, unsteady.section[rows], density)
    for e in range(n):
        scale = density * elements.width[e]
        for m in range(columns):
            drag = gamma[e, m] * shed[e, 0]
            if m > 0:
                drag += gamma[e, 0] * shed[e, m]
            for i in range(3):
                loads[e, i, m] += scale * drag * elements.chord_direction[e, i]
    return loads
