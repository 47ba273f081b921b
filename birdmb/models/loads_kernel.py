"""Compiled loads of the air on a bird at many instants, element by element."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.aerodynamics.airframe import AeroConstants, body_loads, tail_wind
from birdmb.aerodynamics.apparent_mass import apparent_inertia, body_twists, inertia_wrenches
from birdmb.aerodynamics.elements import clearance
from birdmb.aerodynamics.joints import torques
from birdmb.aerodynamics.pair import ElementLoads, pair_loads, pair_system, pair_wrench
from birdmb.aerodynamics.separation import section_wrenches
from birdmb.aerodynamics.tail import tail_angle, tail_force, tail_influence
from birdmb.aerodynamics.twist_loads import mirrored, profile_drag, wing_wrench
from birdmb.aerodynamics.wake_lags import WakeLags
from birdmb.models.air_kernel import Shapes
from birdmb.models.placed_wing import PlacedWing, place_wing
from birdmb.models.unsteady_kernel import unsteady_rows
from birdmb.wing.arrays import JointArrays
from birdmb.wing.stacked import shape_at


class StackedWing(NamedTuple):
    """One wing and its loads at K instants, in body axes; the left one mirrored.

    Mirroring onto the right side changes the sign of what points along y.
    """

    position: FloatArray  # (K, N, 3) m
    node: FloatArray  # (K, N + 1, 3) m
    velocity: FloatArray  # (K, N, 3) m/s, relative to the body
    chord: FloatArray  # (K, N) m
    width: FloatArray  # (K, N) m
    force: FloatArray  # (K, N, 3) N, profile drag included
    moment: FloatArray  # (K, N, 3) N m, of the profile about the control points
    spin: FloatArray  # (K, N, 3) rad/s of what carries the loads, relative to the body
    profile_drag: FloatArray  # (K, N, 3) N
    circulation: FloatArray  # (K, N) m2/s
    angle_of_attack: FloatArray  # (K, N) rad, geometric
    speed: FloatArray  # (K, N) m/s, in the section's plane
    joint_torques: FloatArray  # (K, A) N m, about joints and hinges
    clearance: FloatArray  # (K,) m, from the plane of symmetry


class StackedLoads(NamedTuple):
    """Loads at K instants, in body axes."""

    force: FloatArray  # (K, 3) N, resultant of wings, tail and body
    moment: FloatArray  # (K, 3) N m, about G
    tail_force: FloatArray  # (K, 3) N
    tail_angle: FloatArray  # (K,) rad, of attack; NaN where there is no tail
    tail_downwash: FloatArray  # (K,) m/s along z
    body_force: FloatArray  # (K, 3) N
    body_moment: FloatArray  # (K, 3) N m
    right: StackedWing
    left: StackedWing


class Memory(NamedTuple):
    """What air that remembers adds at K instants; nothing where no lags are kept."""

    lags: WakeLags
    sides: int  # 1 where the lags of the right wing tell of both, else 2
    states: FloatArray  # (K, L)
    of_body: FloatArray  # (K, 6) m/s2 and rad/s2, acceleration in space in body axes
    free: FloatArray  # (K, 2, A) rad/s2, of joints and hinges that follow no driver
    driven: FloatArray  # (K, 2, A) rad/s2, of those that do


@kernel
def _no_wing(count: int, n: int, joints: int) -> StackedWing:
    return StackedWing(
        np.empty((count, n, 3)),
        np.empty((count, n + 1, 3)),
        np.empty((count, n, 3)),
        np.empty((count, n)),
        np.empty((count, n)),
        np.full((count, n, 3), np.nan),
        np.full((count, n, 3), np.nan),
        np.empty((count, n, 3)),
        np.full((count, n, 3), np.nan),
        np.full((count, n), np.nan),
        np.full((count, n), np.nan),
        np.full((count, n), np.nan),
        np.full((count, joints), np.nan),
        np.empty(count),
    )


@kernel
def loads_along(
    joints: JointArrays,
    shapes: Shapes,
    rigid_joint_count: int,
    aero: AeroConstants,
    angles: FloatArray,
    rates: FloatArray,
    twists: FloatArray,
    memory: Memory,
) -> StackedLoads:
    """Loads at K instants; NaN where a wing is across the plane of symmetry.

    The first `rigid_joint_count` joints of the `shapes` are at zero; `angles` and `rates` (K, 2, A)
    are those of joints and hinges, `twists` (K, 6) m/s and rad/s the body's relative to the air.
    """
    count, _, angle_count = angles.shape
    n = shapes.stacks[0].now.chord.shape[1]
    stack = StackedLoads(
        np.full((count, 3), np.nan),
        np.full((count, 3), np.nan),
        np.zeros((count, 3)),
        np.full(count, np.nan),
        np.zeros(count),
        np.zeros((count, 3)),
        np.zeros((count, 3)),
        _no_wing(count, n, angle_count),
        _no_wing(count, n, angle_count),
    )
    tail = aero.tail
    for k in range(count):
        twist = twists[k]
        right = place_wing(
            joints,
            shape_at(shapes.stacks[0].now, shapes.of[0, k]),
            rigid_joint_count,
            angles[k, 0],
            rates[k, 0],
        )
        left = right
        alike = np.all(angles[k, 0] == angles[k, 1]) and np.all(rates[k, 0] == rates[k, 1])
        if not alike:
            shape = shape_at(shapes.stacks[1].now, shapes.of[1, k])
            left = place_wing(joints, shape, rigid_joint_count, angles[k, 1], rates[k, 1])
        _keep_wing(stack.right, k, right, rates[k, 0])
        _keep_wing(stack.left, k, left, rates[k, 1])
        if not (stack.right.clearance[k] >= 0.0 and stack.left.clearance[k] >= 0.0):
            continue
        is_mirrored = bool(alike and twist[1] == 0.0 and twist[3] == 0.0 and twist[5] == 0.0)
        if memory.lags.kept.size > 0:
            of_right, of_left, trailing = _remembered(
                joints, rigid_joint_count, aero, (right, left), shapes, k, twist, rates[k], memory
            )
        else:
            of_right, of_left = pair_loads(
                right.elements, left.elements, is_mirrored, aero.density, aero.profile_drag, twist
            )
            trailing = np.concatenate((of_right.circulation, of_left.circulation))
        _keep_loads(stack.right, k, of_right, torques(right.twist_per_rate, of_right.wrench))
        _keep_loads(stack.left, k, of_left, torques(left.twist_per_rate, of_left.wrench))
        of_body = body_loads(aero, twist[:3])[:, 0]
        stack.body_force[k], stack.body_moment[k] = of_body[:3], of_body[3:]
        if tail.span > 0.0:
            # In the plane of symmetry each wing induces half of what a pair of them would.
            induced = 0.5 * (
                tail_influence(tail, right.elements.node) @ trailing[:n]
                + tail_influence(tail, left.elements.node) @ trailing[n:]
            )
            wind = tail_wind(tail, induced, twist)
            stack.tail_force[k] = tail_force(tail, aero.density, wind)[:, 0]
            stack.tail_angle[k] = tail_angle(tail, wind[0], wind[2])
            stack.tail_downwash[k] = induced[1]
        wrench = pair_wrench(
            wing_wrench(right.elements.position, of_right.wrench.reshape(n, 6, 1)),
            wing_wrench(left.elements.position, of_left.wrench.reshape(n, 6, 1)),
        )[:, 0]
        fx, fy, fz = stack.tail_force[k]
        stack.force[k] = wrench[:3] + stack.tail_force[k] + stack.body_force[k]
        stack.moment[k] = wrench[3:] + stack.body_moment[k]
        stack.moment[k, 0] -= tail.z * fy
        stack.moment[k, 1] += tail.z * fx - tail.x * fz
        stack.moment[k, 2] += tail.x * fy
    return stack


@kernel
def _remembered(
    joints: JointArrays,
    rigid_joint_count: int,
    aero: AeroConstants,
    placed: tuple[PlacedWing, PlacedWing],
    shapes: Shapes,
    k: int,
    twist: FloatArray,
    rates: FloatArray,
    memory: Memory,
) -> tuple[ElementLoads, ElementLoads, FloatArray]:
    """Loads of both wings at the k-th instant, and the trailing circulations (2 N,) m2/s."""
    right, left = placed
    n = right.elements.chord.size
    influence = pair_system(right.elements, left.elements, memory.sides == 1)
    found = unsteady_rows(
        joints,
        rigid_joint_count,
        aero,
        memory.lags,
        placed,
        influence,
        shapes.stacks,
        shapes.of[:, k : k + 1].copy(),
        twist.reshape(1, 6),
        rates.reshape(1, 2, -1),
        memory.driven[k : k + 1],
        memory.states[k : k + 1],
    )
    wrenches, m = found.wrenches[0], influence.matrix.shape[0]
    drag = np.empty((2, n, 3))
    both = np.empty((2, n, 6))
    for side in range(2):
        elements = placed[side].elements
        first = side * (m - n)
        both[side] = wrenches[first : first + n]
        of_body = memory.of_body[k] if side == 0 else mirrored(memory.of_body[k])
        both[side] += inertia_wrenches(
            elements,
            apparent_inertia(elements, aero.density),
            _accelerations(placed[side], of_body, memory.free[k, side]),
        )
        through_air = twist if side == 0 else mirrored(twist)
        velocity = found.velocity[0, first : first + n]
        drag[side] = profile_drag(elements, velocity, through_air, aero.density, aero.profile_drag)
        if memory.lags.separation.of.size > 0:
            drag[side] += section_wrenches(
                elements,
                found.speed[0, first : first + n].reshape(n, 1),
                found.section[0, first : first + n].reshape(n, 3, 1),
                aero.density,
            )[:, :3, 0]
    return (
        ElementLoads(
            found.circulation[0, :n].copy(),
            found.angle_of_attack[0, :n].copy(),
            found.speed[0, :n].copy(),
            both[0].copy(),
            drag[0].copy(),
        ),
        ElementLoads(
            found.circulation[0, m - n :].copy(),
            found.angle_of_attack[0, m - n :].copy(),
            found.speed[0, m - n :].copy(),
            both[1].copy(),
            drag[1].copy(),
        ),
        np.concatenate((found.trailing[0, :n], found.trailing[0, m - n :])),
    )


@kernel
def _accelerations(placed: PlacedWing, of_body: FloatArray, free: FloatArray) -> FloatArray:
    """Accelerations (N, 6) of the control points and of the sections' turning."""
    twists = body_twists(placed.elements, np.arange(6))
    total = np.zeros((placed.elements.chord.size, 6))
    for b in range(6):
        total += of_body[b] * twists[b]
    for a in range(free.size):
        total += free[a] * placed.twist_per_rate[a]
    return total


@kernel
def _keep_wing(stack: StackedWing, k: int, placed: PlacedWing, rates: FloatArray) -> None:
    elements = placed.elements
    stack.spin[k] = 0.0
    for a in range(rates.size):
        stack.spin[k] += rates[a] * placed.twist_per_rate[a, :, 3:]
    stack.position[k], stack.node[k] = elements.position, elements.node
    stack.velocity[k] = elements.velocity
    stack.chord[k], stack.width[k] = elements.chord, elements.width
    stack.clearance[k] = clearance(elements)


@kernel
def _keep_loads(stack: StackedWing, k: int, loads: ElementLoads, about_joints: FloatArray) -> None:
    stack.force[k], stack.moment[k] = loads.wrench[:, :3], loads.wrench[:, 3:]
    stack.profile_drag[k] = loads.profile_drag
    stack.circulation[k], stack.angle_of_attack[k] = loads.circulation, loads.angle_of_attack
    stack.speed[k], stack.joint_torques[k] = loads.speed, about_joints
