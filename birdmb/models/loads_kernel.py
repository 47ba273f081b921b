"""Compiled loads of the air on a bird at many instants, element by element."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.airframe import Airframe, tail_wind
from birdmb.aerodynamics.body_drag import body_drag_force
from birdmb.aerodynamics.circulation import element_loads
from birdmb.aerodynamics.elements import clearance, place_elements
from birdmb.aerodynamics.joints import hinge_torques, joint_torques
from birdmb.aerodynamics.tail import tail_angle, tail_force, tail_influence
from birdmb.wing.arrays import WingArrays
from birdmb.wing.chain import frame_after, joint_chain
from birdmb.wing.shape import turned
from birdmb.wing.stacked import StackedShapes, shape_at


class StackedLoads(NamedTuple):
    """Loads at K instants, in body axes; element by element those of the right wing."""

    force: FloatArray  # (K, 3) N, resultant of wings, tail and body
    moment: FloatArray  # (K, 3) N m, about G
    tail_force: FloatArray  # (K, 3) N
    tail_angle: FloatArray  # (K,) rad, of attack; NaN where there is no tail
    tail_downwash: FloatArray  # (K,) m/s along z
    body_drag: FloatArray  # (K, 3) N
    joint_torques: FloatArray  # (K, A) N m, about joints and hinges
    position: FloatArray  # (K, N, 3) m
    node: FloatArray  # (K, N + 1, 3) m
    velocity: FloatArray  # (K, N, 3) m/s, relative to the body
    chord: FloatArray  # (K, N) m
    width: FloatArray  # (K, N) m
    element_force: FloatArray  # (K, N, 3) N, profile drag included
    profile_drag: FloatArray  # (K, N, 3) N
    circulation: FloatArray  # (K, N) m2/s
    angle_of_attack: FloatArray  # (K, N) rad, geometric
    speed: FloatArray  # (K, N) m/s, in the section's plane
    clearance: FloatArray  # (K,) m, of the wings from the plane of symmetry


@kernel
def loads_along(
    wing: WingArrays,
    shapes: StackedShapes,
    shape_of: IntArray,
    turning: int,
    frame: Airframe,
    angles: FloatArray,
    rates: FloatArray,
    motion: FloatArray,
) -> StackedLoads:
    """Loads at K instants; NaN where the wings are across the plane of symmetry.

    `shape_of` (K,) tells which of the stacked `shapes` belongs to an instant, with the first
    `turning` joints at zero; `angles` and `rates` (K, A) are those of joints and hinges, `motion`
    (K, 3) the body's velocity u, w (m/s) through the air and its pitch rate q (rad/s).
    """
    (count, joints), n = angles.shape, shapes.chord.shape[1]
    stack = StackedLoads(
        np.full((count, 3), np.nan),
        np.full((count, 3), np.nan),
        np.zeros((count, 3)),
        np.full(count, np.nan),
        np.zeros(count),
        np.zeros((count, 3)),
        np.full((count, joints), np.nan),
        np.empty((count, n, 3)),
        np.empty((count, n + 1, 3)),
        np.empty((count, n, 3)),
        np.empty((count, n)),
        np.empty((count, n)),
        np.full((count, n, 3), np.nan),
        np.full((count, n, 3), np.nan),
        np.full((count, n), np.nan),
        np.full((count, n), np.nan),
        np.full((count, n), np.nan),
        np.empty(count),
    )
    tail = frame.tail
    for k in range(count):
        chain = joint_chain(wing, angles[k])
        shape = shape_at(shapes, shape_of[k])
        if turning > 0:
            spin = np.zeros(3)
            for j in range(turning):
                spin += rates[k, j] * chain.axis[j]
            shape = turned(shape, frame_after(wing, angles[k], turning), spin)
        placed = place_elements(shape, wing.root)
        stack.position[k], stack.node[k] = placed.position, placed.node
        stack.velocity[k] = placed.velocity
        stack.chord[k], stack.width[k] = placed.chord, placed.width
        stack.clearance[k] = clearance(placed)
        if not stack.clearance[k] >= 0.0:
            continue
        u, w, q = motion[k]
        found = element_loads(placed, frame.density, frame.profile, u, w, q)
        stack.element_force[k], stack.profile_drag[k] = found.force, found.profile_drag
        stack.circulation[k] = found.circulation
        stack.angle_of_attack[k], stack.speed[k] = found.angle_of_attack, found.speed
        about_joints = joint_torques(wing, chain, placed.position, found.force, shape.beyond)
        stack.joint_torques[k, : about_joints.size] = about_joints
        stack.joint_torques[k, about_joints.size :] = hinge_torques(
            shape.hinge_velocity, found.force
        )
        drag = body_drag_force(frame.body, u, w)[:, 0]
        stack.body_drag[k, 0], stack.body_drag[k, 2] = drag
        if tail.span > 0.0:
            induced = tail_influence(tail, placed.node) @ found.circulation
            wind_x, wind_z = tail_wind(tail, induced, u, w, q)
            of_tail = tail_force(tail, frame.density, wind_x, wind_z)[:, 0]
            stack.tail_force[k, 0], stack.tail_force[k, 2] = of_tail
            stack.tail_angle[k] = tail_angle(tail, wind_x, wind_z)
            stack.tail_downwash[k] = induced[1]
        force, pitch = np.zeros(3), 0.0
        for e in range(n):
            x, z = placed.position[e, 0], placed.position[e, 2]
            fx, fz = found.force[e, 0], found.force[e, 2]
            force[0] += 2.0 * fx
            force[2] += 2.0 * fz
            pitch += 2.0 * (z * fx - x * fz)
        pitch += tail.z * stack.tail_force[k, 0] - tail.x * stack.tail_force[k, 2]
        stack.force[k] = force + stack.tail_force[k] + stack.body_drag[k]
        stack.moment[k] = 0.0
        stack.moment[k, 1] = pitch
    return stack
