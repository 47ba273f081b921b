"""Two wings in each other's wake: their circulations and the loads on their elements.

The left wing is mirrored onto the right side. Where both do the same at all times the pair is
`mirrored`: one wing tells of both, and one system of N unknowns holds its circulations. Else the
system holds those of the right wing, then those of the left one, 2 N in all.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.aerodynamics.elements import (
    Elements,
    add_wake,
    circulation_system,
    downwash_share,
)
from birdmb.aerodynamics.twist_loads import Flow, element_wrenches, mirror_sign, mirrored, wing_flow


class PairSystem(NamedTuple):
    """What the circulations of M elements obey, and the velocities that they induce at them."""

    matrix: FloatArray  # (M, M), times the circulations it is those without downwash
    induced_y: FloatArray  # (M, M) 1/m
    induced_z: FloatArray  # (M, M) 1/m


class ElementLoads(NamedTuple):
    """Loads of the N elements of a right wing, or of a left one mirrored onto the right side."""

    circulation: FloatArray  # (N,) m2/s
    angle_of_attack: FloatArray  # (N,) rad, geometric (before the downwash)
    speed: FloatArray  # (N,) m/s in the section's plane
    wrench: FloatArray  # (N, 6) N and N m at the control points, profile drag included
    profile_drag: FloatArray  # (N, 3) N


@kernel
def pair_system(right: Elements, left: Elements, is_mirrored: bool) -> PairSystem:
    """The linear system of a pair's circulations."""
    if is_mirrored:
        return PairSystem(circulation_system(right), right.induced_y, right.induced_z)
    n = right.chord.size
    matrix = np.eye(2 * n)
    induced_y, induced_z = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, 2 * n))
    for row in range(2):
        at = right if row == 0 else left
        rows = slice(row * n, (row + 1) * n)
        for column in range(2):
            source = right if column == 0 else left
            own = 1.0 if row == column else 0.0
            y, z = np.zeros((n, n)), np.zeros((n, n))
            add_wake(at.position, source.node, 0, own, 1.0 - own, y, z)
            columns = slice(column * n, (column + 1) * n)
            induced_y[rows, columns], induced_z[rows, columns] = y, z
            matrix[rows, columns] += downwash_share(at, y, z)
    return PairSystem(matrix, induced_y, induced_z)


@kernel
def circulations(system: PairSystem, bound: FloatArray) -> FloatArray:
    """Circulations (M, R) m2/s of those without downwash (M, R); NaN where they overflow."""
    found = np.full(bound.shape, np.nan)
    # The solver refuses what is not finite; a flow that diverges is told by whoever follows it.
    if np.isfinite(np.sum(system.matrix)) and np.isfinite(np.sum(bound)):
        found = np.ascontiguousarray(np.linalg.solve(system.matrix, bound))
    return found


@kernel
def pair_loads(
    right: Elements,
    left: Elements,
    is_mirrored: bool,
    density: float,
    profile_drag: float,
    twist: FloatArray,
) -> tuple[ElementLoads, ElementLoads]:
    """Loads of the right wing and of the left one, of a body that moves with a `twist` (6,).

    `density` (kg/m3) is the air's, `profile_drag` the drag coefficient of the sections. A mirrored
    pair has the same loads on both sides; v, p and r of the twist must then be zero.
    """
    n = right.chord.size
    system = pair_system(right, left, is_mirrored)
    no_derivatives = np.empty(0, np.int64)
    flow = wing_flow(right, right.velocity, twist, no_derivatives)
    flow_left = flow
    if not is_mirrored:
        flow_left = wing_flow(left, left.velocity, mirrored(twist), no_derivatives)
    bound = flow.bound if is_mirrored else np.concatenate((flow.bound, flow_left.bound))
    gamma = circulations(system, bound)
    y, z = system.induced_y @ gamma, system.induced_z @ gamma
    of_right = _loads(right, flow, gamma[:n], y[:n], z[:n], density, profile_drag)
    if is_mirrored:
        return of_right, of_right
    return of_right, _loads(left, flow_left, gamma[n:], y[n:], z[n:], density, profile_drag)


@kernel
def _loads(
    elements: Elements,
    flow: Flow,
    gamma: FloatArray,
    induced_y: FloatArray,
    induced_z: FloatArray,
    density: float,
    profile_drag: float,
) -> ElementLoads:
    wind = flow.wind
    without = element_wrenches(elements, wind, gamma, induced_y, induced_z, density, 0.0)
    loads = without
    if profile_drag > 0.0:
        loads = element_wrenches(elements, wind, gamma, induced_y, induced_z, density, profile_drag)
    drag = (loads - without)[:, :3, 0].copy()
    return ElementLoads(
        gamma[:, 0].copy(), flow.angle_of_attack, flow.speed, loads[:, :, 0].copy(), drag
    )


@kernel
def pair_wrench(of_right: FloatArray, of_left: FloatArray) -> FloatArray:
    """Wrench (6, 1 + d) of both wings, that of the left one given mirrored."""
    total = np.empty(of_right.shape)
    for i in range(6):
        for m in range(of_right.shape[1]):
            total[i, m] = of_right[i, m] + mirror_sign(i) * of_left[i, m]
    return total
