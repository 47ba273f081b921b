"""Sections that oscillate and wings that start, against exact solutions.

T. Theodorsen, NACA Report 496, 1935; I. E. Garrick, NACA Report 567, 1936; H. Wagner, ZAMM 5, 1925;
for elliptic wings R. T. Jones, NACA Report 681, 1940.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from birdmb._typing import FloatArray
from birdmb.studies.experiments.comparison import CHOICES, Comparison, Experiment, WakeChoice
from birdmb.studies.experiments.thin_airfoil import OscillatingSection, wagner_function
from birdmb.studies.moving_wing import (
    MovingWingLoads,
    PlaneWing,
    WingMotion,
    moving_wing_loads,
)

FREQUENCIES = (0.05, 0.1, 0.2, 0.5236)
SMALL = 1e-3  # of what is linear
# So long that its tips do not count; half its chord is 1 m.
SECTION = PlaneWing.rectangular(2e5, 2.0)
SECTION_ELEMENTS = 8
MOTIONS = {"heaving": (1.0, 0.0), "pitching about the quarter chord": (0.0, 1.0)}
AXIS = -0.5  # of pitching, half chords behind the middle
HALF_CHORDS = (1.0, 2.0, 5.0, 10.0)  # after a start
# Aspect ratio: share a and rate b of the lift 1 - a exp(-b s) after s half chords.
ELLIPTIC = {3.0: (0.283, 0.540), 6.0: (0.361, 0.381)}


def oscillating_loads(
    k: float, heave: complex, pitch: complex, axis: float, choice: WakeChoice
) -> MovingWingLoads:
    """Loads at reduced frequency k of small parts of these amplitudes; those of `thin_airfoil`."""
    motion = WingMotion(
        frequency=k / (2.0 * np.pi),
        heave=[0.0, SMALL * heave],
        pitch=[0.0, SMALL * pitch],
        pitch_axis=0.5 * (axis + 1.0),
    )
    return moving_wing_loads(
        SECTION, motion, speed=1.0, density=1.0, elements=SECTION_ELEMENTS, instants=17, **choice
    )


def lift_amplitude(loads: MovingWingLoads) -> complex:
    """Amplitude of the lift coefficient of the whole amplitudes."""
    return complex(loads.amplitude(loads.lift)) / (SMALL * loads.dynamic_area)


def moment_amplitude(loads: MovingWingLoads) -> complex:
    """Amplitude of the moment coefficient of the whole amplitudes."""
    scale = SMALL * loads.dynamic_area * loads.wing.mean_chord
    return complex(loads.amplitude(loads.moment)) / scale


def growing_lift(wing: PlaneWing, half_chords: FloatArray, choice: WakeChoice) -> FloatArray:
    """Lift (S,) over the final one, so many half chords of the root after a start."""
    motion = WingMotion(pitch=[SMALL])
    elements = SECTION_ELEMENTS if wing is SECTION else 32
    times = np.concatenate([[0.0], half_chords]) * 0.5 * wing.chords[0]
    start = moving_wing_loads(wing, motion, speed=1.0, elements=elements, times=times, **choice)
    final = moving_wing_loads(
        wing, motion, speed=1.0, elements=elements, instants=3, wake="quasi-steady"
    )
    return np.asarray(start.lift[1:] / final.lift[0])


def _compare() -> Iterator[Comparison]:
    for motion, (heave, pitch) in MOTIONS.items():
        for k in FREQUENCIES:
            yield from _oscillating(motion, k, heave, pitch)
    yield from _starting("a section (Wagner)", SECTION, [wagner_function(s) for s in HALF_CHORDS])
    for aspect_ratio, (share, rate) in ELLIPTIC.items():
        exact = [1.0 - share * float(np.exp(-rate * s)) for s in HALF_CHORDS]
        wing = PlaneWing.elliptic(2.0, aspect_ratio)
        yield from _starting(f"an elliptic wing of aspect ratio {aspect_ratio:g}", wing, exact)


def _oscillating(motion: str, k: float, heave: complex, pitch: complex) -> Iterator[Comparison]:
    loads = {
        name: oscillating_loads(k, heave, pitch, AXIS, choice) for name, choice in CHOICES.items()
    }
    exact = OscillatingSection(k, heave, pitch, AXIS)
    lifts = {name: lift_amplitude(one) for name, one in loads.items()}
    sizes = {name: abs(lift) for name, lift in lifts.items()}
    yield Comparison("C", f"lift amplitude, {motion}, k = {k:g}", "", abs(exact.lift), sizes)
    # Of the angle of the whole turn that is nearest to the exact one's.
    angle = float(np.degrees(np.angle(exact.lift)))
    angles = {
        name: angle + float(np.degrees(np.angle(lift / exact.lift))) for name, lift in lifts.items()
    }
    yield Comparison("C", f"phase of the lift, {motion}, k = {k:g}", "deg", angle, angles)
    thrusts = {name: one.mean_thrust_coefficient / SMALL**2 for name, one in loads.items()}
    yield Comparison("C", f"thrust, {motion}, k = {k:g}", "", exact.thrust, thrusts)


def _starting(what: str, wing: PlaneWing, exact: list[float]) -> Iterator[Comparison]:
    found = {
        name: growing_lift(wing, np.array(HALF_CHORDS), choice) for name, choice in CHOICES.items()
    }
    for i, s in enumerate(HALF_CHORDS):
        computed = {name: float(lift[i]) for name, lift in found.items()}
        yield Comparison("C", f"part of the final lift of {what}, {s:g} half chords after a start",
                         "", exact[i], computed)  # fmt: skip


EXPERIMENT = Experiment(
    "C",
    "sections oscillate and wings start",
    "Theodorsen 1935, Garrick 1936, Wagner 1925; for elliptic wings R. T. Jones 1940",
    _compare,
)
