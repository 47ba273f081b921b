"""The monodromy of a closed orbit and what is known of its errors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from birdmb._typing import FloatArray
from birdmb.orbits.multipliers import Spectrum, product, product_error, spectrum
from birdmb.orbits.shooting import ShootingEquations

# Displacement, in units of the state scale, over which the change of the Jacobians is observed.
_PROBE = 1e-5


@dataclass(frozen=True)
class Linearisation:
    """Segment Jacobians (M, n, n), bounds of their entries' errors, and the spectrum."""

    factors: FloatArray
    factor_errors: FloatArray
    spectrum: Spectrum


def linearise(equations: ShootingEquations, points: FloatArray, period: float) -> Linearisation:
    """Linearise the flow along a closed orbit given by `points` (M, n).

    The errors hold three parts: that of the segment Jacobians (differences: from a second step;
    variational: the accuracy that the model declares), the round-off of product and eigenvalues,
    and the error of the orbit: the Newton correction that is left, times the change of the
    Jacobians seen over a small displacement along it. They do not hold the discretisation of the
    model itself, which only its refinement shows.
    """
    segments = equations.segments
    factors, errors = segments.jacobians_and_errors(points, period)
    residual = equations.residual(equations.pack(points, period))
    # Least squares: an orbit that is one of a family (|Lambda| = 1) has a singular Jacobian.
    matrix = equations.assemble(points, period, factors).toarray()
    correction = np.linalg.lstsq(matrix, -residual)[0]
    length = float(np.linalg.norm(correction))
    if length > 0:
        u = equations.pack(points, period) + correction * (_PROBE / length)
        change = segments.jacobians(*equations.unpack(u)) - factors
        errors = errors + np.abs(change) * (length / _PROBE)
    return Linearisation(
        factors,
        errors,
        spectrum(product(factors), product_error(factors, errors), segments.scale),
    )
