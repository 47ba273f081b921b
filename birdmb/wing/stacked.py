"""Shapes of the wing at many instants, stacked for compiled loops."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import BoolArray, FloatArray, IntArray
from birdmb.wing.arrays import WingArrays
from birdmb.wing.line import station_parameters
from birdmb.wing.shape import WingShape, shape_of_edges, wing_shape


class StackedShapes(NamedTuple):
    """The arrays of P `WingShape`s, each stacked along a first axis."""

    line: FloatArray  # (P, 2 N, 3)
    velocity: FloatArray  # (P, N, 3)
    chord_direction: FloatArray  # (P, N, 3)
    normal: FloatArray  # (P, N, 3)
    span_direction: FloatArray  # (P, N, 3)
    chord: FloatArray  # (P, N)
    profile: FloatArray  # (P, N, 3)
    distal_fraction: FloatArray  # (P, N, B - 1)
    converged: BoolArray  # (P,)
    hinge_twist: FloatArray  # (P, H, N, 6)
    chord_rate: FloatArray  # (P, N, 3)
    singly: IntArray  # (M,) angles whose own effect on the velocity is known
    rates: FloatArray  # (P, M) rad/s of these, of which `velocity` is made
    velocity_per_rate: FloatArray  # (P, M, N, 3) m


class NearShapes(NamedTuple):
    """Shapes of one wing at P instants, and those a short time before and after."""

    now: StackedShapes
    before: StackedShapes
    after: StackedShapes
    step: float  # s


def wing_shapes(
    wing: WingArrays,
    angles: FloatArray,
    rates: FloatArray,
    elements: int,
    rounding: float,
    published: bool,
    singly: Sequence[int] = (),
) -> StackedShapes:
    """Shapes of the right wing for `angles` and `rates` (P, A), as `wing_shape` gives each.

    With them come their velocities per rate of each of the joints `singly`, and of all hinges.
    """
    hinges = range(wing.segment.size, wing.offset.size)
    moving = np.array([*singly, *hinges], dtype=np.int64)
    how = elements, rounding, published
    try:
        return _made(wing, angles, rates, elements, rounding, published or None, moving)
    except ZeroDivisionError:  # of one at least: the others have their shapes nevertheless
        return _made_singly(wing, angles, rates, how, moving)


def _made_singly(
    wing: WingArrays,
    angles: FloatArray,
    rates: FloatArray,
    how: tuple[int, float, bool],
    moving: IntArray,
) -> StackedShapes:
    """As `_made`; without velocities per rate, for such a wing has no use for them."""
    elements, rounding, published = how
    shapes = [
        wing_shape(wing, *of_one, elements=elements, rounding=rounding, published=published)
        for of_one in zip(angles, rates, strict=True)
    ]
    stacked = [np.array(arrays) for arrays in zip(*shapes, strict=True)]
    apart = np.full((len(shapes), moving.size, elements, 3), np.nan)
    return StackedShapes._make([*stacked, moving, rates[:, moving], apart])


@kernel
def _made(
    wing: WingArrays,
    angles: FloatArray,
    rates: FloatArray,
    elements: int,
    rounding: float,
    published: bool | None,
    moving: IntArray,
) -> StackedShapes:
    count, hinges = angles.shape[0], wing.offset.size - wing.segment.size
    stations = station_parameters(2 * elements)
    stack = StackedShapes(
        np.empty((count, 2 * elements, 3)),
        np.empty((count, elements, 3)),
        np.empty((count, elements, 3)),
        np.empty((count, elements, 3)),
        np.empty((count, elements, 3)),
        np.empty((count, elements)),
        np.empty((count, elements, 3)),
        np.empty((count, elements, wing.bone_length.size - 1)),
        np.empty(count, np.bool_),
        np.empty((count, hinges, elements, 6)),
        np.empty((count, elements, 3)),
        moving,
        rates[:, moving],
        np.empty((count, moving.size, elements, 3)),
    )
    for k in range(count):
        shape, per_rate = shape_of_edges(
            wing, angles[k], rates[k], stations, rounding, published, moving
        )
        stack.velocity_per_rate[k] = per_rate[:, :, :3]
        stack.line[k] = shape.line
        stack.velocity[k] = shape.velocity
        stack.chord_direction[k] = shape.chord_direction
        stack.normal[k] = shape.normal
        stack.span_direction[k] = shape.span_direction
        stack.chord[k] = shape.chord
        stack.profile[k] = shape.profile
        stack.distal_fraction[k] = shape.distal_fraction
        stack.converged[k] = shape.converged
        stack.hinge_twist[k] = shape.hinge_twist
        stack.chord_rate[k] = shape.chord_rate
    return stack


@kernel
def shape_at(stack: StackedShapes, k: int) -> WingShape:
    """The k-th shape, as views."""
    return WingShape(
        stack.line[k],
        stack.velocity[k],
        stack.chord_direction[k],
        stack.normal[k],
        stack.span_direction[k],
        stack.chord[k],
        stack.profile[k],
        stack.distal_fraction[k],
        stack.converged[k],
        stack.hinge_twist[k],
        stack.chord_rate[k],
    )


@kernel
def velocity_at(stack: StackedShapes, k: int, rates: FloatArray) -> FloatArray:
    """Velocity (N, 3) m/s of the k-th shape if the angles `singly` move at these of `rates` (A,).

    Exact, for velocities are linear in the rates.
    """
    # Written out: numba's copies of slices take longer than all that is done with them here.
    velocity = np.empty(stack.velocity.shape[1:])
    for e in range(len(velocity)):
        for i in range(3):
            velocity[e, i] = stack.velocity[k, e, i]
    for m in range(stack.singly.size):
        more = rates[stack.singly[m]] - stack.rates[k, m]
        if more != 0.0:
            for e in range(len(velocity)):
                for i in range(3):
                    velocity[e, i] += more * stack.velocity_per_rate[k, m, e, i]
    return velocity


def every_second_shape(stack: StackedShapes) -> StackedShapes:
    """The stack of every second shape, the first included."""
    halved = StackedShapes._make(array[::2].copy() for array in stack)
    return halved._replace(singly=stack.singly)
