"""Deflation: the collocation equations without the solutions that are known already.

Source: Farrell, Birkisson & Funke, Deflation techniques for finding distinct solutions of nonlinear
partial differential equations, SIAM J. Sci. Comput. 37 (2015), A2026.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.orbits.collocation import CollocationEquations
from birdmb.orbits.trigonometric import differentiation_matrix, interpolated

# Phases tried for each node before the best one is refined.
_PHASES_PER_NODE = 4
_PHASE_STEPS = 4


@dataclass(frozen=True)
class Known:
    """An orbit, or an equilibrium, that is not to be found again.

    Attributes:
        points: states (N, n) at the nodes, in units of the state scale.
        period: of an autonomous system's orbit, in s; `None` where any period is the same.
    """

    points: FloatArray
    period: float | None = None


@dataclass(frozen=True)
class Apart:
    """How far states along a closed path are from a known orbit.

    Attributes:
        difference: (N, n), in units of the state scale, from the known orbit as it lies nearest: of
            an autonomous system at its best phase, and a whole number of state periods away.
        stretch: logarithm of the ratio of the periods; 0 where they are given or do not matter.
    """

    difference: FloatArray
    stretch: float

    @property
    def squared(self) -> float:
        """Square of the distance: mean over the nodes, with the square of `stretch`."""
        return float(np.sum(self.difference**2)) / len(self.difference) + self.stretch**2


def apart(
    points: FloatArray, period: float, known: Known, repeats: FloatArray, *, any_phase: bool
) -> Apart:
    """What lies between `points` (N, n) and a known orbit, both in units of the state scale.

    `repeats` (n,) are the periods of the states, in the same units; infinite of those that have
    none. `any_phase`: the system is autonomous, so that an orbit is the same wherever it begins.
    """
    reference = known.points + _whole_turns(points, known.points, repeats)
    if any_phase and known.period is not None:
        reference = _at_best_phase(points, reference)
    stretch = 0.0 if known.period is None else math.log(period / known.period)
    return Apart(points - reference, stretch)


def _whole_turns(points: FloatArray, reference: FloatArray, repeats: FloatArray) -> FloatArray:
    turning = np.isfinite(repeats)
    shift = np.zeros(points.shape[1])
    mean = (points - reference).mean(axis=0)[turning]
    shift[turning] = repeats[turning] * np.round(mean / repeats[turning])
    return shift


def _at_best_phase(points: FloatArray, reference: FloatArray) -> FloatArray:
    """The orbit through `reference` (N, n), begun where it comes nearest to `points` (N, n)."""
    nodes = len(points)
    grid = np.arange(nodes) / nodes
    trials = np.arange(_PHASES_PER_NODE * nodes) / (_PHASES_PER_NODE * nodes)
    fine = interpolated(reference, trials)
    gaps = [
        np.sum((np.roll(fine, -k, axis=0)[::_PHASES_PER_NODE] - points) ** 2)
        for k in range(len(trials))
    ]
    phase = float(trials[int(np.argmin(gaps))])
    slopes = differentiation_matrix(nodes) @ reference
    for _ in range(_PHASE_STEPS):
        ahead = interpolated(reference, grid + phase)
        along = interpolated(slopes, grid + phase)
        size = float(np.sum(along**2))
        if size == 0.0:
            break
        phase += float(np.sum(along * (points - ahead))) / size
    return interpolated(reference, grid + phase)


@dataclass(frozen=True)
class Deflated:
    """Collocation equations times the product of 1/d^2 + 1 over known orbits, d from each of them.

    The factor keeps Newton's method away from what is known, where it is infinite, and is 1 far
    from it. `Equations` of `birdmb.orbits.newton`.

    Attributes:
        equations: those deflated.
        known: what their solutions must not be.
        repeats: periods (n,) of the states, in units of the state scale.
    """

    equations: CollocationEquations
    known: tuple[Known, ...]
    repeats: FloatArray

    expensive_jacobian = True

    def residual(self, u: FloatArray) -> FloatArray:
        """Residual (N n,) or (N n + 1,), deflated; `StateError` where it is not defined."""
        residual = self.equations.residual(u)
        return self._factor(u)[0] * residual

    def jacobian(self, u: FloatArray) -> FloatArray:
        """Derivative of the deflated residual."""
        factor, slope = self._factor(u)
        matrix = factor * self.equations.jacobian(u)
        return np.asarray(matrix + np.outer(factor * self.equations.residual(u), slope))

    def start_and_period(self, u: FloatArray) -> tuple[FloatArray, float]:
        """State (n,) at the start, in its own units, and the period."""
        return self.equations.start_and_period(u)

    def closure(self, residual: FloatArray) -> float:
        """Largest mismatch of slopes, deflated."""
        return self.equations.closure(residual)

    def _factor(self, u: FloatArray) -> tuple[float, FloatArray]:
        """The deflating factor and the gradient of its logarithm."""
        points, period = self.equations.unpack(u)
        autonomous = self.equations.autonomous
        factor, slope = 1.0, np.zeros_like(u)
        for known in self.known:
            gap = apart(points, period, known, self.repeats, any_phase=autonomous)
            squared = gap.squared
            if not squared > 0.0:
                raise StateError("This orbit is known already.")
            factor *= 1.0 / squared + 1.0
            gradient = 2.0 * gap.difference.ravel() / len(points)
            if autonomous:
                gradient = np.append(gradient, 2.0 * gap.stretch / u[-1])
            slope -= gradient / (squared * (1.0 + squared))
        return factor, slope
