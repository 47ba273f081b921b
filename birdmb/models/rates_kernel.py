"""Compiled accelerations of the multibody bird at many instants.

Most of the work depends on the joints' angles alone, and differences of the rates by the states
leave these as they are more often than not: states of a time with the same angles share it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import BoolArray, FloatArray, IntArray
from birdmb.aerodynamics.airframe import Airframe, planar_airframe_loads
from birdmb.aerodynamics.circulation import (
    lifting_forces,
    profile_drag,
    resultant,
    section_flow,
)
from birdmb.aerodynamics.elements import Elements, circulation_system, clearance, place_elements
from birdmb.aerodynamics.joints import hinge_torques, joint_torques
from birdmb.aerodynamics.tail import tail_influence
from birdmb.models.row_groups import groups_of
from birdmb.models.springs import Springs, spring_torques
from birdmb.models.tree_kernel import BODY, TreeLinks, bias_forces, mass_matrix, placed_links
from birdmb.wing.arrays import WingArrays
from birdmb.wing.chain import Chain, frame_after, joint_chain
from birdmb.wing.shape import turned
from birdmb.wing.stacked import StackedShapes, shape_at, velocity_at


class Constants(NamedTuple):
    """What does not change with time and state."""

    wing: WingArrays
    links: TreeLinks
    frame: Airframe
    springs: Springs
    prescribed: BoolArray  # (3 + A,) which coordinates follow a given motion
    rigid_joint_count: int  # how many joints at the shoulder turn the wing as a whole


class Motion(NamedTuple):
    """States at K instants."""

    body: FloatArray  # (K, 4) u, w (m/s), q (rad/s), theta (rad)
    angles: FloatArray  # (K, A) rad, of joints and hinges
    rates: FloatArray  # (K, A) rad/s
    air: FloatArray  # (K, 2) m/s of the air in the world, forward and down


class Drivers(NamedTuple):
    """Drivers at P times, each (P, A); those of compliant joints move the springs' other ends."""

    angles: FloatArray  # rad
    rates: FloatArray  # rad/s
    accelerations: FloatArray  # rad/s2


@kernel
def free_accelerations(
    constants: Constants,
    shapes: StackedShapes,
    shape_of: IntArray,
    time_of: IntArray,
    drivers: Drivers,
    motion: Motion,
) -> tuple[FloatArray, FloatArray]:
    """Accelerations (K, F) of the free coordinates of body and right wing, by exact partition.

    `time_of` (K,) tells which of the drivers' times a row has, `shape_of` (K,) which of the stacked
    shapes, those with the joints at zero that turn the wing as a whole. The body's accelerations
    are those in space, in body axes. The second result is the clearance (K,) m of the wings
    (`birdmb.aerodynamics.elements.clearance`); where it is not positive there are no accelerations.
    """
    links, prescribed = constants.links, constants.prescribed
    count, size = time_of.size, prescribed.size
    free = np.flatnonzero(~prescribed)
    found, distance = np.full((count, free.size), np.nan), np.empty(count)
    groups = groups_of(time_of, motion.angles)
    for g in range(groups.first.size):
        rows = groups.members[groups.start[g] : groups.start[g + 1]]
        loads, clear = _air_loads(constants, shapes, shape_of[rows[0]], motion, rows)
        distance[rows] = clear
        if not clear >= 0.0 or free.size == 0:
            continue
        angles, t = motion.angles[rows[0]], time_of[rows[0]]
        placed = placed_links(links, angles)
        mass = mass_matrix(links, placed)
        matrix, right = np.empty((free.size, free.size)), np.empty((free.size, rows.size))
        for a in range(free.size):
            for b in range(free.size):
                matrix[a, b] = mass[free[a], free[b]]
        for r in range(rows.size):
            rates, body = motion.rates[rows[r]], motion.body[rows[r]]
            left = bias_forces(links, placed, rates, body[2], body[3]) - loads[r]
            # Each joint stands for a pair, and has the springs of both.
            left[BODY:] -= 2.0 * spring_torques(
                constants.springs, angles - drivers.angles[t], rates - drivers.rates[t]
            )
            for j in range(BODY, size):
                if prescribed[j]:
                    left += mass[j] * drivers.accelerations[t, j - BODY]
            for a in range(free.size):
                right[a, r] = -left[free[a]]
        solved = np.linalg.solve(matrix, right)
        for r in range(rows.size):
            found[rows[r]] = solved[:, r]
    return found, distance


