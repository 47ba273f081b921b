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
    stations: int,
    rounding: float,
    moving: IntArray,
) -> tuple[PairedEdges, Array, Array, FloatArray]:
    """Orthogonal line of a wing at `angles` (A,) rad, whose imaginary parts carry rates.

    Returns the paired edges, the leading edge's vertices (m, 3) m, the points (stations, 3) m from
    which the span direction is taken and the twists (M, N, 6) per rate of each of the angles
    `moving` (M,): velocities (m) of the N control points, every second station, and angular
    velocities of their chords.
    """
    leading, trailing = edges_along(wing, bones, angles)
    line = solved_line(leading, trailing, stations, rounding)
    pairs = moved_line(line, leading, trailing, rounding)
    twist = np.empty((moving.size, stations // 2, 6))
    for m in range(moving.size):
        moving_leading, moving_trailing = _edges_moved(wing, bones, angles, trailing, moving[m])
        twist[m] = _control_twist(moved_line(line, moving_leading, moving_trailing, rounding))
    return pairs, leading, line_to_follow(line, pairs), twist


@kernel
def one_step_wing(
    wing: WingArrays, bones: Chain, angles: ComplexArray, stations: int, moving: IntArray
) -> tuple[PairedEdges, Array, Array, FloatArray]:
    """As `orthogonal_wing` with the published line; see `one_step_line` about its direction."""
    leading, trailing = edges_along(wing, bones, angles)
    pairs, guide = one_step_line(leading, trailing, stations)
    twist = np.empty((moving.size, stations // 2, 6))
    for m in range(moving.size):
        moving_leading, moving_trailing = _edges_moved(wing, bones, angles, trailing, moving[m])
        twist[m] = _control_twist(one_step_line(moving_leading, moving_trailing, stations)[0])
    return pairs, leading, guide, twist


@kernel
def _edges_moved(
    wing: WingArrays, bones: Chain, angles: ComplexArray, trailing: ComplexArray, which: int
) -> tuple[ComplexArray, ComplexArray]:
    """The edges (m, 3) m, with the rates that one of the angles gives them as imaginary parts."""
    alone = _one_moving(angles, which)
    if which < wing.segment.size:
        return wing_edges(wing, alone)
    # A hinge moves feathers alone.
    still = _without_rates(bones)
    moved = trailing.real.astype(np.complex128)
    for i in range(wing.feather_hinge.size):
        if wing.feather_hinge[i] == which:
            moved[i] = feather_tip(wing, still, alone, i)
    return leading_edge_to(wing, still, moved[-1]), moved


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
def _control_twist(pairs: PairedEdges) -> FloatArray:
    """Velocities of the control points and angular velocities of their chords, (N, 6)."""
    n = pairs.leading.shape[0] // 2
    twist = np.empty((n, 6))
    twist[:, :3] = (0.75 * pairs.leading + 0.25 * pairs.trailing)[0::2].imag / COMPLEX_STEP
    for e in range(n):
        chord = pairs.trailing[2 * e] - pairs.leading[2 * e]
        c, rate = chord.real, chord.imag / COMPLEX_STEP
        square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2]
        twist[e, 3] = (c[1] * rate[2] - c[2] * rate[1]) / square
        twist[e, 4] = (c[2] * rate[0] - c[0] * rate[2]) / square
        twist[e, 5] = (c[0] * rate[1] - c[1] * rate[0]) / square
    return twist
