"""Appendices A, B and E: systems by which the orbits, multipliers and exponents were checked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from birdmb.orbits import LimitCycle, OdeModel, find_limit_cycle
from birdmb.reproduction.published import Case, Published


@dataclass(frozen=True)
class RoesslerCase:
    """Parameters of a Roessler system, where to look for its cycle, and what is printed of it."""

    a: float
    c: float
    guess: tuple[float, float, float]
    period: float
    multiplier: float
    b: float = 0.2

    @property
    def name(self) -> str:
        """The parameters as text."""
        return f"a = {self.a:g}, b = {self.b:g}, c = {self.c:g}"


ROESSLER = (
    RoesslerCase(0.15, 3.5, (-1.66, 4.24, 0.32), 5.920340, 0.812252),
    RoesslerCase(0.15, 5.0, (5.39, -4.12, 0.13), 11.904275, 0.572052),
    RoesslerCase(0.2, 4.5, (-1.41, 5.09, 0.53), 5.843970, 1.918286),
)


def roessler(a: float, b: float, c: float) -> OdeModel:
    """The system x' = -y - z, y' = x + a y, z' = b + z (x - c)."""
    return OdeModel(
        lambda _t, s: [-s[1] - s[2], s[0] + a * s[1], b + s[2] * (s[0] - c)],
        ("x", "y", "z"),
        jacobian=lambda _t, s: np.array([[0, -1, -1], [1, a, 0], [s[2], 0, s[0] - c]]),
    )


def roessler_cycle(case: RoesslerCase) -> LimitCycle:
    """The cycle of one of the printed cases."""
    return find_limit_cycle(
        roessler(case.a, case.b, case.c),
        np.array(case.guess),
        period_guess=round(case.period, 1),
        segments=4,
    )


def redox() -> OdeModel:
    """Circadian redox oscillator (del Olmo, Kramer and Herzel 2019), time in h."""
    p, a, b, d, e, q = 1.0, 1000.0, 2.0, 0.2, 0.1, 0.1
    return OdeModel(
        lambda _t, s: [
            p - a * s[3] * s[0] - d * s[0],
            d * s[0] - e * s[1],
            e * s[1] - q * s[2],
            b * (1 - s[3]) * s[2] - a * s[3] * s[0],
        ],
        ("D1", "D2", "R", "A"),
        jacobian=lambda _t, s: np.array(
            [
                [-a * s[3] - d, 0, 0, -a * s[0]],
                [d, -e, 0, 0],
                [0, e, -q, 0],
                [-a * s[3], 0, b * (1 - s[3]), -b * s[2] - a * s[0]],
            ]
        ),
        guess=[0.5, 0.5, 0.6, 0.2],
        integrator="LSODA",  # stiff: rates from 0.1 to 1000 per h
        rtol=1e-9,
        atol=1e-12,
    )


def redox_cycle() -> LimitCycle:
    """The cycle of the redox oscillator."""
    return find_limit_cycle(
        redox(), period_guess=23.0, segments=4, damping="levenberg-marquardt", tolerance=1e-7
    )


def _of_roessler(case: RoesslerCase) -> Mapping[str, float]:
    cycle = roessler_cycle(case)
    others = np.delete(cycle.multipliers, cycle.trivial_index or 0)
    return {"period": float(cycle.period), "largest |multiplier|": float(np.abs(others).max())}


def _cases() -> Iterator[Case]:
    for number, case in enumerate(ROESSLER, 1):
        yield Case(
            "A",
            f"appendix A, Roessler system, case {number}: {case.name}",
            f"python -m birdmb.reproduction --figure A.{number}",
            partial(_of_roessler, case),
            (
                Published("period", "s", case.period, 1e-6),
                Published("largest |multiplier|", "", case.multiplier, 1e-6),
            ),
        )


CASES = tuple(_cases())