@kernel
def _air_loads(
    constants: Constants, shapes: StackedShapes, s: int, motion: Motion, rows: IntArray
) -> tuple[FloatArray, float]:
    """Generalised forces (R, 3 + A) of the air at `rows` (R,) of the same angles; the clearance.

    The s-th of the shapes is theirs.
    """
    wing, frame, rigid_joint_count = constants.wing, constants.frame, constants.rigid_joint_count
    angles = motion.angles[rows[0]]
    loads = np.full((rows.size, BODY + angles.size), np.nan)
    chain, axes = joint_chain(wing, angles), frame_after(wing, angles, rigid_joint_count)
    shape = turned(shape_at(shapes, s), axes, np.zeros(3))
    placed = place_elements(shape, wing.root)
    distance = clearance(placed)
    if not distance >= 0.0:
        return loads, distance
    n = placed.chord.size
    through, winds, bound = _winds(constants, shapes, s, motion, rows, placed, chain, axes)
    circulation = np.full((n, rows.size), np.nan)
    system = circulation_system(placed)
    # The solver refuses what is not finite; a flow that diverges is told by whoever follows it.
    if np.isfinite(np.sum(system)) and np.isfinite(np.sum(bound)):
        circulation = np.linalg.solve(system, bound)
    at_tail = tail_influence(frame.tail, placed.node)
    for r in range(rows.size):
        strengths = circulation[:, r].copy()
        force = lifting_forces(placed, frame.density, winds[r], strengths)
        force += profile_drag(placed, frame.density, frame.profile, winds[r])
        induced = np.zeros(2)
        if frame.tail.span > 0.0:
            induced = at_tail @ strengths
        u, w, q = through[r]
        loads[r, :BODY] = resultant(placed, force) + planar_airframe_loads(frame, induced, u, w, q)
        about_joints = joint_torques(wing, chain, placed.position, force, shape.distal_fraction)
        about_hinges = hinge_torques(shape.hinge_velocity, force)
        loads[r, BODY : BODY + about_joints.size] = 2.0 * about_joints
        loads[r, BODY + about_joints.size :] = 2.0 * about_hinges
    return loads, distance


@kernel
def _winds(
    constants: Constants,
    shapes: StackedShapes,
    s: int,
    motion: Motion,
    rows: IntArray,
    placed: Elements,
    chain: Chain,
    axes: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The body's velocity through the air and what it makes of it.

    u, w (m/s) and q (rad/s) through the air, (R, 3), the winds (R, N, 3) m/s, and the right-hand
    sides (N, R) of the circulation's system.
    """
    n, root = placed.chord.size, constants.wing.root
    through, winds = np.empty((rows.size, 3)), np.empty((rows.size, n, 3))
    bound = np.empty((n, rows.size))
    for r in range(rows.size):
        rates = motion.rates[rows[r]]
        u, w, q, theta = motion.body[rows[r]]
        forward, down = motion.air[rows[r]]
        c, si = np.cos(theta), np.sin(theta)
        through[r, 0] = u - forward * c + down * si
        through[r, 1] = w - forward * si - down * c
        through[r, 2] = q
        spin = np.zeros(3)
        for j in range(constants.rigid_joint_count):
            spin += rates[j] * chain.axis[j]
        velocity = velocity_at(shapes, s, rates) @ axes.T
        for e in range(n):
            x = placed.position[e, 0] - root[0]
            y = placed.position[e, 1] - root[1]
            z = placed.position[e, 2] - root[2]
            velocity[e, 0] += spin[1] * z - spin[2] * y
            velocity[e, 1] += spin[2] * x - spin[0] * z
            velocity[e, 2] += spin[0] * y - spin[1] * x
        moving = _with_velocity(placed, velocity)
        winds[r], speed, alpha = section_flow(moving, through[r, 0], through[r, 1], q)
        bound[:, r] = np.pi * placed.chord * speed * alpha
    return through, winds, bound


@kernel
def _with_velocity(elements: Elements, velocity: FloatArray) -> Elements:
    return Elements(
        elements.position,
        velocity,
        elements.chord_direction,
        elements.normal,
        elements.span_direction,
        elements.chord,
        elements.node,
        elements.width,
        elements.induced_y,
        elements.induced_z,
    )
