"""Compiled loads of air that remembers on the wings of a tree, at many rows of the same angles."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.airframe import AeroConstants
from birdmb.aerodynamics.apparent_mass import (
    ApparentInertia,
    apparent_inertia,
    body_twists,
    inertia_matrix,
)
from birdmb.aerodynamics.pair import PairSystem
from birdmb.aerodynamics.section_motion import SectionMotion, section_motion, turned_sections
from birdmb.aerodynamics.twist_loads import mirror_sign, mirrored
from birdmb.aerodynamics.unsteady_circulation import lag_system, unsteady_circulations
from birdmb.aerodynamics.unsteady_loads import SideFlow, side_flow, side_wrenches
from birdmb.aerodynamics.wake_lags import WakeLags
from birdmb.models.placed_wing import PlacedWing, spin_change, spin_of, swung
from birdmb.wing.arrays import JointArrays
from birdmb.wing.stacked import NearShapes, shape_at


class UnsteadyRows(NamedTuple):
    """Loads of R rows on M elements, the right wing's, then the left one's mirrored."""

    wrenches: FloatArray  # (R, M, 6) N and N m, without those of accelerations yet to be found
    circulation: FloatArray  # (R, M) m2/s, bound
    trailing: FloatArray  # (R, M) m2/s
    lag_rates: FloatArray  # (R, L)
    angle_of_attack: FloatArray  # (R, M) rad, at three quarters of the chord
    speed: FloatArray  # (R, M) m/s, there
    velocity: FloatArray  # (R, M, 3) m/s, of the control points relative to the body
    section: FloatArray  # (R, M, 3) of `Separation`, zeros where no flow separates


@kernel
def unsteady_rows(
    joints: JointArrays,
    rigid_joint_count: int,
    aero: AeroConstants,
    lags: WakeLags,
    placed: tuple[PlacedWing, PlacedWing],
    influence: PairSystem,
    shapes: tuple[NearShapes, NearShapes],
    shape_of: IntArray,
    twists: FloatArray,
    rates: FloatArray,
    accelerations: FloatArray,
    states: FloatArray,
) -> UnsteadyRows:
    """Loads of placed wings in air that remembers, and the rates of the lags.

    `shape_of` (2, R) tells which of its `shapes` a wing has, `twists` (R, 6) are the body's through
    the air, `rates` and `accelerations` (R, 2, A) those of joints and hinges, the latter 0 where no
    driver gives them; `states` (R, L) are the lags. Of mirrored wings only the right one counts.
    """
    count, n, m = len(twists), placed[0].elements.chord.size, influence.matrix.shape[0]
    found = UnsteadyRows(
        np.empty((count, m, 6)),
        np.empty((count, m)),
        np.empty((count, m)),
        np.empty(states.shape),
        np.empty((count, m)),
        np.empty((count, m)),
        np.empty((count, m, 3)),
        np.zeros((count, m, 3)),
    )
    right, left = placed[0].elements, placed[1].elements
    system = lag_system(right, left, influence.induced_y, influence.induced_z, lags)
    air = apparent_inertia(right, aero.density)
    air_left = air if m == n else apparent_inertia(left, aero.density)
    for r in range(count):
        flow, found.velocity[r, :n] = _met(
            joints,
            rigid_joint_count,
            placed[0],
            shapes[0],
            shape_of[0, r],
            air,
            twists[r],
            rates[r, 0],
            accelerations[r, 0],
        )
        other = flow
        if m > n:
            other, found.velocity[r, n:] = _met(
                joints,
                rigid_joint_count,
                placed[1],
                shapes[1],
                shape_of[1, r],
                air_left,
                mirrored(twists[r]),
                rates[r, 1],
                accelerations[r, 1],
            )
        driving, speed = np.empty((m, 1)), np.empty((m, 1))
        driving[:n], speed[:n] = flow.driving, flow.speed
        driving[m - n :], speed[m - n :] = other.driving, other.speed
        unsteady = unsteady_circulations(system, lags, driving, speed, states[r], False)
        y, z = influence.induced_y @ unsteady.trailing, influence.induced_z @ unsteady.trailing
        for side in range(m // n):
            rows = slice(side * n, (side + 1) * n)
            own = flow if side == 0 else other
            found.wrenches[r, rows] = side_wrenches(
                right if side == 0 else left,
                own,
                unsteady,
                y,
                z,
                side * n,
                aero.density,
                aero.profile_drag,
            )[:, :, 0]
            found.angle_of_attack[r, rows] = own.angle_of_attack
        found.speed[r] = speed[:, 0]
        found.circulation[r] = unsteady.circulation[:, 0]
        found.trailing[r] = unsteady.trailing[:, 0]
        found.lag_rates[r] = unsteady.lag_rates[:, 0]
        if unsteady.section.size > 0:
            found.section[r] = unsteady.section[:, :, 0]
    return found


@kernel
def _met(
    joints: JointArrays,
    rigid_joint_count: int,
    placed: PlacedWing,
    shapes: NearShapes,
    s: int,
    air: ApparentInertia,
    twist: FloatArray,
    rates: FloatArray,
    accelerations: FloatArray,
) -> tuple[SideFlow, FloatArray]:
    """What a wing of the s-th shape meets, and the velocities (N, 3) m/s of its control points."""
    elements, root = placed.elements, joints.root
    spin = spin_of(placed.chain, rigid_joint_count, rates)
    change = spin_change(placed.chain, rigid_joint_count, rates, accelerations)
    now = shape_at(shapes.now, s)
    own = section_motion(shape_at(shapes.before, s), now, shape_at(shapes.after, s), shapes.step)
    motion: SectionMotion = turned_sections(own, elements, root, placed.axes, spin, change)
    velocity = swung(now.velocity, placed, root, spin)
    no_derivatives = np.empty(0, np.int64)
    flow = side_flow(elements, velocity, motion, air, twist, no_derivatives, False)
    return flow, velocity


@kernel
def air_inertia(
    placed: tuple[PlacedWing, PlacedWing], directions: IntArray, is_mirrored: bool, density: float
) -> FloatArray:
    """Mass matrix (B + C, B + C) of the air about the wings.

    Of the body's coordinates `directions` (B,), then of the C angles of joints and hinges: those of
    the right wing, which where the wings are mirrored stand for both, else of each.
    """
    body, joints = directions.size, placed[0].twist_per_rate.shape[0]
    sides = 1 if is_mirrored else 2
    matrix = np.zeros((body + sides * joints, body + sides * joints))
    for side in range(sides):
        elements = placed[side].elements
        twists = np.concatenate((body_twists(elements, directions), placed[side].twist_per_rate))
        if side == 1:
            for b in range(body):
                twists[b] *= mirror_sign(directions[b])
        own = inertia_matrix(elements, apparent_inertia(elements, density), twists)
        copies = 2.0 if is_mirrored else 1.0
        for a in range(body + joints):
            i = a if a < body else a + side * joints
            for b in range(body + joints):
                matrix[i, b if b < body else b + side * joints] += copies * own[a, b]
    return matrix
