"""The rigid bird with the circulation as the published program solved it: relaxed, and stopped."""

from __future__ import annotations

from typing import Any

import numpy as np

from birdmb._typing import FloatArray
from birdmb.aerodynamics.prescribed import PrescribedWing, at_phase
from birdmb.aerodynamics.twist_loads import wing_flow
from birdmb.models import RigidModel
from birdmb.topology import Bird
from birdmb.wing.arrays import WingArrays

_RELAXATION, _MOST_ITERATIONS = 0.1, 50
_NO_DERIVATIVES = np.empty(0, int)


class StoppedCirculation(RigidModel):
    """The rigid bird with a circulation from n steps of Γ ← Γ + 0.1 (b - A Γ), from zero on.

    After them Γ = (1 - (1 - 0.1 A)^n) A⁻¹ b. As in the published program, n at each phase is the
    first at which the mean change is less than `stop_at` of the mean circulation, 50 at most; here
    it is counted in one steady flight, so that loads do not jump where another state would need one
    step more.
    """

    def __init__(self, bird: Bird, *, stop_at: float, **options: Any) -> None:
        super().__init__(bird, **options)
        self._stop_at = stop_at
        u, w, _, _ = RigidModel(bird).initial_guess()
        self._steady = np.array([u, 0.0, w, 0.0, 0.0, 0.0])

    def _options(self) -> dict[str, Any]:
        return {**super()._options(), "stop_at": self._stop_at}

    def _wing_at(self, arrays: WingArrays, times: FloatArray) -> PrescribedWing:
        wing = super()._wing_at(arrays, times)
        inverse = [self._stopped(wing, k) for k in range(times.size)]
        return wing._replace(inverse=np.array(inverse))

    def _stopped(self, wing: PrescribedWing, k: int) -> FloatArray:
        """Matrix (N, N) that makes the stopped circulation of that without downwash."""
        elements, exact = at_phase(wing.elements, k), wing.inverse[k]
        bound = wing_flow(elements, elements.velocity, self._steady, _NO_DERIVATIVES).bound[:, 0]
        identity = np.eye(bound.size)
        step = identity - _RELAXATION * np.linalg.inv(exact)
        circulation, left = np.zeros(bound.size), identity
        for _ in range(_MOST_ITERATIONS):
            left = left @ step
            before, circulation = circulation, (identity - left) @ exact @ bound
            change = np.abs(circulation - before).mean()
            if change <= self._stop_at * np.abs(circulation).mean():
                break
        return np.asarray((identity - left) @ exact)
