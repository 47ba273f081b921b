"""Lifting-line elements of a symmetric pair of wings and the velocities they induce.

Frame: body axes (x forward, y right, z down), origin at the body's centre of mass G. A wing is a
right one, or the mirror image of a left one. Where both wings have the same shape one is stored:
the other one's circulation is the same (even parity, as in symmetric flight) or the opposite one
(odd parity), and its influence is folded into the matrices. For wings of different shapes see
`birdmb.aerodynamics.pair`.

Each wing has N elements between N + 1 nodes. The first node lies on the centre line, beside the
shoulder: the element at the root spans the gap over the body with the root's chord and control
point. From every node a straight semi-infinite vortex leaves backwards along the body's x axis,
with the difference of the circulations on either side.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.wing.shape import WingShape

# Of the line's length: what round-off may do to a root that lies in the plane of symmetry, and to
# the width across the stream of an element that runs along it.
_ROUND_OFF = 1e-9
EVEN, ODD = 1.0, -1.0


class Elements(NamedTuple):
    """N elements of the right wing. Velocities are relative to the body."""

    position: FloatArray  # (N, 3) m, control points from G
    velocity: FloatArray  # (N, 3) m/s
    chord_direction: FloatArray  # (N, 3) towards the trailing edge
    normal: FloatArray  # (N, 3) up
    span_direction: FloatArray  # (N, 3) outwards
    chord: FloatArray  # (N,) m
    profile: FloatArray  # (N, 3) lift slope 1/rad, zero-lift angle rad, moment coefficient
    node: FloatArray  # (N + 1, 3) m, from the centre line to the wing tip
    width: FloatArray  # (N,) m, distance between the element's nodes
    induced_y: FloatArray  # (N, N) 1/m, velocity along y at control i by circulation j, even parity
    induced_z: FloatArray  # (N, N) 1/m


@kernel
def place_elements(shape: WingShape, root: FloatArray) -> Elements:
    """Elements of a shape in body axes hung up at `root` (3,) m from G."""
    n = shape.chord.size
    position, node, width = np.empty((n, 3)), np.empty((n + 1, 3)), np.empty(n)
    for e in range(n):
        for i in range(3):
            position[e, i] = shape.line[2 * e, i] + root[i]
            node[e + 1, i] = shape.line[2 * e + 1, i] + root[i]
    node[0, 0], node[0, 1], node[0, 2] = position[0, 0], 0.0, position[0, 2]
    for e in range(n):
        dx = node[e + 1, 0] - node[e, 0]
        dy = node[e + 1, 1] - node[e, 1]
        dz = node[e + 1, 2] - node[e, 2]
        width[e] = np.sqrt(dx * dx + dy * dy + dz * dz)
    induced_y, induced_z = wake_influence(position, node, EVEN)
    return Elements(
        position,
        shape.velocity,
        shape.chord_direction,
        shape.normal,
        shape.span_direction,
        shape.chord,
        shape.profile,
        node,
        width,
        induced_y,
        induced_z,
    )


@kernel
def clearance(elements: Elements) -> float:
    """Least distance (m) of the right wing's line from the plane of symmetry, negative across it.

    Across the plane the wake of one wing leaves inside the other, and no lifting line of both has
    a meaning. Zero, a root in the plane, is sound: its element spans both sides alike. NaN where an
    element has no width across the stream, so that its wake leaves in one line.
    """
    least = np.min(elements.position[:, 1])
    least = min(least, np.min(elements.node[1:, 1]))
    small = _ROUND_OFF * np.sum(elements.width)
    for e in range(elements.chord.size):
        dy = elements.node[e + 1, 1] - elements.node[e, 1]
        dz = elements.node[e + 1, 2] - elements.node[e, 2]
        if not dy * dy + dz * dz > (_ROUND_OFF * elements.width[e]) ** 2:
            return np.nan
    return 0.0 if abs(least) < small else least


@kernel
def wake_influence(
    position: FloatArray, node: FloatArray, parity: float
) -> tuple[FloatArray, FloatArray]:
    """Velocities along y and z, each (N, N) 1/m, at the controls per circulation of each element.

    The left wing's circulation is the right one's times the `parity`, 1 or -1.
    """
    n = position.shape[0]
    induced_y, induced_z = np.zeros((n, n)), np.zeros((n, n))
    # The first node lies on the centre line: where both circulations are equal it sheds none.
    first = 1 if parity > 0.0 else 0
    add_wake(position, node, first, 1.0, parity, induced_y, induced_z)
    return induced_y, induced_z


@kernel
def add_wake(
    position: FloatArray,
    node: FloatArray,
    first: int,
    own: float,
    image: float,
    induced_y: FloatArray,
    induced_z: FloatArray,
) -> None:
    """Add what the wake of a right wing and of its mirror image induce on a right wing.

    To velocities along y and z, each (N, N) 1/m, at `position` (N, 3) m by the circulation of each
    element between the nodes (N + 1, 3) m, those before the `first` shedding none. The wing has
    that circulation times `own`, the left wing that is its mirror image times `image`.

    A filament of strength G at distance r in the plane across its axis induces G/(4 pi r); the
    bound vortices' influence on each other is neglected, as published.
    """
    n = position.shape[0]
    node_y, node_z = node[:, 1].copy(), node[:, 2].copy()
    # Per unit strength backwards, that of the left wing's image being opposite if even.
    vy, vz = np.zeros(n + 1), np.zeros(n + 1)
    of_own, of_image = 0.25 / np.pi * own, 0.25 / np.pi * image
    for i in range(n):
        y, z = position[i, 1], position[i, 2]
        # From the first node in any case: a loop that may begin anywhere takes twice as long.
        for k in range(n + 1):
            ry, ry_mirror, rz = y - node_y[k], y + node_y[k], z - node_z[k]
            # Numpy's division makes NaN on a filament itself, where the line runs along the stream:
            # see `clearance`. Python's would look for zeros, and work at one node after another.
            near = np.divide(of_own, ry * ry + rz * rz)
            far = np.divide(of_image, ry_mirror * ry_mirror + rz * rz)
            vy[k] = rz * (near - far)
            vz[k] = ry_mirror * far - ry * near
        if y == node_y[0] == 0.0 and z == node_z[0]:
            # The filament of the centre line moves no air at itself.
            vy[0] = vz[0] = 0.0
        for k in range(first):
            vy[k] = vz[k] = 0.0
        # Each node sheds the circulation inboard of it minus the one outboard of it.
        for e in range(n):
            induced_y[i, e] += vy[e + 1] - vy[e]
            induced_z[i, e] += vz[e + 1] - vz[e]


@kernel
def circulation_system(elements: Elements) -> FloatArray:
    """Matrix (N, N) of the circulation's linear system of even parity; see `system_of`."""
    return system_of(elements, elements.induced_y, elements.induced_z)


