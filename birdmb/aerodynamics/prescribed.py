"""A wing whose joints are all prescribed: everything but the body's motion is known per phase.

The wing's shape, its velocities and the inverse of the circulation's linear system depend on the
phase alone (docs/model.md, section 5), so they are computed once and shared by every trajectory
and every perturbation of it. What remains per evaluation is three products of small matrices.
"""

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import BoolArray, FloatArray
from birdmb.aerodynamics.airframe import Airframe, airframe_loads
from birdmb.aerodynamics.circulation import section_flow
from birdmb.aerodynamics.elements import (
    Elements,
    circulation_system,
    clearance,
    place_elements,
)
from birdmb.aerodynamics.tail import TailSurface, tail_influence
from birdmb.wing.arrays import WingArrays
from birdmb.wing.stacked import StackedShapes, shape_at, wing_shapes


class PrescribedWing(NamedTuple):
    """Elements at P phases: the arrays of `Elements` stacked along a first axis, and inverses."""

    elements: Elements
    inverse: FloatArray  # (P, N, N) of the circulation's linear system
    at_tail: FloatArray  # (P, 2, N) 1/m, velocity along x and z at the tail by the circulations
    beyond: FloatArray  # (P, N, 2), as in `WingShape`
    converged: BoolArray  # (P,) as in `WingShape`
    clearance: FloatArray  # (P,) m, see `elements.clearance`; NaN also where not converged


