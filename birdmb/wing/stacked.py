"""Shapes of the wing at many instants, stacked for compiled loops."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import BoolArray, FloatArray
from birdmb.wing.arrays import WingArrays
from birdmb.wing.shape import WingShape, shape_of_edges, wing_shape


class StackedShapes(NamedTuple):
    """The arrays of P `WingShape`s, each stacked along a first axis."""

    line: FloatArray  # (P, 2 N, 3)
    velocity: FloatArray  # (P, N, 3)
    chord_direction: FloatArray  # (P, N, 3)
    normal: FloatArray  # (P, N, 3)
    span_direction: FloatArray  # (P, N, 3)
    chord: FloatArray  # (P, N)
    beyond: FloatArray  # (P, N, 2)
    converged: BoolArray  # (P,)
    hinge_velocity: FloatArray  # (P, H, N, 3)


def stacked_shapes(shapes: Sequence[WingShape]) -> StackedShapes:
    """Shapes as one."""
    return StackedShapes(*(np.array(arrays) for arrays in zip(*shapes, strict=True)))


def wing_shapes(
    wing: WingArrays,
    angles: FloatArray,
    rates: FloatArray,
    elements: int,
    rounding: float,
    published: bool,
) -> StackedShapes:
    """Shapes of the right wing for `angles` and `rates` (P, A), as `wing_shape` gives each."""
    try:
        return _made(wing, angles, rates, elements, rounding, published)
    except ZeroDivisionError:  # of one at least: the others have their shapes nevertheless
        shapes = [
            wing_shape(wing, *moving, elements=elements, rounding=rounding, published=published)
            for moving in zip(angles, rates, strict=True)
        ]
        return stacked_shapes(shapes)


@kernel
def _made(
    wing: WingArrays,
    angles: FloatArray,
    rates: FloatArray,
    elements: int,
    rounding: float,
    published: bool,
) -> StackedShapes:
    count, hinges = angles.shape[0], wing.offset.size - wing.segment.size
    stack = StackedShapes(
        np.empty((count, 2 * elements, 3)),
        np.empty((count, elements, 3)),
        np.empty((count, elements, 3)),
        np.empty((count, elements, 3)),
        np.empty((count, elements, 3)),
        np.empty((count, elements)),
        np.empty((count, elements, 2)),
        np.empty(count, np.bool_),
        np.empty((count, hinges, elements, 3)),
    )
    for k in range(count):
        shape = shape_of_edges(wing, angles[k], rates[k], elements, rounding, published)
        stack.line[k] = shape.line
        stack.velocity[k] = shape.velocity
        stack.chord_direction[k] = shape.chord_direction
        stack.normal[k] = shape.normal
        stack.span_direction[k] = shape.span_direction
        stack.chord[k] = shape.chord
        stack.beyond[k] = shape.beyond
        stack.converged[k] = shape.converged
        stack.hinge_velocity[k] = shape.hinge_velocity
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
        stack.beyond[k],
        stack.converged[k],
        stack.hinge_velocity[k],
    )
