"""Compiled loads of the air on the multibody bird at many instants.

Most of the work depends on the joints' angles alone: rows of the same angles share it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import BoolArray, FloatArray, IntArray
from birdmb.aerodynamics.airframe import AeroConstants, airframe_loads
from birdmb.aerodynamics.elements import clearance
from birdmb.aerodynamics.joints import torques_along
from birdmb.aerodynamics.pair import PairSystem, circulations, pair_system, pair_wrench
from birdmb.aerodynamics.tail import tail_influence
from birdmb.aerodynamics.twist_loads import (
    element_wrenches,
    mirrored,
    wing_flow,
    wing_wrench,
)
from birdmb.aerodynamics.wake_lags import WakeLags
from birdmb.models.placed_wing import PlacedWing, place_wing, spin_of, swung
from birdmb.models.springs import Springs
from birdmb.models.tree_kernel import TreeLinks
from birdmb.models.unsteady_kernel import air_inertia, unsteady_rows
from birdmb.wing.arrays import JointArrays
from birdmb.wing.stacked import NearShapes, StackedShapes, shape_at, velocity_at


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
    lags: WakeLags


class Motion(NamedTuple):
    """States at K instants."""

    twist: FloatArray  # (K, 6) m/s and rad/s of the body relative to the air
    gravity: FloatArray  # (K, 3) m/s2 along the body's axes
    angles: FloatArray  # (K, C) rad, of joints and hinges
    rates: FloatArray  # (K, C) rad/s
    lags: FloatArray  # (K, L), where the air remembers


class Drivers(NamedTuple):
    """Drivers at P times, each (P, C); those of compliant joints move the springs' other ends."""

    angles: FloatArray  # rad
    rates: FloatArray  # rad/s
    accelerations: FloatArray  # rad/s2


class Shapes(NamedTuple):
    """Shapes of the S wings, those with the joints at zero that turn them as a whole."""

    stacks: tuple[NearShapes, NearShapes]  # twice the same where one wing tells of both
    of: IntArray  # (2, K) which of them is an instant's


class AirForces(NamedTuple):
    """What the air does at R rows of the same angles."""

    forces: FloatArray  # (R, B + C) generalised, without those of the inertia
    inertia: FloatArray  # (B + C, B + C), mass matrix of the air about the wings
    lag_rates: FloatArray  # (R, L)
    clearance: FloatArray  # (2,) m, of right and left wing


@kernel
def air_forces(
    constants: Constants,
    shapes: Shapes,
    motion: Motion,
    accelerations: FloatArray,
    rows: IntArray,
) -> AirForces:
    """What the air does at `rows` (R,) of the same angles; no forces where a wing is misplaced.

    `accelerations` (C,) are those of the drivers, of which those of prescribed joints count.
    """
    aero, is_mirrored = constants.aero, constants.is_mirrored
    directions, tail = constants.links.directions, constants.aero.tail
    body, angles = directions.size, motion.angles[rows[0]]
    found = AirForces(
        np.full((rows.size, body + angles.size), np.nan),
        np.zeros((body + angles.size, body + angles.size)),
        np.full((rows.size, motion.lags.shape[1]), np.nan),
        np.empty(2),
    )
    joints = angles.size if is_mirrored else angles.size // 2
    right = _at_rest(constants, shapes.stacks[0].now, shapes.of[0, rows[0]], angles[:joints])
    left = right
    if not is_mirrored:
        left = _at_rest(constants, shapes.stacks[1].now, shapes.of[1, rows[0]], angles[joints:])
    found.clearance[:] = clearance(right.elements)
    if not is_mirrored:
        found.clearance[1] = clearance(left.elements)
    if not (found.clearance >= 0.0).all():
        return found
    n = right.elements.chord.size
    system = pair_system(right.elements, left.elements, is_mirrored)
    if constants.lags.kept.size > 0:
        wrenches, trailing, found.lag_rates[:] = _remembered(
            constants, shapes, motion, accelerations, rows, (right, left), system
        )
        found.inertia[:] = air_inertia((right, left), directions, is_mirrored, aero.density)
    else:
        wrenches, trailing = _quasi_steady(constants, shapes, motion, rows, (right, left), system)
    at_tail = tail_influence(tail, right.elements.node)
    at_tail_of_left = at_tail if is_mirrored else tail_influence(tail, left.elements.node)
    no_derivatives = np.empty(0, np.int64)
    for r in range(rows.size):
        of_right_wing = wing_wrench(right.elements.position, wrenches[r, :n])
        of_left_wing = of_right_wing
        if not is_mirrored:
            of_left_wing = wing_wrench(left.elements.position, wrenches[r, n:])
        induced = np.zeros((2, 1))
        if tail.span > 0.0:
            # In the plane of symmetry each wing induces half of what a pair of them would.
            induced = 0.5 * (at_tail @ trailing[r, :n] + at_tail_of_left @ trailing[r, -n:])
        wrench = pair_wrench(of_right_wing, of_left_wing)
        wrench += airframe_loads(aero, induced, motion.twist[rows[r]], no_derivatives)
        for b in range(body):
            found.forces[r, b] = wrench[directions[b], 0]
    about_joints = torques_along(right.twist_per_rate, wrenches[:, :n])
    found.forces[:, body : body + joints] = constants.links.copies * about_joints
    if not is_mirrored:
        found.forces[:, body + joints :] = torques_along(left.twist_per_rate, wrenches[:, n:])
    return found


