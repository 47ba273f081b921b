"""Compiled accelerations of the multibody bird at many instants.

Most of the work depends on the joints' angles alone, and differences of the rates by the states
leave these as they are more often than not: states of a time with the same angles share it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import BoolArray, FloatArray, IntArray
from birdmb.aerodynamics.airframe import Airframe, airframe_loads
from birdmb.aerodynamics.elements import Elements, clearance
from birdmb.aerodynamics.pair import circulations, pair_system, pair_wrench
from birdmb.aerodynamics.tail import tail_influence
from birdmb.aerodynamics.twist_loads import Flow, element_forces, mirrored, wing_flow
from birdmb.models.placed_wing import PlacedWing, place_wing, spin_of, torques_of
from birdmb.models.row_groups import groups_of
from birdmb.models.springs import Springs, spring_torques
from birdmb.models.tree_kernel import TreeLinks, bias_forces, mass_matrix, placed_links
from birdmb.wing.arrays import WingArrays
from birdmb.wing.stacked import StackedShapes, shape_at, velocity_at


class Constants(NamedTuple):
    """What does not change with time and state.

    Angles are counted over both wings, the right one first, C = S A of them: S is 1 where they move
    as mirror images and the right one tells of both, else 2.
    """

    wing: WingArrays
    links: TreeLinks
    frame: Airframe
    springs: Springs  # of the C angles
    prescribed: BoolArray  # (B + C,) which coordinates follow a given motion
    rigid_joint_count: int  # how many joints at the shoulder turn a wing as a whole
    is_mirrored: bool


class Motion(NamedTuple):
    """States at K instants."""

    twist: FloatArray  # (K, 6) m/s and rad/s of the body relative to the air
    gravity: FloatArray  # (K, 3) m/s2 along the body's axes
    angles: FloatArray  # (K, C) rad, of joints and hinges
    rates: FloatArray  # (K, C) rad/s


class Drivers(NamedTuple):
    """Drivers at P times, each (P, C); those of compliant joints move the springs' other ends."""

    angles: FloatArray  # rad
    rates: FloatArray  # rad/s
    accelerations: FloatArray  # rad/s2


class Shapes(NamedTuple):
    """Shapes of both wings, those with the joints at zero that turn them as a whole."""

    right: StackedShapes
    left: StackedShapes
    right_of: IntArray  # (K,) which of them is an instant's
    left_of: IntArray  # (K,)


@kernel
def free_accelerations(
    constants: Constants, shapes: Shapes, time_of: IntArray, drivers: Drivers, motion: Motion
) -> tuple[FloatArray, FloatArray]:
    """Accelerations (K, F) of the free coordinates of body and wings, by exact partition.

    `time_of` (K,) tells which of the drivers' times a row has. The body's accelerations are those
    in space, in body axes. The second result is the clearance (K, 2) m of right and left wing
    (`birdmb.aerodynamics.elements.clearance`); where one is negative there are no accelerations.
    """
    links, prescribed = constants.links, constants.prescribed
    count, size, body = time_of.size, prescribed.size, links.directions.size
    free = np.flatnonzero(~prescribed)
    found, distance = np.full((count, free.size), np.nan), np.empty((count, 2))
    groups = groups_of(time_of, motion.angles)
    for g in range(groups.first.size):
        rows = groups.members[groups.start[g] : groups.start[g + 1]]
        loads, clear = air_forces(constants, shapes, motion, rows)
        distance[rows] = clear
        if not (clear >= 0.0).all() or free.size == 0:
            continue
        angles, t = motion.angles[rows[0]], time_of[rows[0]]
        placed = placed_links(links, angles)
        mass = mass_matrix(links, placed)
        matrix, right = np.empty((free.size, free.size)), np.empty((free.size, rows.size))
        for a in range(free.size):
            for b in range(free.size):
                matrix[a, b] = mass[free[a], free[b]]
        for r in range(rows.size):
            k = rows[r]
            rates = motion.rates[k]
            left = bias_forces(links, placed, rates, motion.twist[k, 3:], motion.gravity[k])
            left -= loads[r]
            left[body:] -= links.copies * spring_torques(
                constants.springs, angles - drivers.angles[t], rates - drivers.rates[t]
            )
            for j in range(body, size):
                if prescribed[j]:
                    left += mass[j] * drivers.accelerations[t, j - body]
            for a in range(free.size):
                right[a, r] = -left[free[a]]
        solved = np.linalg.solve(matrix, right)
        for r in range(rows.size):
            found[rows[r]] = solved[:, r]
    return found, distance


