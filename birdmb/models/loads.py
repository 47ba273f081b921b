"""Aerodynamic loads as users see them."""

from dataclasses import dataclass

import numpy as np

from birdmb._typing import FloatArray
from birdmb.aerodynamics.airframe import Airframe, tail_wind
from birdmb.aerodynamics.body_drag import body_drag_force
from birdmb.aerodynamics.circulation import ElementLoads
from birdmb.aerodynamics.elements import Elements
from birdmb.aerodynamics.tail import tail_angle, tail_force, tail_influence


@dataclass(frozen=True)
class TailLoads:
    """Loads of the tail at one instant, in body axes."""

    force: FloatArray
    """(3,) N."""
    position: FloatArray
    """(3,) m, centre of pressure from G."""
    angle_of_attack: float
    """rad, of the wind there to the plate, the downwash of the wings included."""
    downwash: float
    """m/s along z, induced by the wings' vortices."""


@dataclass(frozen=True)
class Loads:
    """Loads of the air on a bird at one instant, in body axes (x forward, y right, z down).

    The per-element arrays are of the right wing, from the root outwards; the left wing is its
    mirror image.
    """

    force: FloatArray
    """(3,) N, resultant of wings, tail and body."""
    moment: FloatArray
    """(3,) N m, of all of them about the body's centre of mass G."""
    tail: "TailLoads | None"
    """Of the tail; `None` where there is none, or where it is furled."""
    body_drag: FloatArray
    """(3,) N, of the body, at G."""
    power: float
    """W, that the wings' motion relative to the body takes: minus the sum of force . velocity."""
    joint_torques: FloatArray
    """(A,) N m, of the air about each joint and each feather's hinge of the right wing."""
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
    """(N, 3) N, profile drag included."""
    profile_drag: FloatArray
    """(N, 3) N."""
    circulation: FloatArray
    """(N,) m2/s."""
    angle_of_attack: FloatArray
    """(N,) rad, between the chord and the wind in the section's plane, without the downwash."""
    speed: FloatArray
    """(N,) m/s, of the wind in the section's plane."""


def assemble_loads(
    elements: Elements,
    loads: ElementLoads,
    joint_torques: FloatArray,
    frame: Airframe,
    motion: tuple[float, float, float],
) -> Loads:
    """Sum up wings, tail and body; the sideways force and the roll and yaw moments cancel.

    `motion` is the body's velocity u, w (m/s) through the air and its pitch rate q (rad/s).
    """
    force = 2.0 * loads.force.sum(axis=0) * np.array([1.0, 0.0, 1.0])
    moment = 2.0 * np.cross(elements.position, loads.force).sum(axis=0) * np.array([0.0, 1.0, 0.0])
    tail = _tail_loads(elements, loads, frame, motion)
    if tail is not None:
        force = force + tail.force
        moment = moment + np.cross(tail.position, tail.force)
    drag_x, drag_z = body_drag_force(frame.body, *motion[:2])[:, 0]
    body_drag = np.array([drag_x, 0.0, drag_z])
    return Loads(
        force=force + body_drag,
        moment=moment,
        tail=tail,
        body_drag=body_drag,
        power=float(-2.0 * np.sum(loads.force * elements.velocity)),
        joint_torques=joint_torques,
        position=elements.position,
        node=elements.node,
        velocity=elements.velocity,
        chord=elements.chord,
        width=elements.width,
        element_force=loads.force,
        profile_drag=loads.profile_drag,
        circulation=loads.circulation,
        angle_of_attack=loads.angle_of_attack,
        speed=loads.speed,
    )


def _tail_loads(
    elements: Elements, loads: ElementLoads, frame: Airframe, motion: tuple[float, float, float]
) -> TailLoads | None:
    tail = frame.tail
    if tail.span == 0.0:
        return None
    induced = tail_influence(tail, elements.node) @ loads.circulation
    wind = tail_wind(tail, induced, *motion)
    force_x, force_z = tail_force(tail, frame.density, *wind)[:, 0]
    return TailLoads(
        force=np.array([force_x, 0.0, force_z]),
        position=np.array([tail.x, 0.0, tail.z]),
        angle_of_attack=tail_angle(tail, *wind),
        downwash=float(induced[1]),
    )