@kernel
def system_of(elements: Elements, induced_y: FloatArray, induced_z: FloatArray) -> FloatArray:
    """Matrix (N, N) of the circulation's linear system, system @ Gamma = circulations without
    downwash.

    `induced_y` and `induced_z` (N, N) 1/m are the wake's influence, of either parity.
    """
    system = downwash_share(elements, induced_y, induced_z)
    for i in range(elements.chord.size):
        system[i, i] += 1.0
    return system


@kernel
def downwash_share(elements: Elements, induced_y: FloatArray, induced_z: FloatArray) -> FloatArray:
    """What the wake takes off each element's circulation (N, M), per circulation of M elements.

    `induced_y` and `induced_z` (N, M) 1/m are its influence. The downwash counts normal to the
    line's projection on the plane across the body's x axis.
    """
    n, m = induced_y.shape
    share = np.empty((n, m))
    for i in range(n):
        dy = elements.node[i + 1, 1] - elements.node[i, 1]
        dz = elements.node[i + 1, 2] - elements.node[i, 2]
        scale = 0.5 * elements.profile[i, 0] * elements.chord[i] / np.sqrt(dy * dy + dz * dz)
        for j in range(m):
            share[i, j] = scale * (induced_z[i, j] * dy - induced_y[i, j] * dz)
    return share