@kernel
def _quasi_steady(
    constants: Constants,
    shapes: Shapes,
    motion: Motion,
    rows: IntArray,
    placed: tuple[PlacedWing, PlacedWing],
    system: PairSystem,
) -> tuple[FloatArray, FloatArray]:
    """Wrenches (R, M, 6, 1) and circulations (R, M, 1) of air without a memory."""
    aero, is_mirrored = constants.aero, constants.is_mirrored
    right, left = placed
    n, unknowns = right.elements.chord.size, system.matrix.shape[0]
    bound, winds = np.empty((unknowns, rows.size)), np.empty((rows.size, unknowns, 3, 1))
    rates, twists = motion.rates[rows], motion.twist[rows]
    joints = rates.shape[1] if is_mirrored else rates.shape[1] // 2
    of_right, of_left = shapes.of[0, rows[0]], shapes.of[1, rows[0]]
    _meet(
        constants,
        right,
        shapes.stacks[0].now,
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
            shapes.stacks[1].now,
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
    wrenches = np.empty((rows.size, unknowns, 6, 1))
    for r in range(rows.size):
        wrenches[r, :n] = _wrenches(aero, right, winds[r, :n], gamma[r, :n], y[r, :n], z[r, :n])
        if not is_mirrored:
            wrenches[r, n:] = _wrenches(aero, left, winds[r, n:], gamma[r, n:], y[r, n:], z[r, n:])
    return wrenches, gamma


@kernel
def _remembered(
    constants: Constants,
    shapes: Shapes,
    motion: Motion,
    accelerations: FloatArray,
    rows: IntArray,
    placed: tuple[PlacedWing, PlacedWing],
    system: PairSystem,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Wrenches (R, M, 6, 1), trailing circulations (R, M, 1), rates of the lags (R, L)."""
    count, both = rows.size, accelerations.size
    sides = 1 if constants.is_mirrored else 2
    body = constants.links.directions.size
    driven = np.zeros((count, 2, both // sides))
    rates = np.zeros((count, 2, both // sides))
    for r in range(count):
        for j in range(both):
            side, joint = j // (both // sides), j % (both // sides)
            rates[r, side, joint] = motion.rates[rows[r], j]
            if constants.prescribed[body + j]:
                driven[r, side, joint] = accelerations[j]
    loads = unsteady_rows(
        constants.joints,
        constants.rigid_joint_count,
        constants.aero,
        constants.lags,
        placed,
        system,
        shapes.stacks,
        shapes.of[:, rows],
        motion.twist[rows],
        rates,
        driven,
        motion.lags[rows],
    )
    unknowns = loads.trailing.shape[1]
    return (
        loads.wrenches.reshape(count, unknowns, 6, 1),
        loads.trailing.reshape(count, unknowns, 1),
        loads.lag_rates,
    )


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
    root, no_derivatives = constants.joints.root, np.empty(0, np.int64)
    for r in range(len(rates)):
        spin = spin_of(placed.chain, constants.rigid_joint_count, rates[r])
        velocity = swung(velocity_at(shapes, s, rates[r]), placed, root, spin)
        flow = wing_flow(placed.elements, velocity, twists[r], no_derivatives)
        for e in range(len(bound)):
            bound[e, r] = flow.bound[e, 0]
            for i in range(3):
                winds[r, e, i, 0] = flow.wind[e, i, 0]


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
