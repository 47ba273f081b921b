"""Loads of the tail: a slender triangle in the wake of the wings (docs/model.md, section 9).

Everything is in body axes and in the plane of symmetry. The loads act at the centre of pressure of
a slender delta wing, two thirds of its chord behind the apex, and follow the air's velocity there.
"""

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
def tail_force(tail: TailSurface, density: float, wind_x: float, wind_z: float) -> FloatArray:
    """Force of the tail in a wind (m/s) at its centre of pressure, both with the downwash.

    Rows F_x, F_z (N); columns: value, derivatives by `wind_x` and `wind_z`; (2, 3). Lift square to
    the wind, L = pi/4 rho alpha U^2 b^2 (R. T. Jones, NACA Report 835, 1946); induced drag, half of
    L alpha, and laminar friction, 1/2 rho U^2 S 1.328/sqrt(U c/nu), along it.
    """
    force = np.zeros((2, 3))
    speed = np.sqrt(wind_x * wind_x + wind_z * wind_z)
    if tail.span == 0.0 or speed == 0.0:
        return force
    alpha = tail_angle(tail, wind_x, wind_z)
    lift = 0.25 * np.pi * density * tail.span**2
    friction = 0.5 * density * tail.area * 1.328 * np.sqrt(tail.viscosity / tail.chord)
    across = lift * alpha * speed
    along = 0.5 * lift * alpha**2 * speed + friction * np.sqrt(speed)
    force[0, 0] = -across * wind_z + along * wind_x
    force[1, 0] = across * wind_x + along * wind_z
    speed_slope = (wind_x / speed, wind_z / speed)
    alpha_slope = (-wind_z / speed**2, wind_x / speed**2)
    for i in range(2):
        across_slope = lift * (alpha_slope[i] * speed + alpha * speed_slope[i])
        along_slope = (
            lift * alpha * alpha_slope[i] * speed
            + 0.5 * (lift * alpha**2 + friction / np.sqrt(speed)) * speed_slope[i]
        )
        force[0, i + 1] = -across_slope * wind_z + along_slope * wind_x
        force[1, i + 1] = across_slope * wind_x + along_slope * wind_z
    force[0, 1] += along
    force[0, 2] -= across
    force[1, 1] += across
    force[1, 2] += along
    return force
