"""Quasi-steady loads of the lifting line on a body that moves in space, and their derivatives.

With U the wind that an element meets, its component along the span removed, and alpha its angle
to the chord, thin-airfoil theory and the downwash w of the wake give

    Gamma = 1/2 c 2 pi (|U| alpha - w),   w linear in Gamma,

which is one linear system. Each element then feels rho Gamma (U_total x e_t) dl, U_total with the
induced velocity, and the profile drag 1/2 rho C_d c dl |U| U of the whole wind U without it.
Everything is in body axes, moments are about the body's centre of mass G.

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
from birdmb.aerodynamics.elements import Elements


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
def element_forces(
    elements: Elements,
    wind: FloatArray,
    circulation: FloatArray,
    induced_y: FloatArray,
    induced_z: FloatArray,
    density: float,
    profile: float,
) -> FloatArray:
    """Forces (N, 3, 1 + d) N of lift and profile drag on the elements of one wing.

    `wind` (N, 3, 1 + d) m/s is the velocity of the air relative to them, `circulation` (N, 1 + d)
    m2/s, `induced_y` and `induced_z` (N, 1 + d) m/s the velocities that the wake induces. Lift acts
    on the wind with, profile drag on that without these.
    """
    n, columns = circulation.shape
    forces = np.empty((n, 3, columns))
    for e in range(n):
        air, t, force = wind[e], elements.span_direction[e], forces[e]
        gamma = circulation[e, 0]
        ax, ay, az = air[0, 0], air[1, 0], air[2, 0]
        y, z = ay + induced_y[e, 0], az + induced_z[e, 0]
        scale = density * elements.width[e]
        relative = np.sqrt(ax * ax + ay * ay + az * az)
        drag = 0.5 * profile * elements.chord[e]
        force[0, 0] = scale * (gamma * (y * t[2] - z * t[1]) + drag * relative * ax)
        force[1, 0] = scale * (gamma * (z * t[0] - ax * t[2]) + drag * relative * ay)
        force[2, 0] = scale * (gamma * (ax * t[1] - y * t[0]) + drag * relative * az)
        for m in range(1, columns):
            wx, wy, wz = air[0, m], air[1, m], air[2, m]
            dy, dz = wy + induced_y[e, m], wz + induced_z[e, m]
            g = circulation[e, m]
            fx = g * (y * t[2] - z * t[1]) + gamma * (dy * t[2] - dz * t[1])
            fy = g * (z * t[0] - ax * t[2]) + gamma * (dz * t[0] - wx * t[2])
            fz = g * (ax * t[1] - y * t[0]) + gamma * (wx * t[1] - dy * t[0])
            slope = (ax * wx + ay * wy + az * wz) / relative
            force[0, m] = scale * (fx + drag * (slope * ax + relative * wx))
            force[1, m] = scale * (fy + drag * (slope * ay + relative * wy))
            force[2, m] = scale * (fz + drag * (slope * az + relative * wz))
    return forces


@kernel
def wing_wrench(elements: Elements, forces: FloatArray) -> FloatArray:
    """Wrench (6, 1 + d) about G of `forces` (N, 3, 1 + d) N on the elements of one wing."""
    n, _, columns = forces.shape
    total = np.zeros((6, columns))
    for e in range(n):
        x, y, z = elements.position[e, 0], elements.position[e, 1], elements.position[e, 2]
        force = forces[e]
        for m in range(columns):
            fx, fy, fz = force[0, m], force[1, m], force[2, m]
            total[0, m] += fx
            total[1, m] += fy
            total[2, m] += fz
            total[3, m] += y * fz - z * fy
            total[4, m] += z * fx - x * fz
            total[5, m] += x * fy - y * fx
    return total
