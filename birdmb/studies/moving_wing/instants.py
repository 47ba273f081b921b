"""What a moving wing meets at an instant."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._typing import FloatArray
from birdmb.aerodynamics.apparent_mass import ApparentInertia, inertia_wrenches
from birdmb.aerodynamics.elements import Elements
from birdmb.aerodynamics.section_motion import SectionMotion
from birdmb.aerodynamics.unsteady_loads import SideFlow


class Instant(NamedTuple):
    """The right half at an instant."""

    elements: Elements
    flow: SideFlow
    sections: SectionMotion
    air: ApparentInertia
    twist: FloatArray  # (6,) of the body's axes through the air, along themselves
    acceleration: FloatArray  # (6,) of these in space
    rates: FloatArray  # (3,) of heaving upwards, m/s, pitching and flapping, rad/s
    pitch: float  # rad


def inertial_loads(at: Instant) -> FloatArray:
    """Loads (N, 6) N and N m of apparent mass by the acceleration of the body's axes."""
    placed, linear, angular = at.elements, at.acceleration[:3], at.acceleration[3:]
    accelerations = np.empty((len(placed.chord), 6))
    accelerations[:, :3] = linear + np.cross(angular, placed.position)
    accelerations[:, 3:] = angular
    return inertia_wrenches(placed, at.air, accelerations)


def pitch_rate(at: Instant) -> FloatArray:
    """Angular velocities (N,) rad/s of the sections about the span, nose up."""
    return at.sections.pitch_rate + at.elements.span_direction @ at.twist[3:]
