"""The linearised flow along a closed orbit and what is known of its errors."""

from __future__ import annotations

from typing import Any

import numpy as np

from birdmb._typing import FloatArray
from birdmb.orbits.multipliers import MultiplierSolver, Spectrum, product
from birdmb.orbits.shooting import ShootingEquations

# Displacement, in units of the state scale, over which the change of the Jacobians is observed.
_PROBE = 1e-5
# An orbit that moves by less than this part of the state scale in a period stands still.
_STANDSTILL = 1e-5


def linearise(
    equations: ShootingEquations, points: FloatArray, period: float, solver: MultiplierSolver
) -> dict[str, Any]:
    """Linearise the flow along the closed orbit through `points` (M, n).

    The error bounds hold three parts: the errors of the segment Jacobians (differences: from a
    second step; variational: the accuracy that the model declares), the round-off of the
    eigenvalues, and the error of the orbit: the Newton correction that is left, times the change of
    the Jacobians seen over a small displacement along it. They do not hold the discretisation of
    the model itself, which only its refinement shows.

    Returns:
        The fields of a `FloquetResult`, by name.
    """
    segments = equations.segments
    factors, errors = segments.jacobians_and_errors(points, period)
    u = equations.pack(points, period)
    residual = equations.residual(u)
    # Least squares: an orbit that is one of a family (|Lambda| = 1) has a singular Jacobian.
    matrix = equations.assemble(points, period, factors).toarray()
    correction = np.linalg.lstsq(matrix, -residual)[0]
    length = float(np.linalg.norm(correction))
    if length > 0:
        displaced = equations.unpack(u + correction * (_PROBE / length))
        errors = errors + np.abs(segments.jacobians(*displaced) - factors) * (length / _PROBE)
    spectrum = solver(factors, errors, segments.scale)
    return {
        "model": segments.model,
        "x0": points[0],
        "state_names": tuple(segments.model.state_names),
        "period": period,
        "start_time": segments.start,
        "points": points,
        "state_scale": segments.scale,
        "residual": equations.closure(residual),
        "monodromy": product(factors),
        "segment_jacobians": factors,
        "multipliers": spectrum.multipliers,
        "multiplier_errors": spectrum.errors,
        "modes": spectrum.modes,
        "left_modes": spectrum.left_modes,
        "modes_along": spectrum.modes_along,
        "trivial_index": _trivial(equations, points, period, spectrum),
        "jacobian_method": segments.jacobian_method,
    }


def _trivial(
    equations: ShootingEquations, points: FloatArray, period: float, spectrum: Spectrum
) -> int | None:
    if not equations.autonomous:
        return None
    velocity = equations.segments.velocities(points, period)[0]
    if np.abs(velocity * period / equations.segments.scale).max() < _STANDSTILL:
        return None
    # The mode along the orbit, not the multiplier nearest 1: at a fold there are two of those.
    return int(np.abs(spectrum.left_modes.conj().T @ velocity).argmax())
