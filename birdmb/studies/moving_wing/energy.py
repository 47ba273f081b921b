"""Where the energy of a moving wing goes, told apart from its loads; of both halves."""

from __future__ import annotations

import numpy as np

from birdmb._typing import FloatArray
from birdmb.studies.moving_wing.instants import Instant, pitch_rate


def wake_power(
    at: Instant,
    density: float,
    circulation: FloatArray,
    trailing: FloatArray,
    shed: FloatArray,
) -> float:
    """What trailing and shed vortices take, W: their downwash times circulation and wind.

    Circulations (N,) m2/s, bound and of the trailing vortices, and downwash of the shed ones (N,)
    m/s.
    """
    placed, wind = at.elements, at.flow.wind[:, :, 0]
    induced = np.zeros((len(shed), 3))
    induced[:, 1], induced[:, 2] = placed.induced_y @ trailing, placed.induced_z @ trailing
    backwards = np.cross(induced, placed.span_direction)
    backwards += shed[:, None] * placed.chord_direction
    of_each = circulation * (backwards * wind).sum(axis=1)
    return float(2.0 * density * of_each @ placed.width)


def profile_power(at: Instant, density: float, profile_drag: float) -> float:
    """What the profile's drag and its moment take, W."""
    placed, wind = at.elements, at.flow.wind[:, :, 0]
    relative = np.linalg.norm(wind, axis=1)
    along = (wind * placed.span_direction).sum(axis=1)
    moment = placed.profile[:, 2] * placed.chord**2 * (relative**2 - along**2)
    of_each = profile_drag * placed.chord * relative**3 - moment * pitch_rate(at)
    return float(density * of_each @ placed.width)


def apparent_energy(at: Instant) -> float:
    """Kinetic energy of the apparent mass, J."""
    placed, velocity, spin = at.elements, at.twist[:3], at.twist[3:]
    middle = placed.position + 0.25 * placed.chord[:, None] * placed.chord_direction
    across = velocity + np.cross(spin, middle) + at.sections.middle_velocity
    normal = (across * placed.normal).sum(axis=1)
    return float((at.air.mass * normal**2 + at.air.moment * pitch_rate(at) ** 2).sum())
