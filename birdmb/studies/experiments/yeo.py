"""Lift of a rigid wing that flaps in a wind tunnel.

D. Yeo, E. M. Atkins and W. Shyy, AIAA 2011: lift of both wings from nine pressure traces,
digitised, and the flap angle as they fitted it. They give the speed as 2.9 and as 2.8 m/s. Thin
plates stall near 8 degrees, from their leading edges (G. B. McCullough and D. E. Gault, NACA TN
2502, 1951).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from birdmb._typing import FloatArray
from birdmb.orbits.trigonometric import interpolated
from birdmb.studies.experiments.comparison import Comparison, Experiment, WakeChoice, with_stall
from birdmb.studies.moving_wing import PlaneWing, WingMotion, moving_wing_loads
from birdmb.topology import Stall

SPEED, OTHER_SPEED = 2.9, 2.8  # m/s
# Distance from the root, leading and trailing edge behind the root's leading edge, mm.
PLANFORM = (
    (0.0, 0.0, 72.0), (10.0, 0.1, 72.0), (20.0, 0.14, 72.0), (30.0, 0.2, 72.0),
    (40.0, 0.35, 71.96), (50.0, 0.48, 71.46), (60.0, 0.61, 70.85), (70.0, 1.02, 70.09),
    (80.0, 1.27, 69.21), (90.0, 1.54, 68.18), (100.0, 1.81, 67.05), (110.0, 2.38, 65.52),
    (120.0, 2.8, 64.0), (130.0, 3.34, 62.19), (140.0, 3.97, 60.12), (150.0, 4.69, 57.76),
    (160.0, 5.52, 55.03), (170.0, 6.46, 51.84), (180.0, 7.79, 48.07), (190.0, 9.19, 43.41),
    (195.0, 10.11, 40.58), (200.0, 11.23, 37.23), (205.0, 12.68, 33.0), (208.0, 13.87, 29.65),
    (210.0, 14.97, 26.66), (212.0, 16.92, 21.4), (212.9, 18.56, 19.01),
)  # fmt: skip
# Lift, mN, upwards, over a beat in steps of T/100 from t = 0.
LIFT = (
    -75.8, -77.8, -79.2, -79.6, -79.4, -78.2, -76.8, -74.6, -71.8, -68.2,
    -64.9, -62.2, -58.0, -53.5, -49.5, -45.4, -39.7, -33.1, -26.3, -18.8,
    -11.9, -7.7, -1.3, 7.4, 14.6, 20.4, 28.1, 35.8, 43.1, 50.5,
    58.0, 64.4, 68.3, 72.9, 78.9, 85.2, 90.6, 95.7, 101.1, 106.1,
    109.4, 112.3, 115.1, 117.5, 119.6, 120.7, 120.6, 119.2, 117.4, 115.3,
    112.8, 110.6, 109.1, 107.2, 105.2, 103.5, 101.0, 97.8, 95.0, 92.1,
    88.6, 85.5, 82.7, 79.4, 76.2, 72.8, 69.4, 65.8, 62.2, 58.9,
    56.1, 51.5, 46.2, 43.0, 39.0, 35.1, 27.8, 19.7, 13.5, 7.9,
    3.3, -1.6, -4.9, -9.0, -13.2, -17.3, -22.2, -26.9, -31.3, -35.7,
    -39.6, -43.7, -48.2, -53.2, -57.9, -62.1, -65.8, -68.3, -70.2, -72.9,
)  # fmt: skip
# Mean absolute errors over the beat, N.
OTHERS = {"the paper's model": 0.0291, "unsteady vortex lattice": 0.0272}
MOTION = WingMotion(3.3, flap=[0.0354, -0.3793j, -0.0322, 0.0035j, 0.00046])
STALL = Stall(angle=np.radians(8.0))
_TO_SI = 1e-3


def wing(stall: Stall | None = None) -> PlaneWing:
    """The planform, with sections that stall so."""
    positions, leading, trailing = _TO_SI * np.transpose(PLANFORM)
    return PlaneWing(
        positions.tolist(), (trailing - leading).tolist(), leading.tolist(), stall=stall
    )


def measured_lift() -> FloatArray:
    """Lift (100,) N of both wings at even phases of the beat."""
    return np.asarray(_TO_SI * np.array(LIFT))


def computed_lift(
    choice: WakeChoice, speed: float = SPEED, stall: Stall | None = None
) -> FloatArray:
    """Lift (100,) N of both wings at the same phases."""
    loads = moving_wing_loads(wing(stall), MOTION, speed=speed, **choice)
    return interpolated(loads.lift, np.arange(len(LIFT)) / len(LIFT))


def _compare() -> Iterator[Comparison]:
    measured = measured_lift()
    for speed in (SPEED, OTHER_SPEED):
        found = with_stall(STALL, partial(_lift_at, speed))
        yield from _of_speed(f"at {speed:g} m/s", measured, found)


def _lift_at(speed: float, choice: WakeChoice, stall: Stall | None) -> FloatArray:
    return computed_lift(choice, speed, stall)


def _of_speed(at: str, measured: FloatArray, found: dict[str, FloatArray]) -> Iterator[Comparison]:
    for quantity, unit, feature in _FEATURES:
        computed = {name: feature(lift) for name, lift in found.items()}
        yield Comparison("B", f"{quantity} {at}", unit, feature(measured), computed)
    off = {name: lift - measured for name, lift in found.items()}
    errors = {name: float(np.abs(gap).mean()) for name, gap in off.items()}
    yield Comparison("B", f"mean absolute error {at}", "N", 0.0, errors, OTHERS)
    errors = {name: float(np.abs(gap - gap.mean()).mean()) for name, gap in off.items()}
    yield Comparison("B", f"the same of the lift less its mean {at}", "N", 0.0, errors)


def _first_harmonic(lift: FloatArray) -> complex:
    return complex(2.0 * np.fft.rfft(lift)[1] / len(lift))


def _peak(lift: FloatArray) -> float:
    return float(-np.angle(_first_harmonic(lift)) / (2.0 * np.pi)) % 1.0


_FEATURES: tuple[tuple[str, str, Callable[[FloatArray], float]], ...] = (
    ("mean lift", "N", lambda lift: float(lift.mean())),
    ("root mean square of the lift", "N", lambda lift: float(np.sqrt((lift**2).mean()))),
    ("largest lift", "N", lambda lift: float(lift.max())),
    ("smallest lift", "N", lambda lift: float(lift.min())),
    ("first harmonic of the lift", "N", lambda lift: abs(_first_harmonic(lift))),
    ("its maximum", "beats", _peak),
)

EXPERIMENT = Experiment(
    "B", "a rigid wing flaps in a wind tunnel", "D. Yeo, E. M. Atkins and W. Shyy 2011", _compare
)
