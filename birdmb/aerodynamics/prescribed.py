"""A wing whose joints are all prescribed: everything but the body's motion is known per phase.

The wing's shape, its velocities and the inverse of the circulation's linear system depend on the
phase alone (docs/model.md, section 5), so they are computed once and shared by every trajectory
and every perturbation of it. What remains per evaluation is three products of small matrices.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.airframe import AeroConstants, airframe_loads
from birdmb.aerodynamics.elements import (
    ODD,
    Elements,
    circulation_system,
    clearance,
    place_elements,
    system_of,
    wake_influence,
)
from birdmb.aerodynamics.pair import pair_system, pair_wrench
from birdmb.aerodynamics.tail import TailSurface, tail_influence
from birdmb.aerodynamics.twist_loads import (
    element_wrenches,
    mirrored_flow,
    wing_flow,
    wing_wrench,
)
from birdmb.wing.arrays import WingArrays
from birdmb.wing.stacked import StackedShapes, every_second_shape, shape_at, wing_shapes


class PrescribedWing(NamedTuple):
    """Elements at P phases: the arrays of `Elements` stacked along a first axis, and inverses."""

    elements: Elements
    inverse: FloatArray  # (P, N, N) of the circulation's linear system
    at_tail: FloatArray  # (P, 2, N) 1/m, velocity along x and z at the tail by the circulations
    shapes: StackedShapes  # that the elements were placed by
    clearance: FloatArray  # (P,) m, see `elements.clearance`; NaN also where not converged


def driver_motion(wing: WingArrays, t: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Driver angles (A,) rad, rates and accelerations of all joints and hinges at time t (s)."""
    angles, rates, accelerations = driver_motion_along(wing, np.array([t]))
    return angles[0], rates[0], accelerations[0]


