"""Compiled inertia of the bird's tree in symmetric flight: mass matrices and bias forces.

Both wings move alike, so the right one counts twice and each of its joints stands for the pair. All
is in body axes, the body's acceleration too: mass matrices depend on the joints' angles alone.
Coordinates are x, z and pitch of the body, then the joints and hinges of the right wing.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import BoolArray, FloatArray, IntArray

BODY = 3


class TreeLinks(NamedTuple):
    """Body and links of the right wing, one for each of the A joints and hinges.

    A link turns about the z axis of its frame.
    """

    parent: IntArray  # (A,) link that carries this one, -1 the body
    offset: FloatArray  # (A, 3) m, joint in the parent's frame
    axes: FloatArray  # (A, 3, 3) frame of the joint, not yet turned, to the parent's
    mass: FloatArray  # (A,) kg
    centre: FloatArray  # (A, 3) m, centre of mass
    inertia: FloatArray  # (A, 3, 3) kg m2 about it
    body_mass: float  # kg
    body_inertia: float  # kg m2, in pitch
    gravity: float  # m/s2


class PlacedLinks(NamedTuple):
    """The links at given angles, in body axes."""

    joint: FloatArray  # (A, 3) m, from the body's centre of mass
    axis: FloatArray  # (A, 3) unit
    arm: FloatArray  # (A, 3) m, from joint to centre of mass
    inertia: FloatArray  # (A, 3, 3)
    velocity: FloatArray  # (A, 3 + A, 3) of each centre of mass per rate of each coordinate
    spin: FloatArray  # (A, 3 + A, 3) likewise of each link's turning
    weighs: BoolArray  # (A,) whether the link has inertia


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
    """Place the links at `angles` (A,) rad."""
    n = angles.size
    frame = np.empty((n, 3, 3))
    joint, axis, arm = np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3))
    inertia = np.empty((n, 3, 3))
    velocity, spin = np.zeros((n, BODY + n, 3)), np.zeros((n, BODY + n, 3))
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
        velocity[i, 0, 0] = velocity[i, 1, 2] = 1.0
        velocity[i, 2, 0], velocity[i, 2, 2] = centre[2], -centre[0]
        spin[i, 2, 1] = 1.0
        j = i
        while j >= 0:
            velocity[i, BODY + j] = _cross(axis[j], centre - joint[j])
            spin[i, BODY + j] = axis[j]
            j = links.parent[j]
    return PlacedLinks(joint, axis, arm, inertia, velocity, spin, weighs)


@kernel
def mass_matrix(links: TreeLinks, placed: PlacedLinks) -> FloatArray:
    """Mass matrix (3 + A, 3 + A) of body and both wings."""
    n = placed.joint.shape[0]
    matrix = np.zeros((BODY + n, BODY + n))
    matrix[0, 0] = matrix[1, 1] = links.body_mass
    matrix[2, 2] = links.body_inertia
    moves = np.empty(BODY + n, np.bool_)
    for i in range(n):
        if not placed.weighs[i]:
            continue
        moves[:BODY], moves[BODY:] = True, False
        j = i
        while j >= 0:
            moves[BODY + j] = True
            j = links.parent[j]
        for a in range(BODY + n):
            if not moves[a]:
                continue
            momentum = 2.0 * links.mass[i] * placed.velocity[i, a]
            turning = 2.0 * _times(placed.inertia[i], placed.spin[i, a])
            for b in range(a + 1):
                if moves[b]:
                    part = _dot(momentum, placed.velocity[i, b]) + _dot(turning, placed.spin[i, b])
                    matrix[a, b] += part
    for a in range(BODY + n):
        for b in range(a):
            matrix[b, a] = matrix[a, b]
    return matrix


@kernel
def bias_forces(
    links: TreeLinks, placed: PlacedLinks, rates: FloatArray, pitch_rate: float, theta: float
) -> FloatArray:
    """Forces (3 + A,) that inertia and gravity leave where no coordinate accelerates.

    On the side of the mass matrix. `rates` (A,) rad/s are those of the joints; the body's velocity
    does not matter, for its acceleration is that of space in its axes, not the change of u and w.
    """
    n = rates.size
    turning, change = np.zeros((n + 1, 3)), np.zeros((n + 1, 3))
    acceleration = np.zeros((n + 1, 3))
    # The last row is the body, which parent -1 finds. Gravity is an acceleration upwards.
    turning[n, 1] = pitch_rate
    acceleration[n, 0] = links.gravity * np.sin(theta)
    acceleration[n, 2] = -links.gravity * np.cos(theta)
    forces = np.zeros(BODY + n)
    forces[0] = links.body_mass * acceleration[n, 0]
    forces[1] = links.body_mass * acceleration[n, 2]
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
        force = 2.0 * links.mass[i] * of_centre
        moment = 2.0 * (
            _times(placed.inertia[i], change[i]) + _cross(spin, _times(placed.inertia[i], spin))
        )
        for a in range(BODY):
            forces[a] += _dot(placed.velocity[i, a], force) + _dot(placed.spin[i, a], moment)
        j = i
        while j >= 0:
            a = BODY + j
            forces[a] += _dot(placed.velocity[i, a], force) + _dot(placed.spin[i, a], moment)
            j = links.parent[j]
    return forces
