"""Compiled generalised forces of the air on the multibody bird."""

from __future__ import annotations

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.aerodynamics.airframe import Airframe, planar_airframe_loads
from birdmb.aerodynamics.circulation import element_loads, resultant
from birdmb.aerodynamics.elements import clearance, place_elements
from birdmb.aerodynamics.joints import hinge_torques, joint_torques
from birdmb.aerodynamics.tail import tail_influence
from birdmb.models.springs import Springs, spring_torques
from birdmb.wing.arrays import WingArrays
from birdmb.wing.chain import frame_after, joint_chain
from birdmb.wing.shape import WingShape, turned

_BODY = 3  # coordinates of the body


@kernel
def body_velocity(theta: float, vx: float, vz: float) -> tuple[float, float]:
    """Velocity u, w along the body's axes from that along X (forward) and Z (down)."""
    c, s = np.cos(theta), np.sin(theta)
    return vx * c - vz * s, vx * s + vz * c


@kernel
def _body_forces(loads: FloatArray, theta: float) -> FloatArray:
    """Generalised forces on X, Z and the pitch angle from F_x, F_z and M_y in body axes."""
    c, s = np.cos(theta), np.sin(theta)
    return np.array([loads[0] * c + loads[1] * s, -loads[0] * s + loads[1] * c, loads[2]])


@kernel
def air_forces(
    wing: WingArrays,
    shape: WingShape,
    rigid_joint_count: int,
    angles: FloatArray,
    rates: FloatArray,
    frame: Airframe,
    theta: float,
    vx: float,
    vz: float,
    pitch_rate: float,
) -> tuple[FloatArray, FloatArray, float]:
    """Generalised forces of the air on body (3,) and on joints and hinges (A,) of each wing.

    Third comes the wings' `clearance` (m) from the plane of symmetry; across it forces are NaN.

    `shape` is the wing with its first `rigid_joint_count` joints at zero: they carry it as a whole,
    so their `angles` and `rates` turn it into body axes here. `vx`, `vz` (m/s, in the world) are
    the body's velocity through the air.
    """
    chain = joint_chain(wing, angles)
    spin = np.zeros(3)
    for j in range(rigid_joint_count):
        spin += rates[j] * chain.axis[j]
    shape = turned(shape, frame_after(wing, angles, rigid_joint_count), spin)
    placed = place_elements(shape, wing.root)
    distance = clearance(placed)
    if not distance >= 0.0:
        return np.full(3, np.nan), np.full(angles.size, np.nan), distance
    u, w = body_velocity(theta, vx, vz)
    loads = element_loads(placed, frame.density, frame.profile, u, w, pitch_rate)
    about_joints = joint_torques(wing, chain, placed.position, loads.force, shape.distal_fraction)
    torques = np.concatenate((about_joints, hinge_torques(shape.hinge_velocity, loads.force)))
    total = resultant(placed, loads.force)
    induced = np.zeros(2)
    if frame.tail.span > 0.0:
        induced = tail_influence(frame.tail, placed.node) @ loads.circulation
    total += planar_airframe_loads(frame, induced, u, w, pitch_rate)
    return _body_forces(total, theta), torques, distance


@kernel
def tree_forces(
    wing: WingArrays,
    shape: WingShape,
    rigid_joint_count: int,
    frame: Airframe,
    springs: Springs,
    driver_angles: FloatArray,
    driver_rates: FloatArray,
    q: FloatArray,
    v: FloatArray,
    air: tuple[float, float],
) -> tuple[FloatArray, float]:
    """Generalised forces (n,) of air, springs and dampers on the tree, and the `clearance` (m).

    At coordinates q and velocities v (n,) of the tree, angles and rates (A,) of the drivers, and
    velocity `air` (m/s) of the air in the world, forward and down. NaN where q or v is not finite.
    """
    joints = driver_angles.size
    forces = np.full(q.size, np.nan)
    if not (np.isfinite(q).all() and np.isfinite(v).all()):
        return forces, 0.0
    right = slice(_BODY, _BODY + joints)
    angles, rates = q[right], v[right]
    vx, vz = v[0] - air[0], v[1] - air[1]
    body, torques, distance = air_forces(
        wing, shape, rigid_joint_count, angles, rates, frame, q[2], vx, vz, v[2]
    )
    torques += spring_torques(springs, angles - driver_angles, rates - driver_rates)
    forces[:_BODY] = body
    forces[right] = torques
    forces[_BODY + joints :] = torques
    return forces, distance
