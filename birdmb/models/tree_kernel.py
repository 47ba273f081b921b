"""Compiled inertia of the bird's tree: mass matrices and bias forces.

All is in body axes, the body's acceleration too: mass matrices depend on the joints' angles alone.
Coordinates are those of the body that move, along and about its axes, then the joints and hinges of
the right wing and of the left one. Where both wings move as mirror images the right one counts
twice, and each of its joints stands for the pair.

Vectors are tuples of numbers between the arrays that hold them from link to link: for so small ones
making arrays would take nearly all of the time.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import BoolArray, FloatArray, IntArray

_Vector: TypeAlias = tuple[float, float, float]
# A symmetric one: xx, yy, zz, xy, xz, yz.
_Tensor: TypeAlias = tuple[float, float, float, float, float, float]


class TreeLinks(NamedTuple):
    """Body and the wings' links, one for each of the L joints and hinges.

    A link turns about the z axis of its frame.
    """

    parent: IntArray  # (L,) link that carries this one, -1 the body
    offset: FloatArray  # (L, 3) m, joint in the parent's frame
    axes: FloatArray  # (L, 3, 3) frame of the joint, not yet turned, to the parent's
    mass: FloatArray  # (L,) kg
    centre: FloatArray  # (L, 3) m, centre of mass
    inertia: FloatArray  # (L, 3, 3) kg m2 about it
    weighs: BoolArray  # (L,) whether there is any mass or inertia
    copies: float  # of each link: 2 where both wings are mirror images and one is listed, else 1
    body_mass: float  # kg
    body_inertia: FloatArray  # (3, 3) kg m2
    directions: IntArray  # (B,) body coordinates among x, y, z and the turns about them


class PlacedLinks(NamedTuple):
    """The links at given angles, in body axes."""

    reach: FloatArray  # (L, 3) m, from the joint of the parent, or the body's centre of mass
    axis: FloatArray  # (L, 3) unit
    arm: FloatArray  # (L, 3) m, from joint to centre of mass
    inertia: FloatArray  # (L, 6) kg m2 about it, as a `_Tensor`


@kernel
def _row(table: FloatArray, i: int) -> _Vector:
    return table[i, 0], table[i, 1], table[i, 2]


@kernel
def _write(v: _Vector, table: FloatArray, i: int) -> None:
    table[i, 0], table[i, 1], table[i, 2] = v


@kernel
def _add(v: _Vector, table: FloatArray, i: int) -> None:
    table[i, 0] += v[0]
    table[i, 1] += v[1]
    table[i, 2] += v[2]


@kernel
def _unit(along: int) -> _Vector:
    return 1.0 if along == 0 else 0.0, 1.0 if along == 1 else 0.0, 1.0 if along == 2 else 0.0


@kernel
def _plus(a: _Vector, b: _Vector) -> _Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@kernel
def _scaled(factor: float, v: _Vector) -> _Vector:
    return factor * v[0], factor * v[1], factor * v[2]


@kernel
def _dot(a: _Vector, b: _Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def _cross(a: _Vector, b: _Vector) -> _Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@kernel
def _tensor(table: FloatArray, i: int) -> _Tensor:
    return table[i, 0], table[i, 1], table[i, 2], table[i, 3], table[i, 4], table[i, 5]


@kernel
def _times(tensor: _Tensor, v: _Vector) -> _Vector:
    xx, yy, zz, xy, xz, yz = tensor
    x, y, z = v
    return xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z


@kernel
def _symmetric(matrix: FloatArray) -> _Tensor:
    return matrix[0, 0], matrix[1, 1], matrix[2, 2], matrix[0, 1], matrix[0, 2], matrix[1, 2]


@kernel
def placed_links(links: TreeLinks, angles: FloatArray) -> PlacedLinks:
    """Place the links at `angles` (L,) rad."""
    n = angles.size
    frame, inertia = np.empty((n, 3, 3)), np.zeros((n, 6))
    reach, axis, arm = np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3))
    axes, offset, centre = links.axes, links.offset, links.centre
    for i in range(n):
        c, s, parent = np.cos(angles[i]), np.sin(angles[i]), links.parent[i]
        for k in range(3):
            x, y, z, reach[i, k] = axes[i, k, 0], axes[i, k, 1], axes[i, k, 2], offset[i, k]
            if parent >= 0:
                a, b, d = frame[parent, k, 0], frame[parent, k, 1], frame[parent, k, 2]
                x = a * axes[i, 0, 0] + b * axes[i, 1, 0] + d * axes[i, 2, 0]
                y = a * axes[i, 0, 1] + b * axes[i, 1, 1] + d * axes[i, 2, 1]
                z = a * axes[i, 0, 2] + b * axes[i, 1, 2] + d * axes[i, 2, 2]
                reach[i, k] = a * offset[i, 0] + b * offset[i, 1] + d * offset[i, 2]
            x, y = c * x + s * y, c * y - s * x
            frame[i, k, 0], frame[i, k, 1], frame[i, k, 2], axis[i, k] = x, y, z, z
            arm[i, k] = x * centre[i, 0] + y * centre[i, 1] + z * centre[i, 2]
        if links.weighs[i]:
            _turn(links.inertia, frame, i, inertia)
    return PlacedLinks(reach, axis, arm, inertia)


@kernel
def _turn(tensors: FloatArray, frames: FloatArray, i: int, out: FloatArray) -> None:
    """Write the i-th of the tensors (L, 3, 3) as seen where its frame (L, 3, 3) leads."""
    own = _symmetric(tensors[i])
    x = frames[i, 0, 0], frames[i, 0, 1], frames[i, 0, 2]
    y = frames[i, 1, 0], frames[i, 1, 1], frames[i, 1, 2]
    z = frames[i, 2, 0], frames[i, 2, 1], frames[i, 2, 2]
    by_x, by_y = _times(own, x), _times(own, y)
    out[i, 0], out[i, 1], out[i, 2] = _dot(x, by_x), _dot(y, by_y), _dot(z, _times(own, z))
    out[i, 3], out[i, 4], out[i, 5] = _dot(y, by_x), _dot(z, by_x), _dot(z, by_y)


@kernel
def mass_matrix(links: TreeLinks, placed: PlacedLinks) -> FloatArray:
    """Mass matrix (B + L, B + L) of body and wings."""
    n, body = links.parent.size, links.directions.size
    matrix = np.zeros((body + n, body + n))
    # Each link with all that it carries, about its joint; the last row, which parent -1 finds, is
    # the body. These composites give the matrix by the momenta that each coordinate's rate makes
    # (Featherstone, Rigid Body Dynamics Algorithms, 2008, section 6.2).
    mass, moment, inertia = np.zeros(n + 1), np.zeros((n + 1, 3)), np.zeros((n + 1, 6))
    mass[n] = links.body_mass
    of_body = _symmetric(links.body_inertia)
    for m in range(6):
        inertia[n, m] = of_body[m]
    momentum = np.empty(6)
    for i in range(n - 1, -1, -1):
        parent, axis, reach = links.parent[i], _row(placed.axis, i), _row(placed.reach, i)
        if links.weighs[i]:
            own = links.copies * links.mass[i]
            mass[i] += own
            _add(_scaled(own, _row(placed.arm, i)), moment, i)
            for m in range(6):
                inertia[i, m] += links.copies * placed.inertia[i, m]
            _add_moved(own, (0.0, 0.0, 0.0), _row(placed.arm, i), inertia, i)
        carried = _row(moment, i)
        linear, angular = _cross(axis, carried), _times(_tensor(inertia, i), axis)
        j = i
        while j >= 0:
            matrix[body + i, body + j] = matrix[body + j, body + i] = _dot(
                angular, _row(placed.axis, j)
            )
            angular = _plus(angular, _cross(_row(placed.reach, j), linear))
            j = links.parent[j]
        momentum[0], momentum[1], momentum[2] = linear
        momentum[3], momentum[4], momentum[5] = angular
        for b in range(body):
            matrix[b, body + i] = matrix[body + i, b] = momentum[links.directions[b]]
        mass[parent] += mass[i]
        _add(_plus(carried, _scaled(mass[i], reach)), moment, parent)
        for m in range(6):
            inertia[parent, m] += inertia[i, m]
        _add_moved(mass[i], carried, reach, inertia, parent)
    for b in range(body):
        unit = _unit(links.directions[b] % 3)
        linear, angular = _scaled(mass[n], unit), _cross(_row(moment, n), unit)
        if links.directions[b] >= 3:
            linear, angular = _cross(unit, _row(moment, n)), _times(_tensor(inertia, n), unit)
        momentum[0], momentum[1], momentum[2] = linear
        momentum[3], momentum[4], momentum[5] = angular
        for a in range(body):
            matrix[a, b] = momentum[links.directions[a]]
    return matrix


@kernel
def _add_moved(mass: float, moment: _Vector, reach: _Vector, inertia: FloatArray, row: int) -> None:
    """Add to a row what an inertia about one place has more about another one, `reach` before it.

    `moment` kg m is the first moment about the former.
    """
    x, y, z = reach
    a, b, c = _plus(moment, _scaled(0.5 * mass, reach))
    inertia[row, 0] += 2.0 * (b * y + c * z)
    inertia[row, 1] += 2.0 * (a * x + c * z)
    inertia[row, 2] += 2.0 * (a * x + b * y)
    inertia[row, 3] -= a * y + b * x
    inertia[row, 4] -= a * z + c * x
    inertia[row, 5] -= b * z + c * y


@kernel
def bias_forces(
    links: TreeLinks,
    placed: PlacedLinks,
    rates: FloatArray,
    spin_of_body: FloatArray,
    gravity: FloatArray,
) -> FloatArray:
    """Forces (B + L,) that inertia and gravity leave where no coordinate accelerates.

    On the side of the mass matrix. `rates` (L,) rad/s are those of the joints, `spin_of_body` (3,)
    rad/s the body's angular velocity, `gravity` (3,) m/s2 along its axes. The body's velocity does
    not matter, for its acceleration is that of space in its axes, not the change of u, v and w.
    """
    n, body = rates.size, links.directions.size
    # Of each link's joint. The last row is the body, which parent -1 finds.
    turning, change, acceleration = np.empty((n + 1, 3)), np.empty((n + 1, 3)), np.empty((n + 1, 3))
    force, moment = np.zeros((n + 1, 3)), np.zeros((n + 1, 3))
    spin = spin_of_body[0], spin_of_body[1], spin_of_body[2]
    # Gravity is an acceleration upwards.
    upwards = -gravity[0], -gravity[1], -gravity[2]
    _write(spin, turning, n)
    _write((0.0, 0.0, 0.0), change, n)
    _write(upwards, acceleration, n)
    _write(_scaled(links.body_mass, upwards), force, n)
    _write(_cross(spin, _times(_symmetric(links.body_inertia), spin)), moment, n)
    for i in range(n):
        parent = links.parent[i]
        spin, spin_change = _row(turning, parent), _row(change, parent)
        at_joint = _plus(
            _row(acceleration, parent), _swung(spin, spin_change, _row(placed.reach, i))
        )
        own = _scaled(rates[i], _row(placed.axis, i))
        spin, spin_change = _plus(spin, own), _plus(spin_change, _cross(spin, own))
        _write(spin, turning, i)
        _write(spin_change, change, i)
        _write(at_joint, acceleration, i)
        if not links.weighs[i]:
            continue
        arm, inertia = _row(placed.arm, i), _tensor(placed.inertia, i)
        of_centre = _plus(at_joint, _swung(spin, spin_change, arm))
        acting = _scaled(links.copies * links.mass[i], of_centre)
        twisting = _plus(_times(inertia, spin_change), _cross(spin, _times(inertia, spin)))
        _write(acting, force, i)
        _write(_plus(_scaled(links.copies, twisting), _cross(arm, acting)), moment, i)
    forces = np.empty(body + n)
    for i in range(n - 1, -1, -1):
        parent, acting, twisting = links.parent[i], _row(force, i), _row(moment, i)
        forces[body + i] = _dot(_row(placed.axis, i), twisting)
        _add(acting, force, parent)
        _add(_plus(twisting, _cross(_row(placed.reach, i), acting)), moment, parent)
    for b in range(body):
        along = links.directions[b]
        forces[b] = force[n, along] if along < 3 else moment[n, along - 3]
    return forces


@kernel
def _swung(spin: _Vector, change: _Vector, arm: _Vector) -> _Vector:
    """Acceleration of an arm's end relative to its beginning, of a spin that changes."""
    return _plus(_cross(change, arm), _cross(spin, _cross(spin, arm)))
