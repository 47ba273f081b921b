"""A wing in air that remembers, whose joints are all prescribed: what the phase alone determines.

Beside `birdmb.aerodynamics.prescribed`, whose wings these are.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.airframe import AeroConstants, airframe_loads
from birdmb.aerodynamics.apparent_mass import (
    apparent_inertia,
    body_twists,
    inertia_matrix,
)
from birdmb.aerodynamics.elements import Elements
from birdmb.aerodynamics.pair import pair_system, pair_wrench
from birdmb.aerodynamics.prescribed import PrescribedWing, at_phase
from birdmb.aerodynamics.section_motion import SectionMotion, section_motion
from birdmb.aerodynamics.twist_loads import mirror_sign, wing_wrench
from birdmb.aerodynamics.unsteady_circulation import (
    LagSystem,
    lag_system,
    unsteady_circulations,
)
from birdmb.aerodynamics.unsteady_loads import SideFlow, side_flow, side_wrenches
from birdmb.aerodynamics.wake_lags import WakeLags
from birdmb.wing.stacked import NearShapes, shape_at


class LagTable(NamedTuple):
    """What lags need at P phases, of the right wing (S = 1), or of both (S = 2)."""

    system: LagSystem  # each array stacked
    induced_y: FloatArray  # (P, M, M) 1/m, by the trailing circulations
    induced_z: FloatArray  # (P, M, M) 1/m
    right: SectionMotion  # each array stacked
    left: SectionMotion
    inertia: FloatArray  # (P, 6, 6) kg, kg m and kg m2, of the air about both wings
    lags: WakeLags


def every_second_lag(table: LagTable) -> LagTable:
    """The table of every second phase, the first included."""
    return LagTable(
        LagSystem(*(array[::2].copy() for array in table.system)),
        table.induced_y[::2].copy(),
        table.induced_z[::2].copy(),
        SectionMotion(*(array[::2].copy() for array in table.right)),
        SectionMotion(*(array[::2].copy() for array in table.left)),
        table.inertia[::2].copy(),
        table.lags,
    )


@kernel
def _no_motion(count: int, n: int) -> SectionMotion:
    return SectionMotion(
        np.empty((count, n, 3)),
        np.empty((count, n, 3)),
        np.empty((count, n, 3)),
        np.empty((count, n)),
        np.empty((count, n)),
        np.empty((count, n, 3)),
        np.empty((count, n, 3)),
    )


@kernel
def _empty(count: int, n: int, sides: int, lags: WakeLags) -> LagTable:
    m = sides * n
    return LagTable(
        LagSystem(
            np.empty((count, m)),
            np.empty((count, m)),
            np.empty((count, sides)),
            np.empty((count, m, m)),
            np.empty((count, m, m)),
        ),
        np.empty((count, m, m)),
        np.empty((count, m, m)),
        _no_motion(count, n),
        _no_motion(count, n),
        np.empty((count, 6, 6)),
        lags,
    )


@kernel
def lag_table(
    right: PrescribedWing,
    left: PrescribedWing,
    near: NearShapes,
    near_left: NearShapes,
    lags: WakeLags,
    is_mirrored: bool,
    density: float,
) -> LagTable:
    """Tabulate what the lags of tabulated wings need; of the right one where both are mirrored."""
    count, n = right.elements.chord.shape
    table = _empty(count, n, 1 if is_mirrored else 2, lags)
    whole = np.arange(6)
    for k in range(count):
        elements, image = at_phase(right.elements, k), at_phase(left.elements, k)
        influence = pair_system(elements, image, is_mirrored)
        table.induced_y[k], table.induced_z[k] = influence.induced_y, influence.induced_z
        system = lag_system(elements, image, influence.induced_y, influence.induced_z, lags)
        table.system.per_velocity[k], table.system.chord[k] = system.per_velocity, system.chord
        table.system.half_span[k], table.system.downwash[k] = system.half_span, system.downwash
        table.system.inverse[k] = system.inverse
        table.inertia[k] = 0.0
        for side in range(2):
            wing = elements if side == 0 else image
            shapes = near if side == 0 else near_left
            motion = section_motion(
                shape_at(shapes.before, k),
                shape_at(shapes.now, k),
                shape_at(shapes.after, k),
                shapes.step,
            )
            _keep(table.right if side == 0 else table.left, k, motion)
            own = inertia_matrix(wing, apparent_inertia(wing, density), body_twists(wing, whole))
            for i in range(6):
                for j in range(6):
                    sign = 1.0 if side == 0 else mirror_sign(i) * mirror_sign(j)
                    table.inertia[k, i, j] += sign * own[i, j]
    return table


@kernel
def _keep(stack: SectionMotion, k: int, motion: SectionMotion) -> None:
    stack.rear_velocity[k], stack.middle_velocity[k] = motion.rear_velocity, motion.middle_velocity
    stack.middle_acceleration[k] = motion.middle_acceleration
    stack.pitch_rate[k], stack.pitch_acceleration[k] = motion.pitch_rate, motion.pitch_acceleration
    stack.normal_rate[k], stack.span_rate[k] = motion.normal_rate, motion.span_rate


@kernel
def _motion_at(stack: SectionMotion, k: int) -> SectionMotion:
    return SectionMotion(
        stack.rear_velocity[k],
        stack.middle_velocity[k],
        stack.middle_acceleration[k],
        stack.pitch_rate[k],
        stack.pitch_acceleration[k],
        stack.normal_rate[k],
        stack.span_rate[k],
    )


@kernel
def _system_at(stack: LagSystem, k: int) -> LagSystem:
    return LagSystem(
        stack.per_velocity[k],
        stack.chord[k],
        stack.half_span[k],
        stack.downwash[k],
        stack.inverse[k],
    )


@kernel
def lagged_loads(
    right: PrescribedWing,
    left: PrescribedWing,
    table: LagTable,
    k: int,
    aero: AeroConstants,
    twist: FloatArray,
    directions: IntArray,
    states: FloatArray,
    slopes_wanted: bool,
) -> tuple[FloatArray, FloatArray]:
    """Wrench of the air (6, 1 + D) at the k-th phase on a body without acceleration in space.

    And the rates of the lags (S 4 K, 1 + D). `states` (S 4 K,) are the lags. D counts the
    `directions` (d,) of the `twist` (6,), and with `slopes_wanted` the lags behind them. Exact.
    """
    n, m = right.elements.chord.shape[1], table.induced_y.shape[1]
    elements, image = at_phase(right.elements, k), at_phase(left.elements, k)
    given = directions.size + 1
    flow = _flow_at(elements, table.right, k, aero.density, twist, directions, False)
    driving, speed = np.empty((m, given)), np.empty((m, given))
    driving[:n], speed[:n] = flow.driving, flow.speed
    flow_left = flow
    if m > n:
        flow_left = _flow_at(image, table.left, k, aero.density, twist, directions, True)
        driving[n:], speed[n:] = flow_left.driving, flow_left.speed
    unsteady = unsteady_circulations(
        _system_at(table.system, k), table.lags, driving, speed, states, slopes_wanted
    )
    trailing = unsteady.trailing
    y, z = table.induced_y[k] @ trailing, table.induced_z[k] @ trailing
    wrenches = side_wrenches(elements, flow, unsteady, y, z, 0, aero.density, aero.profile_drag)
    of_right = wing_wrench(elements.position, wrenches)
    of_left = of_right
    if m > n:
        wrenches = side_wrenches(
            image, flow_left, unsteady, y, z, n, aero.density, aero.profile_drag
        )
        of_left = wing_wrench(image.position, wrenches)
    total = pair_wrench(of_right, of_left)
    # In the plane of symmetry each wing induces half of what a pair of them would.
    induced = 0.5 * (right.at_tail[k] @ trailing[:n] + left.at_tail[k] @ trailing[m - n :])
    total += airframe_loads(aero, induced, twist, directions)
    return total, unsteady.lag_rates


@kernel
def _flow_at(
    elements: Elements,
    motions: SectionMotion,
    k: int,
    density: float,
    twist: FloatArray,
    directions: IntArray,
    is_mirrored: bool,
) -> SideFlow:
    air = apparent_inertia(elements, density)
    motion = _motion_at(motions, k)
    return side_flow(elements, elements.velocity, motion, air, twist, directions, is_mirrored)
