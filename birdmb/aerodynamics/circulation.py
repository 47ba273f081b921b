"""Quasi-steady circulation and loads of the lifting line, and their derivatives.

With U the wind that an element meets, its component along the span removed, and alpha its angle
to the chord, thin-airfoil theory and the downwash w of the wake give

    Gamma = 1/2 c 2 pi (|U| alpha - w),   w linear in Gamma,

which is one linear system. Each element then feels rho Gamma (U_total x e_t) dl, U_total with the
induced velocity, and the profile drag 1/2 rho C_d c dl |U| U of the whole wind U without it.
Everything is in body axes, moments are about the body's centre of mass G.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import Array, FloatArray
from birdmb.aerodynamics.elements import Elements, circulation_system


class ElementLoads(NamedTuple):
    """Loads of the N elements of the right wing."""

    circulation: FloatArray  # (N,) m2/s
    angle_of_attack: FloatArray  # (N,) rad, geometric (before the downwash)
    speed: FloatArray  # (N,) m/s in the section's plane
    force: FloatArray  # (N, 3) N, profile drag included
    profile_drag: FloatArray  # (N, 3) N


@kernel
def _wind(elements: Elements, e: int, u: float, w: float, q: float, out: FloatArray) -> None:
    """Write the air velocity (3,) m/s at control point e of a body that moves at u, w and q."""
    out[0] = -u - q * elements.position[e, 2] - elements.velocity[e, 0]
    out[1] = -elements.velocity[e, 1]
    out[2] = -w + q * elements.position[e, 0] - elements.velocity[e, 2]


@kernel
def _dot(a: FloatArray, b: FloatArray) -> float:
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


@kernel
def section_flow(
    elements: Elements, u: float, w: float, q: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Wind (N, 3), in-plane speed (N,) and geometric angle of attack (N,) of every element."""
    n = elements.chord.size
    wind = np.empty((n, 3))
    speed = np.empty(n)
    alpha = np.empty(n)
    in_plane = np.empty(3)
    for e in range(n):
        _wind(elements, e, u, w, q, wind[e])
        along = _dot(wind[e], elements.span_direction[e])
        for i in range(3):
            in_plane[i] = wind[e, i] - along * elements.span_direction[e, i]
        speed[e] = np.sqrt(_dot(in_plane, in_plane))
        alpha[e] = np.arctan2(
            _dot(in_plane, elements.normal[e]), _dot(in_plane, elements.chord_direction[e])
        )
    return wind, speed, alpha


@kernel
def element_loads(
    elements: Elements, density: float, profile: float, u: float, w: float, q: float
) -> ElementLoads:
    """Circulation and force of every element for body velocity u, w (m/s), pitch rate q (rad/s).

    `profile` is the drag coefficient of the sections. The loads are NaN where they overflow.
    """
    wind, speed, alpha = section_flow(elements, u, w, q)
    bound = np.pi * elements.chord * speed * alpha
    circulation: Array = np.full(speed.size, np.nan)
    system = circulation_system(elements)
    # The solver refuses what is not finite; a flow that diverges is told by whoever follows it.
    if np.isfinite(np.sum(system)) and np.isfinite(np.sum(bound)):
        circulation = np.linalg.solve(system, bound)
    drag = profile_drag(elements, density, profile, wind)
    force = lifting_forces(elements, density, wind, circulation) + drag
    return ElementLoads(circulation, alpha, speed, force, drag)


@kernel
def profile_drag(
    elements: Elements, density: float, profile: float, wind: FloatArray
) -> FloatArray:
    """Profile drag (N, 3) N of every element in `wind` (N, 3) m/s."""
    drag = np.zeros_like(wind)
    if profile > 0.0:
        for e in range(elements.chord.size):
            strength = 0.5 * density * profile * elements.chord[e] * elements.width[e]
            drag[e] = strength * np.sqrt(_dot(wind[e], wind[e])) * wind[e]
    return drag


@kernel
def lifting_forces(
    elements: Elements, density: float, wind: FloatArray, circulation: FloatArray
) -> FloatArray:
    """Forces (N, 3) N of `circulation` (N,) m2/s in `wind` (N, 3) m/s and what it induces."""
    induced_y, induced_z = elements.induced_y @ circulation, elements.induced_z @ circulation
    return vortex_forces(elements, density, wind, circulation, induced_y, induced_z)


@kernel
def vortex_forces(
    elements: Elements,
    density: float,
    wind: FloatArray,
    circulation: FloatArray,
    induced_y: FloatArray,
    induced_z: FloatArray,
) -> FloatArray:
    """Forces (N, 3) N of `circulation` (N,) m2/s in `wind` (N, 3) and induced velocities (N,)."""
    force = np.empty((circulation.size, 3))
    for e in range(circulation.size):
        t = elements.span_direction[e]
        x, y, z = wind[e, 0], wind[e, 1] + induced_y[e], wind[e, 2] + induced_z[e]
        strength = density * circulation[e] * elements.width[e]
        force[e, 0] = strength * (y * t[2] - z * t[1])
        force[e, 1] = strength * (z * t[0] - x * t[2])
        force[e, 2] = strength * (x * t[1] - y * t[0])
    return force


@kernel
def resultant(elements: Elements, force: FloatArray) -> FloatArray:
    """Sum over both wings: F_x, F_z (N) and the pitching moment about G (N m), nose up positive."""
    total = np.zeros(3)
    for e in range(force.shape[0]):
        total[0] += 2.0 * force[e, 0]
        total[1] += 2.0 * force[e, 2]
        total[2] += 2.0 * (
            elements.position[e, 2] * force[e, 0] - elements.position[e, 0] * force[e, 2]
        )
    return total
