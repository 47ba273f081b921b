"""Apparent mass of the sections, and what turning adds to their loads (compiled kernels).

By thin-airfoil theory (Theodorsen, NACA Report 496, 1935; Garrick, NACA Report 567, 1936), per span
of a section of half chord b in air of density rho that turns nose up at the rate theta': with W the
normal velocity of the air at the mid-chord point, a force pi rho b^2 W' along the normal there, the
moment -pi rho b^3 U theta'/2 - pi rho b^4 theta''/8, nose up, U being the velocity of the air along
the chord, and the force pi rho b^3 theta'^2/2 towards the leading edge, by which suction there has
the strength that turning gives it. W' is the change of the component: it holds the section's
turning.

What is proportional to accelerations is an inertia and belongs in the mass matrix; the rest is a
force.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.elements import Elements
from birdmb.aerodynamics.section_motion import SectionMotion
from birdmb.wing.rotations import cross


class ApparentInertia(NamedTuple):
    """Inertias of the air about N elements: mass along `direction`, and moment about the span.

    An element that accelerates at a (6,), the acceleration of its control point and the angular
    acceleration, feels the wrench -mass (direction . a) direction, and -moment (e . a) e about the
    span e; all in body axes.
    """

    direction: FloatArray  # (N, 6) 1 and m, the acceleration of W with the opposite sign
    mass: FloatArray  # (N,) kg
    moment: FloatArray  # (N,) kg m2


@kernel
def apparent_inertia(elements: Elements, density: float) -> ApparentInertia:
    """Inertias of the air of a `density` (kg/m3) about the elements of a wing."""
    n = elements.chord.size
    direction = np.empty((n, 6))
    direction[:, :3] = elements.normal
    for e in range(n):
        direction[e, 3:] = -0.25 * elements.chord[e] * elements.span_direction[e]
    square = (0.5 * elements.chord) ** 2
    mass = np.pi * density * square * elements.width
    return ApparentInertia(direction, mass, 0.125 * mass * square)


@kernel
def inertia_matrix(elements: Elements, air: ApparentInertia, twists: FloatArray) -> FloatArray:
    """Mass matrix (C, C) of the air about one wing, of coordinates that move its elements.

    At the `twists` (C, N, 6) m and 1 of the control points per rate of each.
    """
    count, n, _ = twists.shape
    matrix = np.zeros((count, count))
    normal, turning = np.empty(count), np.empty(count)
    for e in range(n):
        for a in range(count):
            normal[a] = np.sum(air.direction[e] * twists[a, e])
            turning[a] = np.sum(elements.span_direction[e] * twists[a, e, 3:])
        for a in range(count):
            for b in range(count):
                matrix[a, b] += air.mass[e] * normal[a] * normal[b]
                matrix[a, b] += air.moment[e] * turning[a] * turning[b]
    return matrix


@kernel
def inertia_wrenches(
    elements: Elements, air: ApparentInertia, accelerations: FloatArray
) -> FloatArray:
    """Forces (N) and moments (N m) at the control points, (N, 6), that resist accelerations.

    `accelerations` (N, 6) m/s2 and rad/s2 are those of the control points, and of the turning.
    """
    loads = np.zeros(accelerations.shape)
    for e in range(elements.chord.size):
        span = elements.span_direction[e]
        normal = np.sum(air.direction[e] * accelerations[e])
        turning = np.sum(span * accelerations[e, 3:])
        loads[e] = -air.mass[e] * normal * air.direction[e]
        loads[e, 3:] -= air.moment[e] * turning * span
    return loads


@kernel
def body_twists(elements: Elements, directions: IntArray) -> FloatArray:
    """Twists (d, N, 6) of the control points per component of the body's twist, some of six."""
    n = elements.chord.size
    twists = np.zeros((directions.size, n, 6))
    for m in range(directions.size):
        component = directions[m]
        for e in range(n):
            if component < 3:
                twists[m, e, component] = 1.0
            else:
                # A unit vector times the place: two components are not zero.
                x, y, z = component - 3, (component - 2) % 3, (component - 1) % 3
                twists[m, e, 3 + x] = 1.0
                twists[m, e, y] = -elements.position[e, z]
                twists[m, e, z] = elements.position[e, y]
    return twists


@kernel
def _dot(a: FloatArray, b: FloatArray) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def apparent_wrenches(
    elements: Elements,
    motion: SectionMotion,
    air: ApparentInertia,
    twist: FloatArray,
    directions: IntArray,
) -> FloatArray:
    """Forces (N) and moments (N m) at the control points, (N, 6, 1 + d), without the inertia's.

    Of a body that moves with a `twist` (6,) through the air without acceleration in space, and of
    sections that move on it so. Derivatives are taken with respect to the components of the twist
    that `directions` (d,) lists.
    """
    n, columns = elements.chord.size, directions.size + 1
    loads = np.zeros((n, 6, columns))
    moves = np.zeros((columns, 6))
    moves[0] = twist
    for m in range(directions.size):
        moves[m + 1, directions[m]] = 1.0
    middle, passing, other = np.empty(3), np.empty(3), np.empty(3)
    velocity, spin = twist[:3], twist[3:]
    for e in range(n):
        chord, normal, span = (
            elements.chord_direction[e],
            elements.normal[e],
            elements.span_direction[e],
        )
        half = 0.5 * elements.chord[e]
        for i in range(3):
            middle[i] = elements.position[e, i] + 0.5 * half * chord[i]
        along = 0.0  # velocity of the air along the chord
        turning = 0.0
        for m in range(columns):
            dv, dw = moves[m, :3], moves[m, 3:]
            cross(dw, middle, passing)
            for i in range(3):
                passing[i] += dv[i] + (motion.middle_velocity[e, i] if m == 0 else 0.0)
            change = -_dot(motion.normal_rate[e], passing)
            d_along = -_dot(chord, passing)
            d_turning = _dot(span, dw) + (motion.pitch_rate[e] if m == 0 else 0.0)
            d_spinning = _dot(motion.span_rate[e], dw)
            cross(dw, motion.middle_velocity[e], other)
            change -= _dot(normal, other)
            cross(dw, velocity, other)
            change += _dot(normal, other)
            if m == 0:
                along, turning = d_along, d_turning
                change -= _dot(normal, motion.middle_acceleration[e])
                d_spinning += motion.pitch_acceleration[e]
                product, square = along * turning, turning * turning
            else:
                cross(spin, dv, other)
                change += _dot(normal, other)
                product = d_along * turning + along * d_turning
                square = 2.0 * turning * d_turning
            force = air.mass[e] * change
            suction = 0.5 * half * air.mass[e] * square
            moment = -0.5 * half * (force + air.mass[e] * product) - air.moment[e] * d_spinning
            for i in range(3):
                loads[e, i, m] = force * normal[i] - suction * chord[i]
                loads[e, 3 + i, m] = moment * span[i]
    return loads
