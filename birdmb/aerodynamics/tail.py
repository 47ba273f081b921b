"""Loads of the tail: a slender triangle in the wake of the wings (docs/model.md, section 9).

Everything is in body axes and in the plane of symmetry. The loads act at the centre of pressure of
a slender delta wing, two thirds of its chord behind the apex, and follow the air's velocity there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.topology import Bird


class TailSurface(NamedTuple):
    """The tail as the kernels read it; of no span where there is none."""

    x: float  # m, centre of pressure from G
    z: float
    aft_x: float  # direction of the plate, from apex to trailing edge
    aft_z: float
    span: float  # m
    area: float  # m2
    chord: float  # m
    viscosity: float  # kinematic, m2/s
    in_wake: bool  # whether it feels the wake of the wings
    near_bound: bool  # whether it feels their bound vortices


def tail_surface(bird: Bird) -> TailSurface:
    """The tail of a bird."""
    tail, viscosity = bird.tail, bird.air.kinematic_viscosity
    if tail is None:
        return TailSurface(0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0, viscosity, False, False)
    aft_x, aft_z = -np.cos(tail.incidence), np.sin(tail.incidence)
    lever = 2.0 / 3.0 * tail.chord
    return TailSurface(
        x=tail.apex.x + lever * aft_x,
        z=tail.apex.z + lever * aft_z,
        aft_x=aft_x,
        aft_z=aft_z,
        span=tail.span,
        area=0.5 * tail.span * tail.chord,
        chord=tail.chord,
        viscosity=viscosity,
        in_wake=tail.downwash != "none",
        near_bound=tail.downwash == "wake and bound",
    )


@kernel
def tail_influence(tail: TailSurface, node: FloatArray) -> FloatArray:
    """Velocities along x and z (2, N), 1/m, at the tail by the circulation of each wing element.

    `node` (N + 1, 3) m are the ends of the right wing's elements from G. Both wings' vortices act
    by the law of Biot and Savart: of the wake, one from each node straight backwards along the x
    axis to infinity; of the bound ones, one along each element.
    """
    influence = np.zeros((2, node.shape[0] - 1))
    if tail.span > 0.0 and tail.in_wake:
        _add_wake(tail, node, influence)
    if tail.span > 0.0 and tail.near_bound:
        _add_bound(tail, node, influence)
    return influence


@kernel
def _add_wake(tail: TailSurface, node: FloatArray, influence: FloatArray) -> None:
    # The first node lies on the centre line, where nothing is shed for symmetry.
    n = node.shape[0] - 1
    for k in range(1, n + 1):
        dx, dy, dz = tail.x - node[k, 0], -node[k, 1], tail.z - node[k, 2]
        across = dy * dy + dz * dz
        # 1 abreast of the vortex's beginning, 2 far behind it.
        begun = 1.0 - dx / np.sqrt(dx * dx + across)
        # Along y both wings' vortices cancel, along z they add up.
        down = -2.0 * dy * begun / (4.0 * np.pi * across)
        # Node k sheds the circulation inboard of it minus the one outboard of it.
        influence[1, k - 1] += down
        if k < n:
            influence[1, k] -= down


@kernel
def _add_bound(tail: TailSurface, node: FloatArray, influence: FloatArray) -> None:
    for e in range(node.shape[0] - 1):
        a, b = node[e], node[e + 1]
        ax, ay, az = tail.x - a[0], -a[1], tail.z - a[2]
        bx, by, bz = tail.x - b[0], -b[1], tail.z - b[2]
        to_a = np.sqrt(ax * ax + ay * ay + az * az)
        to_b = np.sqrt(bx * bx + by * by + bz * bz)
        aligned = ax * bx + ay * by + az * bz
        scale = 2.0 * (to_a + to_b) / (4.0 * np.pi * to_a * to_b * (to_a * to_b + aligned))
        influence[0, e] += scale * (ay * bz - az * by)
        influence[1, e] += scale * (ax * by - ay * bx)


@kernel
def tail_angle(tail: TailSurface, wind_x: float, wind_z: float) -> float:
    """Angle of attack (rad) of the plate in a wind (m/s) at its centre of pressure."""
    up = -tail.aft_z * wind_x + tail.aft_x * wind_z
    along = tail.aft_x * wind_x + tail.aft_z * wind_z
    return float(np.arctan2(up, along))


@kernel
def tail_force(tail: TailSurface, density: float, wind: FloatArray) -> FloatArray:
    """Force (N) of the tail in a wind (3,) m/s at its centre of pressure, with the downwash.

    Columns: value, derivatives with respect to the wind; (3, 4). Lift square to the wind in the
    plane of symmetry, L = pi/4 rho alpha U^2 b^2 (R. T. Jones, NACA Report 835, 1946), and induced
    drag, half of L alpha, along it; laminar friction, 1/2 rho V^2 S 1.328/sqrt(V c/nu), along the
    whole wind V. A flat plate has no other side force.
    """
    force = np.zeros((3, 4))
    x, y, z = wind
    speed, whole = np.sqrt(x * x + z * z), np.sqrt(x * x + y * y + z * z)
    if tail.span == 0.0 or speed == 0.0:
        return force
    alpha = tail_angle(tail, x, z)
    lift = 0.25 * np.pi * density * tail.span**2
    friction = 0.5 * density * tail.area * 1.328 * np.sqrt(tail.viscosity / tail.chord)
    across = lift * alpha * speed
    along = 0.5 * lift * alpha**2 * speed
    force[0, 0] = -across * z + along * x
    force[2, 0] = across * x + along * z
    for j in (0, 2):
        speed_slope = wind[j] / speed
        alpha_slope = (-z if j == 0 else x) / speed**2
        across_slope = lift * (alpha_slope * speed + alpha * speed_slope)
        along_slope = lift * alpha * (alpha_slope * speed + 0.5 * alpha * speed_slope)
        force[0, j + 1] = -across_slope * z + along_slope * x
        force[2, j + 1] = across_slope * x + along_slope * z
    force[0, 1] += along
    force[0, 3] -= across
    force[2, 1] += across
    force[2, 3] += along
    drag = friction * np.sqrt(whole)
    for i in range(3):
        force[i, 0] += drag * wind[i]
        for j in range(3):
            force[i, j + 1] += 0.5 * drag * wind[i] * wind[j] / whole**2
        force[i, i + 1] += drag
    return force