def driver_motion_along(
    wing: WingArrays, times: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """As `driver_motion`, each (P, A), at `times` (P,) s."""
    rate = wing.angular_frequency * np.arange(1, wing.cosine.shape[1] + 1)  # of each harmonic
    cosine, sine = np.cos(times[:, None] * rate), np.sin(times[:, None] * rate)
    return (
        wing.offset + cosine @ wing.cosine.T + sine @ wing.sine.T,
        (rate * cosine) @ wing.sine.T - (rate * sine) @ wing.cosine.T,
        -(rate**2 * cosine) @ wing.cosine.T - (rate**2 * sine) @ wing.sine.T,
    )


def prescribed_wing(
    wing: WingArrays,
    tail: TailSurface,
    times: FloatArray,
    elements: int,
    rounding: float,
    published: bool,
) -> PrescribedWing:
    """Tabulate the wing at `times` (P,) s; inverses are NaN where the wing is across the plane."""
    angles, rates, _ = driver_motion_along(wing, times)
    shapes = wing_shapes(wing, angles, rates, elements, rounding, published)
    return _tabulated(shapes, wing.root, tail)


@kernel
def _tabulated(shapes: StackedShapes, root: FloatArray, tail: TailSurface) -> PrescribedWing:
    count, n = shapes.chord.shape
    position, node = np.empty((count, n, 3)), np.empty((count, n + 1, 3))
    width, clearances = np.empty((count, n)), np.empty(count)
    induced_y, induced_z = np.empty((count, n, n)), np.empty((count, n, n))
    inverse, at_tail = np.full((count, n, n), np.nan), np.empty((count, 2, n))
    for k in range(count):
        placed = place_elements(shape_at(shapes, k), root)
        position[k], node[k], width[k] = placed.position, placed.node, placed.width
        induced_y[k], induced_z[k] = placed.induced_y, placed.induced_z
        at_tail[k] = tail_influence(tail, placed.node)
        clearances[k] = clearance(placed)
        if clearances[k] >= 0.0:
            inverse[k] = np.linalg.inv(circulation_system(placed))
    elements = Elements(
        position,
        shapes.velocity,
        shapes.chord_direction,
        shapes.normal,
        shapes.span_direction,
        shapes.chord,
        shapes.profile,
        node,
        width,
        induced_y,
        induced_z,
    )
    return PrescribedWing(elements, inverse, at_tail, shapes, clearances)


def every_second(wing: PrescribedWing) -> PrescribedWing:
    """The table of every second phase, the first included."""
    return PrescribedWing(
        Elements(*(array[::2].copy() for array in wing.elements)),
        wing.inverse[::2].copy(),
        wing.at_tail[::2].copy(),
        every_second_shape(wing.shapes),
        wing.clearance[::2].copy(),
    )


@kernel
def at_phase(stack: Elements, k: int) -> Elements:
    """Elements at the k-th phase, as views."""
    return Elements(
        stack.position[k],
        stack.velocity[k],
        stack.chord_direction[k],
        stack.normal[k],
        stack.span_direction[k],
        stack.chord[k],
        stack.profile[k],
        stack.node[k],
        stack.width[k],
        stack.induced_y[k],
        stack.induced_z[k],
    )


class WakeTable(NamedTuple):
    """Influences at P phases that motion in space needs beside those of even parity.

    Of both wings of one shape those of odd parity, M = N; of different shapes those of the right
    wing's circulations, then the left one's, on the right wing, then the left one, M = 2 N.
    """

    induced_y: FloatArray  # (P, M, M) 1/m, as those of `Elements`
    induced_z: FloatArray  # (P, M, M) 1/m
    inverse: FloatArray  # (P, M, M) of the circulation's linear system


def no_wakes() -> WakeTable:
    """The influences that symmetric flight needs beside those of even parity: at no phase."""
    return WakeTable(np.empty((0, 0, 0)), np.empty((0, 0, 0)), np.empty((0, 0, 0)))


@kernel
def odd_wakes(wing: PrescribedWing) -> WakeTable:
    """Influences and inverses of odd parity of a tabulated wing; NaN as in its own inverses."""
    count, n = wing.elements.chord.shape
    induced_y, induced_z = np.empty((count, n, n)), np.empty((count, n, n))
    inverse = np.full((count, n, n), np.nan)
    for k in range(count):
        placed = at_phase(wing.elements, k)
        induced_y[k], induced_z[k] = wake_influence(placed.position, placed.node, ODD)
        if wing.clearance[k] >= 0.0:
            inverse[k] = np.linalg.inv(system_of(placed, induced_y[k], induced_z[k]))
    return WakeTable(induced_y, induced_z, inverse)


@kernel
def pair_wakes(right: PrescribedWing, left: PrescribedWing) -> WakeTable:
    """Influences and inverses of two tabulated wings of different shapes; NaN as in theirs."""
    count, n = right.elements.chord.shape
    induced_y, induced_z = np.empty((count, 2 * n, 2 * n)), np.empty((count, 2 * n, 2 * n))
    inverse = np.full((count, 2 * n, 2 * n), np.nan)
    for k in range(count):
        system = pair_system(at_phase(right.elements, k), at_phase(left.elements, k), False)
        induced_y[k], induced_z[k] = system.induced_y, system.induced_z
        if right.clearance[k] >= 0.0 and left.clearance[k] >= 0.0:
            inverse[k] = np.linalg.inv(system.matrix)
    return WakeTable(induced_y, induced_z, inverse)


@kernel
def symmetric_loads(
    wing: PrescribedWing, k: int, aero: AeroConstants, twist: FloatArray, directions: IntArray
) -> FloatArray:
    """Wrench of the air (6, 1 + d) at the k-th phase on a bird in symmetric flight, exact.

    Of its `twist` (6,) v, p and r are zero, and none of them is among the `directions`.
    """
    elements = at_phase(wing.elements, k)
    flow = wing_flow(elements, elements.velocity, twist, directions)
    circulation = wing.inverse[k] @ flow.bound
    wrenches = element_wrenches(
        elements,
        flow.wind,
        circulation,
        elements.induced_y @ circulation,
        elements.induced_z @ circulation,
        aero.density,
        aero.profile_drag,
    )
    wrench = wing_wrench(elements.position, wrenches)
    total = airframe_loads(aero, wing.at_tail[k] @ circulation, twist, directions)
    total += pair_wrench(wrench, wrench)
    return total


@kernel
def free_loads(
    right: PrescribedWing,
    left: PrescribedWing,
    wakes: WakeTable,
    k: int,
    aero: AeroConstants,
    twist: FloatArray,
    directions: IntArray,
) -> FloatArray:
    """Wrench of the air (6, 1 + d) at the k-th phase on a bird in any motion, exact.

    The `left` wing is mirrored onto the right side.
    """
    elements, image = at_phase(right.elements, k), at_phase(left.elements, k)
    n = elements.chord.size
    flow = wing_flow(elements, elements.velocity, twist, directions)
    flow_left = mirrored_flow(image, twist, directions)
    y, z = np.empty((2 * n, directions.size + 1)), np.empty((2 * n, directions.size + 1))
    gamma = np.empty((2 * n, directions.size + 1))
    if wakes.inverse.shape[1] == n:
        even = right.inverse[k] @ (0.5 * (flow.bound + flow_left.bound))
        odd = wakes.inverse[k] @ (0.5 * (flow.bound - flow_left.bound))
        even_y, even_z = elements.induced_y @ even, elements.induced_z @ even
        odd_y, odd_z = wakes.induced_y[k] @ odd, wakes.induced_z[k] @ odd
        gamma[:n], gamma[n:] = even + odd, even - odd
        y[:n], y[n:] = even_y + odd_y, even_y - odd_y
        z[:n], z[n:] = even_z + odd_z, even_z - odd_z
    else:
        gamma[:] = wakes.inverse[k] @ np.concatenate((flow.bound, flow_left.bound))
        y[:], z[:] = wakes.induced_y[k] @ gamma, wakes.induced_z[k] @ gamma
    density, drag = aero.density, aero.profile_drag
    wrenches = element_wrenches(elements, flow.wind, gamma[:n], y[:n], z[:n], density, drag)
    of_right = wing_wrench(elements.position, wrenches)
    wrenches = element_wrenches(image, flow_left.wind, gamma[n:], y[n:], z[n:], density, drag)
    of_left = wing_wrench(image.position, wrenches)
    total = pair_wrench(of_right, of_left)
    # In the plane of symmetry each wing induces half of what a pair of them would.
    induced = 0.5 * (right.at_tail[k] @ gamma[:n] + left.at_tail[k] @ gamma[n:])
    return total + airframe_loads(aero, induced, twist, directions)
