"""Loads of the lifting line on a body that moves in space, with their derivatives by its twist.

A twist (6,) is the velocity u, v, w (m/s) of the centre of mass G along the body's axes and the
angular velocity p, q, r (rad/s) about them; a wrench (6,) the force (N) along and the moment (N m)
about the same axes. Derivatives are taken with respect to the components of the twist that
`directions` (d,) lists; arrays with a last axis of 1 + d hold a value and its derivatives.

A symmetric bird in any motion is one wing flown twice: the left wing meets the air as the right one
would in the mirrored motion, and mirroring changes the sign of v, p and r. Half the sum of both
wings' circulations obeys the even influence of the wake, half their difference the odd one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.circulation import ElementLoads, profile_drag, vortex_forces
from birdmb.aerodynamics.elements import (
    ODD,
    Elements,
    circulation_system,
    system_of,
    wake_influence,
)


class Flow(NamedTuple):
    """What the N elements of a wing meet, with derivatives."""

    wind: FloatArray  # (N, 3, 1 + d) m/s, velocity of the air relative to the element
    speed: FloatArray  # (N,) m/s, in the section's plane
    angle_of_attack: FloatArray  # (N,) rad, geometric (before the downwash)
    bound: FloatArray  # (N, 1 + d) m2/s, circulation without the downwash


@kernel
def mirror_sign(component: int) -> float:
    """Sign that mirroring in the plane of symmetry gives a component of a twist or a wrench."""
    return 1.0 if component in (0, 2, 4) else -1.0


@kernel
def mirrored(vector: FloatArray) -> FloatArray:
    """Mirror image (6,) of a twist or a wrench."""
    image = vector.copy()
    image[1], image[3], image[5] = -vector[1], -vector[3], -vector[5]
    return image


@kernel
def wing_flow(elements: Elements, twist: FloatArray, directions: IntArray) -> Flow:
    """Wind and circulation without downwash of the elements of the right wing."""
    n, columns = elements.chord.size, directions.size + 1
    wind, bound = np.empty((n, 3, columns)), np.empty((n, columns))
    speed, alpha = np.empty(n), np.empty(n)
    # The unit twists of the directions: a table costs less than choosing at each element.
    units = np.zeros((columns, 6))
    units[0] = twist
    for m in range(directions.size):
        units[m + 1, directions[m]] = 1.0
    for e in range(n):
        air, moving = wind[e], elements.velocity[e]
        x, y, z = elements.position[e, 0], elements.position[e, 1], elements.position[e, 2]
        for m in range(columns):
            air[0, m] = -units[m, 0] - units[m, 4] * z + units[m, 5] * y
            air[1, m] = -units[m, 1] - units[m, 5] * x + units[m, 3] * z
            air[2, m] = -units[m, 2] - units[m, 3] * y + units[m, 4] * x
        for i in range(3):
            air[i, 0] -= moving[i]
        c, up, t = elements.chord_direction[e], elements.normal[e], elements.span_direction[e]
        along = air[0, 0] * t[0] + air[1, 0] * t[1] + air[2, 0] * t[2]
        px, py, pz = air[0, 0] - along * t[0], air[1, 0] - along * t[1], air[2, 0] - along * t[2]
        rising = px * up[0] + py * up[1] + pz * up[2]
        back = px * c[0] + py * c[1] + pz * c[2]
        speed[e] = np.sqrt(px * px + py * py + pz * pz)
        alpha[e] = np.arctan2(rising, back)
        factor = np.pi * elements.chord[e]
        bound[e, 0] = factor * speed[e] * alpha[e]
        square = rising * rising + back * back
        for m in range(1, columns):
            dx, dy, dz = air[0, m], air[1, m], air[2, m]
            d_along = dx * t[0] + dy * t[1] + dz * t[2]
            gx, gy, gz = dx - d_along * t[0], dy - d_along * t[1], dz - d_along * t[2]
            d_speed = (px * gx + py * gy + pz * gz) / speed[e]
            d_rising = gx * up[0] + gy * up[1] + gz * up[2]
            d_back = gx * c[0] + gy * c[1] + gz * c[2]
            d_alpha = (back * d_rising - rising * d_back) / square
            bound[e, m] = factor * (d_speed * alpha[e] + speed[e] * d_alpha)
    return Flow(wind, speed, alpha, bound)


@kernel
def mirrored_flow(elements: Elements, twist: FloatArray, directions: IntArray) -> Flow:
    """What the left wing meets, mirrored onto the right one; derivatives by the twist itself."""
    flow = wing_flow(elements, mirrored(twist), directions)
    for m in range(directions.size):
        sign = mirror_sign(directions[m])
        flow.wind[:, :, m + 1] *= sign
        flow.bound[:, m + 1] *= sign
    return flow


@kernel
def wing_wrench(
    elements: Elements,
    flow: Flow,
    circulation: FloatArray,
    induced_y: FloatArray,
    induced_z: FloatArray,
    density: float,
    profile: float,
) -> FloatArray:
    """Wrench (6, 1 + d) of one wing by lift and profile drag.

    `circulation` (N, 1 + d) m2/s, `induced_y` and `induced_z` (N, 1 + d) m/s the velocities that
    the wake induces. Lift acts on the wind with, profile drag on that without these.
    """
    n, columns = circulation.shape
    total = np.zeros((6, columns))
    for e in range(n):
        air, t, r = flow.wind[e], elements.span_direction[e], elements.position[e]
        gamma = circulation[e, 0]
        ax, ay, az = air[0, 0], air[1, 0], air[2, 0]
        y, z = ay + induced_y[e, 0], az + induced_z[e, 0]
        scale = density * elements.width[e]
        relative = np.sqrt(ax * ax + ay * ay + az * az)
        drag = 0.5 * profile * elements.chord[e]
        for m in range(columns):
            if m == 0:
                fx = gamma * (y * t[2] - z * t[1]) + drag * relative * ax
                fy = gamma * (z * t[0] - ax * t[2]) + drag * relative * ay
                fz = gamma * (ax * t[1] - y * t[0]) + drag * relative * az
            else:
                wx, wy, wz = air[0, m], air[1, m], air[2, m]
                dy, dz = wy + induced_y[e, m], wz + induced_z[e, m]
                g = circulation[e, m]
                fx = g * (y * t[2] - z * t[1]) + gamma * (dy * t[2] - dz * t[1])
                fy = g * (z * t[0] - ax * t[2]) + gamma * (dz * t[0] - wx * t[2])
                fz = g * (ax * t[1] - y * t[0]) + gamma * (wx * t[1] - dy * t[0])
                slope = (ax * wx + ay * wy + az * wz) / relative
                fx += drag * (slope * ax + relative * wx)
                fy += drag * (slope * ay + relative * wy)
                fz += drag * (slope * az + relative * wz)
            total[0, m] += scale * fx
            total[1, m] += scale * fy
            total[2, m] += scale * fz
            total[3, m] += scale * (r[1] * fz - r[2] * fy)
            total[4, m] += scale * (r[2] * fx - r[0] * fz)
            total[5, m] += scale * (r[0] * fy - r[1] * fx)
    return total


@kernel
def loads_of_both(
    elements: Elements, density: float, profile: float, twist: FloatArray
) -> tuple[ElementLoads, ElementLoads]:
    """Loads of the elements of the right wing, and of the left one mirrored onto it."""
    no_derivatives = np.empty(0, np.int64)
    n = elements.chord.size
    right = wing_flow(elements, twist, no_derivatives)
    left = mirrored_flow(elements, twist, no_derivatives)
    by_odd_y, by_odd_z = wake_influence(elements.position, elements.node, ODD)
    even, odd = np.full(n, np.nan), np.full(n, np.nan)
    # The solver refuses what is not finite.
    if np.isfinite(np.sum(right.bound) + np.sum(left.bound)):
        even = np.linalg.solve(
            circulation_system(elements), 0.5 * (right.bound[:, 0] + left.bound[:, 0])
        )
        odd = np.linalg.solve(
            system_of(elements, by_odd_y, by_odd_z), 0.5 * (right.bound[:, 0] - left.bound[:, 0])
        )
    even_y, even_z = elements.induced_y @ even, elements.induced_z @ even
    odd_y, odd_z = by_odd_y @ odd, by_odd_z @ odd
    return (
        _loads_in(elements, density, profile, right, even + odd, even_y + odd_y, even_z + odd_z),
        _loads_in(elements, density, profile, left, even - odd, even_y - odd_y, even_z - odd_z),
    )


@kernel
def _loads_in(
    elements: Elements,
    density: float,
    profile: float,
    flow: Flow,
    circulation: FloatArray,
    induced_y: FloatArray,
    induced_z: FloatArray,
) -> ElementLoads:
    wind = flow.wind[:, :, 0].copy()
    drag = profile_drag(elements, density, profile, wind)
    lift = vortex_forces(elements, density, wind, circulation, induced_y, induced_z)
    return ElementLoads(circulation, flow.angle_of_attack, flow.speed, lift + drag, drag)
