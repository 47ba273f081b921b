"""Quasi-steady loads of the lifting line on a body that moves in space, and their derivatives.

With U the wind that an element meets, its component along the span removed, and alpha its angle
to the chord, the profile's lift slope a and zero-lift angle alpha_0 (2 pi and 0 by thin-airfoil
theory) and the downwash w of the wake give

    Gamma = 1/2 c a (|U| (alpha - alpha_0) - w),   w linear in Gamma,

which is one linear system. Each element then feels rho Gamma (U_total x e_t) dl, U_total with the
induced velocity, the profile drag 1/2 rho C_d c dl |U| U of the whole wind U without it, and the
moment 1/2 rho C_m c^2 dl |U|^2 about the span e_t, nose up, by the wind in the section's plane.
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
def wing_flow(
    elements: Elements, velocity: FloatArray, twist: FloatArray, directions: IntArray
) -> Flow:
    """Wind and circulation without downwash of the elements of the right wing.

    They move at `velocity` (N, 3) m/s relative to the body.
    """
    n, columns = elements.chord.size, directions.size + 1
    wind, bound = np.empty((n, 3, columns)), np.empty((n, columns))
    speed, alpha = np.empty(n), np.empty(n)
    # The unit twists of the directions: a table costs less than choosing at each element.
    units = np.zeros((columns, 6))
    units[0] = twist
    for m in range(directions.size):
        units[m + 1, directions[m]] = 1.0
    # Numbers instead of views of the arrays' rows: making these would take half of the time.
    chord_direction, normal, span = (
        elements.chord_direction,
        elements.normal,
        elements.span_direction,
    )
    position, chord, profile = elements.position, elements.chord, elements.profile
    for e in range(n):
        x, y, z = position[e, 0], position[e, 1], position[e, 2]
        cx, cy, cz = chord_direction[e, 0], chord_direction[e, 1], chord_direction[e, 2]
        nx, ny, nz = normal[e, 0], normal[e, 1], normal[e, 2]
        tx, ty, tz = span[e, 0], span[e, 1], span[e, 2]
        for m in range(columns):
            wind[e, 0, m] = -units[m, 0] - units[m, 4] * z + units[m, 5] * y
            wind[e, 1, m] = -units[m, 1] - units[m, 5] * x + units[m, 3] * z
            wind[e, 2, m] = -units[m, 2] - units[m, 3] * y + units[m, 4] * x
        for i in range(3):
            wind[e, i, 0] -= velocity[e, i]
        ax, ay, az = wind[e, 0, 0], wind[e, 1, 0], wind[e, 2, 0]
        along = ax * tx + ay * ty + az * tz
        px, py, pz = ax - along * tx, ay - along * ty, az - along * tz
        rising = px * nx + py * ny + pz * nz
        back = px * cx + py * cy + pz * cz
        speed[e] = np.sqrt(px * px + py * py + pz * pz)
        alpha[e] = np.arctan2(rising, back)
        factor = 0.5 * profile[e, 0] * chord[e]
        lifting = alpha[e] - profile[e, 1]
        bound[e, 0] = factor * speed[e] * lifting
        square = rising * rising + back * back
        for m in range(1, columns):
            dx, dy, dz = wind[e, 0, m], wind[e, 1, m], wind[e, 2, m]
            d_along = dx * tx + dy * ty + dz * tz
            gx, gy, gz = dx - d_along * tx, dy - d_along * ty, dz - d_along * tz
            d_speed = (px * gx + py * gy + pz * gz) / speed[e]
            d_rising = gx * nx + gy * ny + gz * nz
            d_back = gx * cx + gy * cy + gz * cz
            d_alpha = (back * d_rising - rising * d_back) / square
            bound[e, m] = factor * (d_speed * lifting + speed[e] * d_alpha)
    return Flow(wind, speed, alpha, bound)


@kernel
def mirrored_flow(elements: Elements, twist: FloatArray, directions: IntArray) -> Flow:
    """What the left wing meets, mirrored onto the right one; derivatives by the twist itself."""
    flow = wing_flow(elements, elements.velocity, mirrored(twist), directions)
    for m in range(directions.size):
        sign = mirror_sign(directions[m])
        flow.wind[:, :, m + 1] *= sign
        flow.bound[:, m + 1] *= sign
    return flow


@kernel
def element_wrenches(
    elements: Elements,
    wind: FloatArray,
    circulation: FloatArray,
    induced_y: FloatArray,
    induced_z: FloatArray,
    density: float,
    profile_drag: float,
) -> FloatArray:
    """Forces (N) and moments (N m) of the air, (N, 6, 1 + d), on the elements of one wing.

    Lift and profile drag at the control points, and the moment of the profile. `wind` (N, 3, 1 + d)
    m/s is the velocity of the air relative to them, `circulation` (N, 1 + d) m2/s, `induced_y` and
    `induced_z` (N, 1 + d) m/s the velocities that the wake induces. Lift acts on the wind with,
    drag and moment on that without these.
    """
    n, columns = circulation.shape
    loads = np.empty((n, 6, columns))
    span, width, chord = elements.span_direction, elements.width, elements.chord
    for e in range(n):
        tx, ty, tz = span[e, 0], span[e, 1], span[e, 2]
        gamma = circulation[e, 0]
        ax, ay, az = wind[e, 0, 0], wind[e, 1, 0], wind[e, 2, 0]
        y, z = ay + induced_y[e, 0], az + induced_z[e, 0]
        scale = density * width[e]
        relative = np.sqrt(ax * ax + ay * ay + az * az)
        drag = 0.5 * profile_drag * chord[e]
        pitching = 0.5 * scale * elements.profile[e, 2] * chord[e] * chord[e]
        along = ax * tx + ay * ty + az * tz
        moment = pitching * (relative * relative - along * along)
        loads[e, 0, 0] = scale * (gamma * (y * tz - z * ty) + drag * relative * ax)
        loads[e, 1, 0] = scale * (gamma * (z * tx - ax * tz) + drag * relative * ay)
        loads[e, 2, 0] = scale * (gamma * (ax * ty - y * tx) + drag * relative * az)
        loads[e, 3, 0], loads[e, 4, 0], loads[e, 5, 0] = moment * tx, moment * ty, moment * tz
        for m in range(1, columns):
            wx, wy, wz = wind[e, 0, m], wind[e, 1, m], wind[e, 2, m]
            dy, dz = wy + induced_y[e, m], wz + induced_z[e, m]
            g = circulation[e, m]
            fx = g * (y * tz - z * ty) + gamma * (dy * tz - dz * ty)
            fy = g * (z * tx - ax * tz) + gamma * (dz * tx - wx * tz)
            fz = g * (ax * ty - y * tx) + gamma * (wx * ty - dy * tx)
            product = ax * wx + ay * wy + az * wz
            slope = product / relative
            moment = 2.0 * pitching * (product - along * (wx * tx + wy * ty + wz * tz))
            loads[e, 0, m] = scale * (fx + drag * (slope * ax + relative * wx))
            loads[e, 1, m] = scale * (fy + drag * (slope * ay + relative * wy))
            loads[e, 2, m] = scale * (fz + drag * (slope * az + relative * wz))
            loads[e, 3, m], loads[e, 4, m], loads[e, 5, m] = moment * tx, moment * ty, moment * tz
    return loads


@kernel
def profile_drag(
    elements: Elements, velocity: FloatArray, twist: FloatArray, density: float, coefficient: float
) -> FloatArray:
    """Profile drag (N, 3) N of the elements of one wing, as `element_wrenches` counts it.

    They move at `velocity` (N, 3) m/s relative to a body with a `twist` (6,).
    """
    flow = wing_flow(elements, velocity, twist, np.empty(0, np.int64))
    drag = np.empty((elements.chord.size, 3))
    for e in range(elements.chord.size):
        wind = flow.wind[e, :, 0]
        speed = np.sqrt(np.sum(wind * wind))
        scale = 0.5 * density * coefficient * elements.chord[e] * elements.width[e]
        drag[e] = scale * speed * wind
    return drag


@kernel
def wing_wrench(position: FloatArray, loads: FloatArray) -> FloatArray:
    """Wrench (6, 1 + d) about G of `loads` (N, 6, 1 + d) at `position` (N, 3) m of one wing."""
    n, _, columns = loads.shape
    total = np.zeros((6, columns))
    for e in range(n):
        x, y, z = position[e, 0], position[e, 1], position[e, 2]
        for m in range(columns):
            fx, fy, fz = loads[e, 0, m], loads[e, 1, m], loads[e, 2, m]
            total[0, m] += fx
            total[1, m] += fy
            total[2, m] += fz
            total[3, m] += y * fz - z * fy + loads[e, 3, m]
            total[4, m] += z * fx - x * fz + loads[e, 4, m]
            total[5, m] += x * fy - y * fx + loads[e, 5, m]
    return total
