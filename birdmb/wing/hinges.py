"""The lifting line and how fast single joints and hinges move it.

A load on the line has the generalised force load . (velocity per rate of a hinge) on that hinge,
by virtual work, and a moment likewise with the angular velocity of its chord. These are exact
derivatives, by the complex step of the wing's edges.
"""

from __future__ import annotations

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import Array, ComplexArray, FloatArray, IntArray
from birdmb.wing.arrays import WingArrays
from birdmb.wing.chain import Chain
from birdmb.wing.edges import (
    COMPLEX_STEP,
    edges_along,
    feather_tip,
    leading_edge_to,
    wing_edges,
)
from birdmb.wing.line import PairedEdges, line_to_follow, moved_line, solved_line
from birdmb.wing.one_step import one_step_line


@kernel
def orthogonal_wing(
    wing: WingArrays,
    bones: Chain,
    angles: ComplexArray,
    stations: FloatArray,
    rounding: float,
    moving: IntArray,
) -> tuple[PairedEdges, Array, FloatArray, FloatArray]:
    """Orthogonal line of a wing at `angles` (A,) rad, whose imaginary parts carry rates.

    At `stations` (n,) with these parameters. Returns the paired edges, the leading edge's vertices
    (m, 3) m, the points (n, 3) m from which the span direction is taken and the twists (M, N, 6)
    per rate of each of the angles `moving` (M,): velocities (m) of the N control points, every
    second station, and angular velocities of their chords.
    """
    leading, trailing = edges_along(wing, bones, angles)
    line = solved_line(leading, trailing, stations, rounding)
    pairs = moved_line(line, leading, trailing, rounding)
    twist = np.empty((moving.size, stations.size // 2, 6))
    for m in range(moving.size):
        edges = _edges_moved(wing, bones, angles, leading, trailing, moving[m])
        _write_control_twist(moved_line(line, edges[0], edges[1], rounding), twist[m])
    return pairs, leading, line_to_follow(line, pairs), twist


@kernel
def one_step_wing(
    wing: WingArrays, bones: Chain, angles: ComplexArray, stations: int, moving: IntArray
) -> tuple[PairedEdges, Array, FloatArray, FloatArray]:
    """As `orthogonal_wing` with the published line; see `one_step_line` about its direction."""
    leading, trailing = edges_along(wing, bones, angles)
    pairs, guide = one_step_line(leading, trailing, stations)
    twist = np.empty((moving.size, stations // 2, 6))
    for m in range(moving.size):
        edges = _edges_moved(wing, bones, angles, leading, trailing, moving[m])
        _write_control_twist(one_step_line(edges[0], edges[1], stations)[0], twist[m])
    return pairs, leading, guide.real.copy(), twist


@kernel
def _edges_moved(
    wing: WingArrays,
    bones: Chain,
    angles: ComplexArray,
    leading: ComplexArray,
    trailing: ComplexArray,
    which: int,
) -> tuple[ComplexArray, ComplexArray]:
    """The edges (m, 3) m, with the rates that one of the angles gives them as imaginary parts."""
    alone = _one_moving(angles, which)
    if which < wing.segment.size:
        return wing_edges(wing, alone)
    # A hinge moves feathers alone, and the leading edge only where it ends with one of them.
    still = _without_rates(bones)
    moved, last = trailing.real.astype(np.complex128), wing.feather_hinge.size - 1
    for feather in range(last + 1):
        if wing.feather_hinge[feather] == which:
            tip = feather_tip(wing, still, alone, feather)
            for i in range(3):
                moved[feather, i] = tip[i]
    if wing.feather_hinge[last] == which:
        return leading_edge_to(wing, still, moved[last]), moved
    return leading.real.astype(np.complex128), moved


@kernel
def _without_rates(bones: Chain) -> Chain:
    return Chain(
        bones.axis.real.astype(np.complex128),
        bones.frame.real.astype(np.complex128),
        bones.origin.real.astype(np.complex128),
        bones.tip.real.astype(np.complex128),
        bones.rotation.real.astype(np.complex128),
        bones.root_rotation.real.astype(np.complex128),
    )


@kernel
def _one_moving(angles: ComplexArray, which: int) -> ComplexArray:
    moving = angles.real.astype(np.complex128)
    moving[which] += 1j * COMPLEX_STEP
    return moving


@kernel
def _write_control_twist(pairs: PairedEdges, twist: FloatArray) -> None:
    """Write velocities of the control points and angular velocities of their chords, (N, 6)."""
    for e in range(twist.shape[0]):
        square = 0.0
        for i in range(3):
            front, back = pairs.leading[2 * e, i], pairs.trailing[2 * e, i]
            twist[e, i] = (0.75 * front.imag + 0.25 * back.imag) / COMPLEX_STEP
            square += (back.real - front.real) ** 2
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            along = pairs.trailing[2 * e, j] - pairs.leading[2 * e, j]
            across = pairs.trailing[2 * e, k] - pairs.leading[2 * e, k]
            turning = along.real * across.imag - across.real * along.imag
            twist[e, 3 + i] = turning / COMPLEX_STEP / square
