"""Compiled inertia of the bird's tree: mass matrices and bias forces.

All is in body axes, the body's acceleration too: mass matrices depend on the joints' angles alone.
Coordinates are those of the body that move, along and about its axes, then the joints and hinges of
the right wing and of the left one. Where both wings move as mirror images the right one counts
twice, and each of its joints stands for the pair.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import BoolArray, FloatArray, IntArray


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
    copies: float  # of each link: 2 where both wings are mirror images and one is listed, else 1
    body_mass: float  # kg
    body_inertia: FloatArray  # (3, 3) kg m2
    directions: IntArray  # (B,) body coordinates among x, y, z and the turns about them


class PlacedLinks(NamedTuple):
    """The links at given angles, in body axes."""

    joint: FloatArray  # (L, 3) m, from the body's centre of mass
    axis: FloatArray  # (L, 3) unit
    arm: FloatArray  # (L, 3) m, from joint to centre of mass
    inertia: FloatArray  # (L, 3, 3)
    velocity: FloatArray  # (L, B + L, 3) of each centre of mass per rate of each coordinate
    spin: FloatArray  # (L, B + L, 3) likewise of each link's turning
    weighs: BoolArray  # (L,) whether the link has inertia


@kernel
def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    out = np.empty(3)
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]
    return out


@kernel
def _times(matrix: FloatArray, v: FloatArray) -> FloatArray:
    out = np.empty(3)
    for i in range(3):
        out[i] = matrix[i, 0] * v[0] + matrix[i, 1] * v[1] + matrix[i, 2] * v[2]
    return out


@kernel
def _product(a: FloatArray, b: FloatArray) -> FloatArray:
    out = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            out[i, j] = a[i, 0] * b[0, j] + a[i, 1] * b[1, j] + a[i, 2] * b[2, j]
    return out


@kernel
def _dot(a: FloatArray, b: FloatArray) -> float:
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


@kernel
def placed_links(links: TreeLinks, angles: FloatArray) -> PlacedLinks:
    """Place the links at `angles` (L,) rad."""
    n, body = angles.size, links.directions.size
    frame = np.empty((n, 3, 3))
    joint, axis, arm = np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3))
    inertia = np.empty((n, 3, 3))
    velocity, spin = np.zeros((n, body + n, 3)), np.zeros((n, body + n, 3))
    weighs = np.empty(n, np.bool_)
    turn = np.zeros((3, 3))
    turn[2, 2] = 1.0
    for i in range(n):
        c, s = np.cos(angles[i]), np.sin(angles[i])
        turn[0, 0], turn[0, 1], turn[1, 0], turn[1, 1] = c, -s, s, c
        own = _product(links.axes[i], turn)
        parent = links.parent[i]
        if parent < 0:
            frame[i], joint[i] = own, links.offset[i]
        else:
            frame[i] = _product(frame[parent], own)
            joint[i] = joint[parent] + _times(frame[parent], links.offset[i])
        axis[i] = frame[i, :, 2]
        arm[i] = _times(frame[i], links.centre[i])
        inertia[i] = _product(_product(frame[i], links.inertia[i]), frame[i].T)
        weighs[i] = links.mass[i] > 0.0 or np.any(links.inertia[i] != 0.0)
        centre = joint[i] + arm[i]
        for b in range(body):
            along = links.directions[b]
            if along < 3:
                velocity[i, b, along] = 1.0
            else:
                # A unit vector times the centre's place: two components are not zero.
                x, y, z = along - 3, (along - 2) % 3, (along - 1) % 3
                spin[i, b, x] = 1.0
                velocity[i, b, y], velocity[i, b, z] = -centre[z], centre[y]
        j = i
        while j >= 0:
            velocity[i, body + j] = _cross(axis[j], centre - joint[j])
            spin[i, body + j] = axis[j]
            j = links.parent[j]
    return PlacedLinks(joint, axis, arm, inertia, velocity, spin, weighs)


@kernel
def mass_matrix(links: TreeLinks, placed: PlacedLinks) -> FloatArray:
    """Mass matrix (B + L, B + L) of body and wings."""
    n, body = placed.joint.shape[0], links.directions.size
    matrix = np.zeros((body + n, body + n))
    _add_body(links, matrix)
    moves = np.empty(body + n, np.bool_)
    for i in range(n):
        if not placed.weighs[i]:
            continue
        moves[:body], moves[body:] = True, False
        j = i
        while j >= 0:
            moves[body + j] = True
            j = links.parent[j]
        for a in range(body + n):
            if not moves[a]:
                continue
            momentum = links.copies * links.mass[i] * placed.velocity[i, a]
            turning = links.copies * _times(placed.inertia[i], placed.spin[i, a])
            for b in range(a + 1):
                if moves[b]:
                    part = _dot(momentum, placed.velocity[i, b]) + _dot(turning, placed.spin[i, b])
                    matrix[a, b] += part
    for a in range(body + n):
        for b in range(a):
            matrix[b, a] = matrix[a, b]
    return matrix


@kernel
def _add_body(links: TreeLinks, matrix: FloatArray) -> None:
    for a in range(links.directions.size):
        for b in range(a + 1):
            i, j = links.directions[a], links.directions[b]
            if i >= 3 and j >= 3:
                matrix[a, b] = links.body_inertia[i - 3, j - 3]
            elif i == j:
                matrix[a, b] = links.body_mass


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
    turning, change = np.zeros((n + 1, 3)), np.zeros((n + 1, 3))
    acceleration = np.zeros((n + 1, 3))
    # The last row is the body, which parent -1 finds. Gravity is an acceleration upwards.
    turning[n] = spin_of_body
    acceleration[n] = -gravity
    forces = np.zeros(body + n)
    gyroscopic = _cross(spin_of_body, _times(links.body_inertia, spin_of_body))
    for a in range(body):
        along = links.directions[a]
        if along < 3:
            forces[a] = -links.body_mass * gravity[along]
        else:
            forces[a] = gyroscopic[along - 3]
    for i in range(n):
        parent = links.parent[i]
        spin, spin_change = turning[parent], change[parent]
        reach = placed.joint[i] - placed.joint[parent] if parent >= 0 else placed.joint[i]
        acceleration[i] = (
            acceleration[parent] + _cross(spin_change, reach) + _cross(spin, _cross(spin, reach))
        )
        own = rates[i] * placed.axis[i]
        turning[i] = spin + own
        change[i] = spin_change + _cross(spin, own)
        if not placed.weighs[i]:
            continue
        spin = turning[i]
        of_centre = (
            acceleration[i]
            + _cross(change[i], placed.arm[i])
            + _cross(spin, _cross(spin, placed.arm[i]))
        )
        force = links.copies * links.mass[i] * of_centre
        moment = links.copies * (
            _times(placed.inertia[i], change[i]) + _cross(spin, _times(placed.inertia[i], spin))
        )
        for a in range(body):
            forces[a] += _dot(placed.velocity[i, a], force) + _dot(placed.spin[i, a], moment)
        j = i
        while j >= 0:
            a = body + j
            forces[a] += _dot(placed.velocity[i, a], force) + _dot(placed.spin[i, a], moment)
            j = links.parent[j]
    return forces
