"""Compiled loads of the air on a bird at many instants, element by element."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.airframe import Airframe, body_loads, tail_wind
from birdmb.aerodynamics.circulation import ElementLoads, element_loads
from birdmb.aerodynamics.elements import Elements, clearance, place_elements
from birdmb.aerodynamics.joints import hinge_torques, joint_torques
from birdmb.aerodynamics.tail import tail_angle, tail_force, tail_influence
from birdmb.aerodynamics.twist_loads import loads_of_both
from birdmb.wing.arrays import WingArrays
from birdmb.wing.chain import frame_after, joint_chain
from birdmb.wing.shape import turned
from birdmb.wing.stacked import StackedShapes, shape_at


class StackedLoads(NamedTuple):
    """Loads at K instants, in body axes; element by element those of the right wing.

    Mirroring changes the sign of what points along y.
    """

    force: FloatArray  # (K, 3) N, resultant of wings, tail and body
    moment: FloatArray  # (K, 3) N m, about G
    tail_force: FloatArray  # (K, 3) N
    tail_angle: FloatArray  # (K,) rad, of attack; NaN where there is no tail
    tail_downwash: FloatArray  # (K,) m/s along z
    body_force: FloatArray  # (K, 3) N
    body_moment: FloatArray  # (K, 3) N m
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
    left_force: FloatArray  # (K, N, 3) N, on the left wing, mirrored onto the right one
    left_profile_drag: FloatArray  # (K, N, 3) N, likewise
    left_circulation: FloatArray  # (K, N) m2/s, likewise
    left_joint_torques: FloatArray  # (K, A) N m, likewise
    clearance: FloatArray  # (K,) m, of the wings from the plane of symmetry


@kernel
def loads_along(
    wing: WingArrays,
    shapes: StackedShapes,
    shape_of: IntArray,
    rigid_joint_count: int,
    frame: Airframe,
    angles: FloatArray,
    rates: FloatArray,
    twists: FloatArray,
) -> StackedLoads:
    """Loads at K instants; NaN where the wings are across the plane of symmetry.

    `shape_of` (K,) tells which of the stacked `shapes` belongs to an instant, with the first
    `rigid_joint_count` joints at zero; `angles` and `rates` (K, A) are those of joints and hinges,
    `twists` (K, 6) m/s and rad/s the body's relative to the air.
    """
    (count, joints), n = angles.shape, shapes.chord.shape[1]
    stack = StackedLoads(
        np.full((count, 3), np.nan),
        np.full((count, 3), np.nan),
        np.zeros((count, 3)),
        np.full(count, np.nan),
        np.zeros(count),
        np.zeros((count, 3)),
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
        np.full((count, n, 3), np.nan),
        np.full((count, n, 3), np.nan),
        np.full((count, n), np.nan),
        np.full((count, joints), np.nan),
        np.empty(count),
    )
    tail = frame.tail
    for k in range(count):
        chain = joint_chain(wing, angles[k])
        shape = shape_at(shapes, shape_of[k])
        if rigid_joint_count > 0:
            spin = np.zeros(3)
            for j in range(rigid_joint_count):
                spin += rates[k, j] * chain.axis[j]
            shape = turned(shape, frame_after(wing, angles[k], rigid_joint_count), spin)
        placed = place_elements(shape, wing.root)
        stack.position[k], stack.node[k] = placed.position, placed.node
        stack.velocity[k] = placed.velocity
        stack.chord[k], stack.width[k] = placed.chord, placed.width
        stack.clearance[k] = clearance(placed)
        if not stack.clearance[k] >= 0.0:
            continue
        right, left = _of_both_wings(placed, frame, twists[k])
        stack.element_force[k], stack.profile_drag[k] = right.force, right.profile_drag
        stack.left_force[k], stack.left_profile_drag[k] = left.force, left.profile_drag
        stack.circulation[k], stack.left_circulation[k] = right.circulation, left.circulation
        stack.angle_of_attack[k], stack.speed[k] = right.angle_of_attack, right.speed
        for force, torques in (
            (right.force, stack.joint_torques[k]),
            (left.force, stack.left_joint_torques[k]),
        ):
            about_joints = joint_torques(wing, chain, placed.position, force, shape.distal_fraction)
            torques[: about_joints.size] = about_joints
            torques[about_joints.size :] = hinge_torques(shape.hinge_velocity, force)
        of_body = body_loads(frame, twists[k, :3])[:, 0]
        stack.body_force[k] = of_body[:3]
        if tail.span > 0.0:
            even = 0.5 * (right.circulation + left.circulation)
            induced = tail_influence(tail, placed.node) @ even
            wind = tail_wind(tail, induced, twists[k])
            stack.tail_force[k] = tail_force(tail, frame.density, wind)[:, 0]
            stack.tail_angle[k] = tail_angle(tail, wind[0], wind[2])
            stack.tail_downwash[k] = induced[1]
        stack.body_moment[k] = of_body[3:]
        stack.force[k] = stack.tail_force[k] + stack.body_force[k]
        fx, fy, fz = stack.tail_force[k]
        stack.moment[k, 0] = stack.body_moment[k, 0] - tail.z * fy
        stack.moment[k, 1] = stack.body_moment[k, 1] + tail.z * fx - tail.x * fz
        stack.moment[k, 2] = stack.body_moment[k, 2] + tail.x * fy
        for side, of_wing in ((1.0, right.force), (-1.0, left.force)):
            for e in range(n):
                x, y, z = placed.position[e]
                fx, fy, fz = of_wing[e]
                stack.force[k, 0] += fx
                stack.force[k, 1] += side * fy
                stack.force[k, 2] += fz
                stack.moment[k, 0] += side * (y * fz - z * fy)
                stack.moment[k, 1] += z * fx - x * fz
                stack.moment[k, 2] += side * (x * fy - y * fx)
    return stack


@kernel
def _of_both_wings(
    placed: Elements, frame: Airframe, twist: FloatArray
) -> tuple[ElementLoads, ElementLoads]:
    """Loads of the right wing and, mirrored onto it, of the left one."""
    if twist[1] == 0.0 and twist[3] == 0.0 and twist[5] == 0.0:  # one wing tells of both
        u, w, q = twist[0], twist[2], twist[4]
        found = element_loads(placed, frame.density, frame.profile, u, w, q)
        return found, found
    return loads_of_both(placed, frame.density, frame.profile, twist)
