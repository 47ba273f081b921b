"""The appendices: the Roessler system by which the shooting was checked."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial

import numpy as np

from birdmb.orbits import OdeModel, find_limit_cycle
from birdmb.reproduction.published import Case, Published


def roessler(c: float, a: float = 0.15, b: float = 0.2) -> OdeModel:
    """The system x' = -y - z, y' = x + a y, z' = b + z (x - c)."""
    return OdeModel(
        lambda _t, s: [-s[1] - s[2], s[0] + a * s[1], b + s[2] * (s[0] - c)],
        ("x", "y", "z"),
        jacobian=lambda _t, s: np.array([[0, -1, -1], [1, a, 0], [s[2], 0, s[0] - c]]),
    )


# c: start of the search, period (s) and largest non-trivial |multiplier| as printed
ROESSLER = {
    3.5: ((-1.66, 4.24, 0.32), 5.920340, 0.812252),
    5.0: ((5.39, -4.12, 0.13), 11.904275, 0.572052),
}


def _cycle(c: float) -> Mapping[str, float]:
    guess, period, _ = ROESSLER[c]
    cycle = find_limit_cycle(
        roessler(c), np.array(guess), period_guess=round(period, 1), segments=4
    )
    others = np.delete(cycle.multipliers, cycle.trivial_index or 0)
    return {"period": float(cycle.period), "largest |multiplier|": float(np.abs(others).max())}


def _cases() -> Iterator[Case]:
    for c, (_, period, multiplier) in ROESSLER.items():
        yield Case(
            "A",
            f"appendix A, Roessler system, a = 0.15, b = 0.2, c = {c:g}",
            "python -m birdmb.reproduction --figure A.1",
            partial(_cycle, c),
            (
                Published("period", "s", period, 1e-6),
                Published("largest |multiplier|", "", multiplier, 1e-6),
            ),
        )


CASES = tuple(_cases())
