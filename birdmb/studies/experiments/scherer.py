"""Thrust of a rectangular wing that heaves and pitches in a water tunnel.

J. O. Scherer, Experimental and theoretical investigation of large amplitude oscillating foil
propulsion systems, Hydronautics Technical Report 662-1, 1968, as redrawn in figure 14 of J. S.
Izraelevitz, Q. Zhu and M. S. Triantafyllou, AIAA Journal 55, 2017, who take a profile drag
coefficient of 0.057. The markers have error bars of 0.011. Symmetric sections of 15 % stall near 15
degrees at the wing's Reynolds number of 3e5 (R. E. Sheldahl and P. C. Klimas, SAND80-2114, 1981).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from birdmb._typing import FloatArray
from birdmb.studies.experiments.comparison import Comparison, Experiment, WakeChoice, with_stall
from birdmb.studies.moving_wing import PlaneWing, WingMotion, moving_wing_loads
from birdmb.topology import Stall

CHORD, SPAN = 0.1016, 0.3048  # m
SPEED, DENSITY, FREQUENCY = 3.048, 1000.0, 5.0  # m/s, kg/m3, Hz
HEAVE, PITCH_AXIS = 0.6 * CHORD, 0.75
PROFILE_DRAG = 0.057
ERROR_BAR = 0.011
PITCH_DEG = 15.0
# By how much pitching (nose up) leads heaving (upwards), degrees, and mean thrust coefficients.
MARKERS = (
    (15.0, 0.1231), (15.0, 0.1449), (30.0, 0.1797), (45.0, 0.2344), (60.0, 0.2306),
    (75.0, 0.2126), (75.0, 0.2052), (90.0, 0.1915), (105.0, 0.1635),
)  # fmt: skip
# Mean absolute errors of the models of the same paper, and of a vortex method with leading-edge
# separation, over these markers and five at 25 degrees.
OTHERS = {
    "quasi-steady with added mass": 0.098,
    "unsteady lifting line, one state": 0.046,
    "unsteady lifting line, six states": 0.050,
    "vortex method, separation tuned": 0.017,
}
STALL = Stall(angle=np.radians(15.0))


def wing(stall: Stall | None = None) -> PlaneWing:
    """The wing, with sections that stall so."""
    return PlaneWing.rectangular(SPAN, CHORD, stall=stall)


def thrust_coefficients(
    leads_deg: Sequence[float],
    choice: WakeChoice,
    pitch_deg: float = PITCH_DEG,
    stall: Stall | None = None,
) -> FloatArray:
    """Mean thrust coefficients (P,) where pitching leads heaving by P angles, degrees."""
    found = []
    for lead in leads_deg:
        pitch = np.radians(pitch_deg) * np.exp(1j * np.radians(lead))
        motion = WingMotion(FREQUENCY, [0.0, HEAVE], [0.0, pitch], pitch_axis=PITCH_AXIS)
        loads = moving_wing_loads(wing(stall), motion, speed=SPEED, density=DENSITY, **choice)
        found.append(loads.mean_thrust_coefficient - PROFILE_DRAG)
    return np.array(found)


def _compare() -> Iterator[Comparison]:
    leads, measured = np.transpose(MARKERS)
    found = with_stall(STALL, lambda choice, stall: thrust_coefficients(leads, choice, stall=stall))
    for i, (lead, marker) in enumerate(MARKERS):
        quantity = f"thrust coefficient, pitch {PITCH_DEG:g} deg, {lead:g} deg ahead of heave"
        of_marker = {name: float(values[i]) for name, values in found.items()}
        yield Comparison("A", quantity, "", marker, of_marker)
    errors = {name: float(np.abs(values - measured).mean()) for name, values in found.items()}
    yield Comparison("A", "mean absolute error of these", "", 0.0, errors, OTHERS)


EXPERIMENT = Experiment(
    "A",
    "a rectangular wing heaves and pitches in water",
    "J. O. Scherer 1968, redrawn by Izraelevitz, Zhu and Triantafyllou 2017",
    _compare,
)