@kernel
def driven(wing: WingArrays, t: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Driver angles (A,) rad, rates and accelerations of all joints and hinges at time t (s)."""
    argument = wing.angular_frequency * t + wing.phase
    swing = wing.amplitude * np.sin(argument)
    return (
        wing.offset + swing,
        wing.angular_frequency * wing.amplitude * np.cos(argument),
        -(wing.angular_frequency**2) * swing,
    )


def driven_at(wing: WingArrays, times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """As `driven`, each (P, A), at `times` (P,) s."""
    argument = wing.angular_frequency * times[:, None] + wing.phase
    swing = wing.amplitude * np.sin(argument)
    return (
        wing.offset + swing,
        wing.angular_frequency * wing.amplitude * np.cos(argument),
        -(wing.angular_frequency**2) * swing,
    )


def prescribed_wing(
    wing: WingArrays,
    tail: TailSurface,
    times: FloatArray,
    elements: int,
    rounding: float,
    published: bool,
) -> PrescribedWing:
    """Tabulate the wing at `times` (P,) s; inverses are NaN where the wing is across the plane."""
    angles, rates, _ = driven_at(wing, times)
    shapes = wing_shapes(wing, angles, rates, elements, rounding, published)
    return _tabulated(shapes, wing.root, tail)


@kernel
def _tabulated(shapes: StackedShapes, root: FloatArray, tail: TailSurface) -> PrescribedWing:
    count, n = shapes.chord.shape
    position, node = np.empty((count, n, 3)), np.empty((count, n + 1, 3))
    width, clearances = np.empty((count, n)), np.empty(count)
    induced_y, induced_z = np.empty((count, n, n)), np.empty((count, n, n))
    inverse, at_tail = np.full((count, n, n), np.nan), np.empty((count, 2, n))
    for k in range(count):
        placed = place_elements(shape_at(shapes, k), root)
        position[k], node[k], width[k] = placed.position, placed.node, placed.width
        induced_y[k], induced_z[k] = placed.induced_y, placed.induced_z
        at_tail[k] = tail_influence(tail, placed.node)
        clearances[k] = clearance(placed)
        if clearances[k] >= 0.0:
            inverse[k] = np.linalg.inv(circulation_system(placed))
    elements = Elements(
        position,
        shapes.velocity,
        shapes.chord_direction,
        shapes.normal,
        shapes.span_direction,
        shapes.chord,
        node,
        width,
        induced_y,
        induced_z,
    )
    return PrescribedWing(elements, inverse, at_tail, shapes.beyond, shapes.converged, clearances)


def every_second(wing: PrescribedWing) -> PrescribedWing:
    """The table of every second phase, the first included."""
    return PrescribedWing(
        Elements(*(array[::2].copy() for array in wing.elements)),
        wing.inverse[::2].copy(),
        wing.at_tail[::2].copy(),
        wing.beyond[::2].copy(),
        wing.converged[::2].copy(),
        wing.clearance[::2].copy(),
    )


@kernel
def at_phase(stack: Elements, k: int) -> Elements:
    """Elements at the k-th phase, as views."""
    return Elements(
        stack.position[k],
        stack.velocity[k],
        stack.chord_direction[k],
        stack.normal[k],
        stack.span_direction[k],
        stack.chord[k],
        stack.node[k],
        stack.width[k],
        stack.induced_y[k],
        stack.induced_z[k],
    )


@kernel
def bird_loads(
    wing: PrescribedWing, k: int, frame: Airframe, u: float, w: float, q: float
) -> FloatArray:
    """Loads of the whole bird at the k-th phase, moving at u, w (m/s) and q (rad/s).

    Rows F_x, F_z (N), M_y (N m); columns: value, d/du, d/dw, d/dq; (3, 4), exact.
    """
    total, circulation = resultant_and_derivatives(
        at_phase(wing.elements, k), wing.inverse[k], frame.density, frame.profile, u, w, q
    )
    return total + airframe_loads(frame, wing.at_tail[k] @ circulation, u, w, q)


@kernel
def resultant_and_derivatives(
    elements: Elements,
    inverse: FloatArray,
    density: float,
    profile: float,
    u: float,
    w: float,
    q: float,
) -> tuple[FloatArray, FloatArray]:
    """Loads (3, 4) of both wings and circulations (N, 4) m2/s of the right one.

    Rows F_x, F_z (N), M_y (N m); columns: value, d/du, d/dw, d/dq. The wind is affine in u, w, q,
    so the derivatives are exact.
    """
    n = elements.chord.size
    wind, speed, alpha = section_flow(elements, u, w, q)
    bound = np.empty((n, 4))
    # Change of the wind by u, w, q: the velocities of the body's points, reversed.
    change = np.zeros((n, 3, 4))
    for e in range(n):
        c, nn, t = elements.chord_direction[e], elements.normal[e], elements.span_direction[e]
        change[e, 0, 1] = -1.0
        change[e, 2, 2] = -1.0
        change[e, 0, 3] = -elements.position[e, 2]
        change[e, 2, 3] = elements.position[e, 0]
        factor = np.pi * elements.chord[e]
        along = wind[e, 0] * t[0] + wind[e, 1] * t[1] + wind[e, 2] * t[2]
        px, py, pz = wind[e, 0] - along * t[0], wind[e, 1] - along * t[1], wind[e, 2] - along * t[2]
        up = px * nn[0] + py * nn[1] + pz * nn[2]
        back = px * c[0] + py * c[1] + pz * c[2]
        section = up * up + back * back
        bound[e, 0] = factor * speed[e] * alpha[e]
        for m in range(1, 4):
            dx, dz = change[e, 0, m], change[e, 2, m]
            d_along = dx * t[0] + dz * t[2]
            gx, gy, gz = dx - d_along * t[0], -d_along * t[1], dz - d_along * t[2]
            d_speed = (px * gx + py * gy + pz * gz) / speed[e]
            d_up = gx * nn[0] + gy * nn[1] + gz * nn[2]
            d_back = gx * c[0] + gy * c[1] + gz * c[2]
            d_alpha = (back * d_up - up * d_back) / section
            bound[e, m] = factor * (d_speed * alpha[e] + speed[e] * d_alpha)
    circulation = inverse @ bound
    vy = elements.induced_y @ circulation
    vz = elements.induced_z @ circulation
    total = np.zeros((3, 4))
    for e in range(n):
        t = elements.span_direction[e]
        gamma = circulation[e, 0]
        x, y, z = wind[e, 0], wind[e, 1] + vy[e, 0], wind[e, 2] + vz[e, 0]
        scale = 2.0 * density * elements.width[e]
        # The profile drag, per `scale`: on the wind without the induced velocity.
        relative = np.sqrt(wind[e, 0] ** 2 + wind[e, 1] ** 2 + wind[e, 2] ** 2)
        drag = 0.5 * profile * elements.chord[e]
        for m in range(4):
            if m == 0:
                fx = gamma * (y * t[2] - z * t[1]) + drag * relative * wind[e, 0]
                fz = gamma * (x * t[1] - y * t[0]) + drag * relative * wind[e, 2]
            else:
                wx, wz = change[e, 0, m], change[e, 2, m]
                dx, dy, dz = wx, vy[e, m], wz + vz[e, m]
                g = circulation[e, m]
                fx = g * (y * t[2] - z * t[1]) + gamma * (dy * t[2] - dz * t[1])
                fz = g * (x * t[1] - y * t[0]) + gamma * (dx * t[1] - dy * t[0])
                d_relative = (wind[e, 0] * wx + wind[e, 2] * wz) / relative
                fx += drag * (d_relative * wind[e, 0] + relative * wx)
                fz += drag * (d_relative * wind[e, 2] + relative * wz)
            total[0, m] += scale * fx
            total[1, m] += scale * fz
            total[2, m] += scale * (elements.position[e, 2] * fx - elements.position[e, 0] * fz)
    return total, circulation