@kernel
def air_forces(
    constants: Constants, shapes: Shapes, motion: Motion, rows: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Generalised forces (R, B + C) of the air at `rows` (R,) of the same angles.

    And the clearance (2,) m of right and left wing; where one is negative forces are NaN.
    """
    frame, is_mirrored = constants.frame, constants.is_mirrored
    directions, tail = constants.links.directions, constants.frame.tail
    body, angles = directions.size, motion.angles[rows[0]]
    loads = np.full((rows.size, body + angles.size), np.nan)
    joints = angles.size if is_mirrored else angles.size // 2
    right = _at_rest(constants, shapes.right, shapes.right_of[rows[0]], angles[:joints])
    left = right
    if not is_mirrored:
        left = _at_rest(constants, shapes.left, shapes.left_of[rows[0]], angles[joints:])
    distance = np.array([clearance(right.elements), clearance(left.elements)])
    if not (distance >= 0.0).all():
        return loads, distance
    n = right.elements.chord.size
    system = pair_system(right.elements, left.elements, is_mirrored)
    bound = np.empty((system.matrix.shape[0], rows.size))
    winds = np.empty((rows.size, system.matrix.shape[0], 3, 1))
    for r in range(rows.size):
        k = rows[r]
        flow = _flow(constants, right, shapes.right, shapes.right_of[k], motion.rates[k, :joints],
                     motion.twist[k])  # fmt: skip
        bound[:n, r], winds[r, :n] = flow.bound[:, 0], flow.wind
        if not is_mirrored:
            flow = _flow(constants, left, shapes.left, shapes.left_of[k], motion.rates[k, joints:],
                         mirrored(motion.twist[k]))  # fmt: skip
            bound[n:, r], winds[r, n:] = flow.bound[:, 0], flow.wind
    strengths = circulations(system, bound)
    induced_y, induced_z = system.induced_y @ strengths, system.induced_z @ strengths
    at_tail = tail_influence(tail, right.elements.node)
    at_tail_of_left = at_tail if is_mirrored else tail_influence(tail, left.elements.node)
    no_derivatives = np.empty(0, np.int64)
    for r in range(rows.size):
        gamma, y, z = strengths[:, r : r + 1], induced_y[:, r : r + 1], induced_z[:, r : r + 1]
        force = _forces(constants, right, winds[r, :n], gamma[:n], y[:n], z[:n])
        torques = torques_of(constants.wing, right, force)
        force_of_left = force
        if not is_mirrored:
            force_of_left = _forces(constants, left, winds[r, n:], gamma[n:], y[n:], z[n:])
            loads[r, body + joints :] = torques_of(constants.wing, left, force_of_left)
        loads[r, body : body + joints] = constants.links.copies * torques
        induced = np.zeros((2, 1))
        if tail.span > 0.0:
            # In the plane of symmetry each wing induces half of what a pair of them would.
            of_right, of_left = strengths[:n, r].copy(), strengths[-n:, r].copy()
            induced[:, 0] = 0.5 * (at_tail @ of_right + at_tail_of_left @ of_left)
        wrench = pair_wrench(right.elements, force, left.elements, force_of_left)
        wrench += airframe_loads(frame, induced, motion.twist[rows[r]], no_derivatives)[:, 0]
        for b in range(body):
            loads[r, b] = wrench[directions[b]]
    return loads, distance


@kernel
def _at_rest(constants: Constants, shapes: StackedShapes, s: int, angles: FloatArray) -> PlacedWing:
    """The s-th of the shapes, placed where `angles` (A,) turn it, without velocities."""
    shape = shape_at(shapes, s)
    return place_wing(
        constants.wing, shape, constants.rigid_joint_count, angles, np.zeros(angles.size)
    )


@kernel
def _flow(
    constants: Constants,
    placed: PlacedWing,
    shapes: StackedShapes,
    s: int,
    rates: FloatArray,
    twist: FloatArray,
) -> Flow:
    """What a placed wing of the s-th shape meets at these rates (A,) of its joints."""
    root, position = constants.wing.root, placed.elements.position
    spin = spin_of(placed.chain, constants.rigid_joint_count, rates)
    velocity = velocity_at(shapes, s, rates) @ placed.axes.T
    for e in range(position.shape[0]):
        x, y, z = position[e, 0] - root[0], position[e, 1] - root[1], position[e, 2] - root[2]
        velocity[e, 0] += spin[1] * z - spin[2] * y
        velocity[e, 1] += spin[2] * x - spin[0] * z
        velocity[e, 2] += spin[0] * y - spin[1] * x
    return wing_flow(_with_velocity(placed.elements, velocity), twist, np.empty(0, np.int64))


@kernel
def _forces(
    constants: Constants,
    placed: PlacedWing,
    wind: FloatArray,
    circulation: FloatArray,
    induced_y: FloatArray,
    induced_z: FloatArray,
) -> FloatArray:
    """Forces (N, 3) N on the elements of a wing in `wind` (N, 3, 1) m/s."""
    frame = constants.frame
    forces = element_forces(
        placed.elements, wind, circulation, induced_y, induced_z, frame.density, frame.profile
    )
    return forces[:, :, 0].copy()


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
