"""Shapes of the wing at many instants, stacked for compiled loops."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import BoolArray, FloatArray
from birdmb.wing.shape import WingShape


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
