"""Compiled accelerations of the multibody bird at many instants.

Most of the work depends on the joints' angles alone, and differences of the rates by the states
leave these as they are more often than not: states of a time with the same angles share it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import BoolArray, FloatArray, IntArray
from birdmb.aerodynamics.airframe import AeroConstants, airframe_loads
from birdmb.aerodynamics.elements import clearance
from birdmb.aerodynamics.joints import torques_along
from birdmb.aerodynamics.pair import circulations, pair_system, pair_wrench
from birdmb.aerodynamics.tail import tail_influence
from birdmb.aerodynamics.twist_loads import (
    element_wrenches,
    mirrored,
    wing_flow,
    wing_wrench,
)
from birdmb.models.placed_wing import PlacedWing, place_wing, spin_of
from birdmb.models.row_groups import groups_of
from birdmb.models.springs import Springs, spring_torques
from birdmb.models.tree_kernel import TreeLinks, bias_forces, mass_matrix, placed_links
from birdmb.wing.arrays import JointArrays
from birdmb.wing.stacked import StackedShapes, shape_at, velocity_at


class Constants(NamedTuple):
    """What does not change with time and state.

    Angles are counted over both wings, the right one first, C = S A of them: S is 1 where they move
    as mirror images and the right one tells of both, else 2.
    """

    joints: JointArrays
    links: TreeLinks
    aero: AeroConstants
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
    """Shapes of the S wings, those with the joints at zero that turn them as a whole."""

    stacks: tuple[StackedShapes, ...]
    of: IntArray  # (S, K) which of them is an instant's


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
    aero, is_mirrored = constants.aero, constants.is_mirrored
    directions, tail = constants.links.directions, constants.aero.tail
    body, angles = directions.size, motion.angles[rows[0]]
    loads = np.full((rows.size, body + angles.size), np.nan)
    joints = angles.size if is_mirrored else angles.size // 2
    right = _at_rest(constants, shapes.stacks[0], shapes.of[0, rows[0]], angles[:joints])
    left = right
    if not is_mirrored:
        left = _at_rest(constants, shapes.stacks[-1], shapes.of[-1, rows[0]], angles[joints:])
    distance = np.full(2, clearance(right.elements))
    if not is_mirrored:
        distance[1] = clearance(left.elements)
    if not (distance >= 0.0).all():
        return loads, distance
    n = right.elements.chord.size
    system = pair_system(right.elements, left.elements, is_mirrored)
    unknowns = system.matrix.shape[0]
    bound, winds = np.empty((unknowns, rows.size)), np.empty((rows.size, unknowns, 3, 1))
    rates, twists = motion.rates[rows], motion.twist[rows]
    of_right, of_left = shapes.of[0, rows[0]], shapes.of[-1, rows[0]]
    _meet(
        constants,
        right,
        shapes.stacks[0],
        of_right,
        rates[:, :joints],
        twists,
        bound[:n],
        winds[:, :n],
    )
    if not is_mirrored:
        for r in range(rows.size):
            twists[r] = mirrored(twists[r])
        _meet(
            constants,
            left,
            shapes.stacks[-1],
            of_left,
            rates[:, joints:],
            twists,
            bound[n:],
            winds[:, n:],
        )
    strengths = circulations(system, bound)
    # One row after another: what belongs to one is then in one place.
    gamma = np.ascontiguousarray(strengths.T).reshape(rows.size, unknowns, 1)
    y = np.ascontiguousarray((system.induced_y @ strengths).T).reshape(rows.size, unknowns, 1)
    z = np.ascontiguousarray((system.induced_z @ strengths).T).reshape(rows.size, unknowns, 1)
    at_tail = tail_influence(tail, right.elements.node)
    at_tail_of_left = at_tail if is_mirrored else tail_influence(tail, left.elements.node)
    no_derivatives = np.empty(0, np.int64)
    wrenches = np.empty((rows.size, unknowns, 6, 1))
    for r in range(rows.size):
        wrenches[r, :n] = _wrenches(aero, right, winds[r, :n], gamma[r, :n], y[r, :n], z[r, :n])
        of_right_wing = wing_wrench(right.elements.position, wrenches[r, :n])
        of_left_wing = of_right_wing
        if not is_mirrored:
            wrenches[r, n:] = _wrenches(aero, left, winds[r, n:], gamma[r, n:], y[r, n:], z[r, n:])
            of_left_wing = wing_wrench(left.elements.position, wrenches[r, n:])
        induced = np.zeros((2, 1))
        if tail.span > 0.0:
            # In the plane of symmetry each wing induces half of what a pair of them would.
            induced = 0.5 * (at_tail @ gamma[r, :n] + at_tail_of_left @ gamma[r, -n:])
        wrench = pair_wrench(of_right_wing, of_left_wing)
        wrench += airframe_loads(aero, induced, motion.twist[rows[r]], no_derivatives)
        for b in range(body):
            loads[r, b] = wrench[directions[b], 0]
    about_joints = torques_along(right.twist_per_rate, wrenches[:, :n])
    loads[:, body : body + joints] = constants.links.copies * about_joints
    if not is_mirrored:
        loads[:, body + joints :] = torques_along(left.twist_per_rate, wrenches[:, n:])
    return loads, distance


@kernel
def _at_rest(constants: Constants, shapes: StackedShapes, s: int, angles: FloatArray) -> PlacedWing:
    """The s-th of the shapes, placed where `angles` (A,) turn it, without velocities."""
    shape = shape_at(shapes, s)
    return place_wing(
        constants.joints, shape, constants.rigid_joint_count, angles, np.zeros(angles.size)
    )


@kernel
def _meet(
    constants: Constants,
    placed: PlacedWing,
    shapes: StackedShapes,
    s: int,
    rates: FloatArray,
    twists: FloatArray,
    bound: FloatArray,
    winds: FloatArray,
) -> None:
    """Write what a placed wing of the s-th shape meets at rates (R, A) of its joints.

    The circulations (N, R) m2/s without downwash and the winds (R, N, 3, 1) m/s of a body that
    moves with these `twists` (R, 6).
    """
    root, position = constants.joints.root, placed.elements.position
    no_derivatives, turn = np.empty(0, np.int64), np.ascontiguousarray(placed.axes.T)
    for r in range(len(rates)):
        spin = spin_of(placed.chain, constants.rigid_joint_count, rates[r])
        velocity = velocity_at(shapes, s, rates[r]) @ turn
        for e in range(position.shape[0]):
            x, y, z = position[e, 0] - root[0], position[e, 1] - root[1], position[e, 2] - root[2]
            velocity[e, 0] += spin[1] * z - spin[2] * y
            velocity[e, 1] += spin[2] * x - spin[0] * z
            velocity[e, 2] += spin[0] * y - spin[1] * x
        flow = wing_flow(placed.elements, velocity, twists[r], no_derivatives)
        bound[:, r], winds[r] = flow.bound[:, 0], flow.wind


@kernel
def _wrenches(
    aero: AeroConstants,
    placed: PlacedWing,
    wind: FloatArray,
    circulation: FloatArray,
    induced_y: FloatArray,
    induced_z: FloatArray,
) -> FloatArray:
    """Forces and moments (N, 6, 1) N and N m on the elements of a wing in `wind` (N, 3, 1) m/s."""
    return element_wrenches(
        placed.elements, wind, circulation, induced_y, induced_z, aero.density, aero.profile_drag
    )
