"""Aerodynamic loads as users see them."""

from dataclasses import dataclass

import numpy as np

from birdmb._typing import FloatArray
from birdmb.aerodynamics.circulation import ElementLoads
from birdmb.aerodynamics.elements import Elements


@dataclass(frozen=True)
class Loads:
    """Loads of both wings at one instant, in body axes (x forward, y right, z down).

    The per-element arrays are of the right wing, from the root outwards; the left wing is its
    mirror image.
    """

    force: FloatArray
    """(3,) N, resultant of both wings."""
    moment: FloatArray
    """(3,) N m, of both wings about the body's centre of mass G."""
    power: float
    """W, that the wings' motion relative to the body takes: minus the sum of force . velocity."""
    joint_torques: FloatArray
    """(J,) N m, of the air about each joint of the right wing, along the joint's axis."""
    position: FloatArray
    """(N, 3) m, control points from G."""
    node: FloatArray
    """(N + 1, 3) m, ends of the elements from G, from the centre line to the wing tip."""
    velocity: FloatArray
    """(N, 3) m/s, of the control points relative to the body."""
    chord: FloatArray
    """(N,) m."""
    width: FloatArray
    """(N,) m, along the span."""
    element_force: FloatArray
    """(N, 3) N."""
    circulation: FloatArray
    """(N,) m2/s."""
    angle_of_attack: FloatArray
    """(N,) rad, between the chord and the wind in the section's plane, without the downwash."""
    speed: FloatArray
    """(N,) m/s, of the wind in the section's plane."""


def assemble_loads(elements: Elements, loads: ElementLoads, joint_torques: FloatArray) -> Loads:
    """Sum both wings up; the sideways force and the roll and yaw moments cancel."""
    force = 2.0 * loads.force.sum(axis=0) * np.array([1.0, 0.0, 1.0])
    moment = 2.0 * np.cross(elements.position, loads.force).sum(axis=0) * np.array([0.0, 1.0, 0.0])
    return Loads(
        force=force,
        moment=moment,
        power=float(-2.0 * np.sum(loads.force * elements.velocity)),
        joint_torques=joint_torques,
        position=elements.position,
        node=elements.node,
        velocity=elements.velocity,
        chord=elements.chord,
        width=elements.width,
        element_force=loads.force,
        circulation=loads.circulation,
        angle_of_attack=loads.angle_of_attack,
        speed=loads.speed,
    )
