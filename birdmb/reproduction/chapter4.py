"""Chapter 4: the Poincaré oscillator, whose multiplier is exp(-λ A T)."""

from __future__ import annotations

import numpy as np

from birdmb.orbits import OdeModel

RELAXATION, AMPLITUDE, PERIOD = 0.5, 1.0, 2 * np.pi


def poincare_oscillator() -> OdeModel:
    """The system r' = λ r (A - r), φ' = 2π/T in Cartesian coordinates."""

    def rhs(_t: float, s: np.ndarray) -> np.ndarray:
        r = np.hypot(*s)
        growth, turn = RELAXATION * (AMPLITUDE - r), 2 * np.pi / PERIOD
        return np.array([growth * s[0] - turn * s[1], turn * s[0] + growth * s[1]])

    return OdeModel(rhs, ("x", "y"), guess=[1.2, 0.0])
