"""A plate that heaves at its leading edge and pitches as the fluid and a spring let it.

The exact solution is that of `thin_airfoil`; M. N. J. Moore, Journal of Fluid Mechanics 757, 2014.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from birdmb.studies.experiments.comparison import CHOICES, Comparison, Experiment, WakeChoice
from birdmb.studies.experiments.section import SMALL, moment_amplitude, oscillating_loads
from birdmb.studies.experiments.thin_airfoil import SprungPlate

FREQUENCIES = (0.1, 0.3, 0.6)
# Light and soft, light and stiff, heavy and stiff.
PLATES = (SprungPlate(0.0, 1.0), SprungPlate(0.0, 5.0), SprungPlate(5.0, 5.0))


class SprungMotion(NamedTuple):
    """How a plate moves that heaves by half a chord, and its thrust coefficient."""

    pitch: complex
    thrust: float


def computed_motion(plate: SprungPlate, k: float, choice: WakeChoice) -> SprungMotion:
    """The motion by the moments of `moving_wing_loads` on a very long wing."""
    of_heave, of_pitch = (
        moment_amplitude(oscillating_loads(k, heave, pitch, plate.axis, choice))
        for heave, pitch in ((1.0, 0.0), (0.0, 1.0))
    )
    pitch = plate.pitch(k, of_heave, of_pitch)
    together = oscillating_loads(k, 1.0, pitch, plate.axis, choice)
    return SprungMotion(pitch, together.mean_thrust_coefficient / SMALL**2)


def exact_motion(plate: SprungPlate, k: float) -> SprungMotion:
    """The motion in closed form."""
    moving = plate.oscillating(k)
    return SprungMotion(moving.pitch, moving.thrust)


def _compare() -> Iterator[Comparison]:
    for plate in PLATES:
        for k in FREQUENCIES:
            exact = exact_motion(plate, k)
            found = {name: computed_motion(plate, k, choice) for name, choice in CHOICES.items()}
            at = f"inertia {plate.inertia:g}, stiffness {plate.stiffness:g}, k = {k:g}"
            sizes = {name: abs(motion.pitch) for name, motion in found.items()}
            yield Comparison("D", f"pitch per heave, {at}", "rad", abs(exact.pitch), sizes)
            angle = float(np.degrees(np.angle(exact.pitch)))
            angles = {
                name: angle + float(np.degrees(np.angle(motion.pitch / exact.pitch)))
                for name, motion in found.items()
            }
            yield Comparison("D", f"phase of the pitch, {at}", "deg", angle, angles)
            thrusts = {name: motion.thrust for name, motion in found.items()}
            yield Comparison("D", f"thrust, {at}", "", exact.thrust, thrusts)


EXPERIMENT = Experiment(
    "D",
    "a heaving plate on a torsion spring",
    "exact, of M. N. J. Moore's kind, 2014",
    _compare,
)
