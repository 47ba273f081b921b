"""The linearised flow along a closed orbit and what is known of its errors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from birdmb._typing import FloatArray
from birdmb.orbits.agreement import jacobian_gaps
from birdmb.orbits.multipliers import MultiplierSolver, Spectrum, product
from birdmb.orbits.result import FloquetResult
from birdmb.orbits.segments import Correction, Segments
from birdmb.orbits.shooting import ShootingEquations

# An orbit that moves by less than this part of the state scale in a period stands still.
_STANDSTILL = 1e-5


def linearise(
    equations: ShootingEquations,
    points: FloatArray,
    period: float,
    solver: MultiplierSolver,
    residual: FloatArray | None = None,
    may_differ: bool = False,
) -> FloquetResult:
    """Linearise the flow along the closed orbit through `points` (M, n).

    `residual` is that of the equations there, if it is known. `may_differ`: where differences of
    the flow contradict the variational equations, take the differences.

    The error bounds hold three parts: the errors of the segment Jacobians (differences: from a
    second estimate; variational: the accuracy that the model declares, the distance from a coarser
    version of it, and from differences of the flow where these contradict), the round-off of the
    eigenvalues, and the error of the orbit: the change of the Jacobians over the Newton correction
    that is left. They do not hold the discretisation of a model that has no coarser version, which
    only its refinement shows.
    """
    segments = equations.segments
    u = equations.pack(points, period)
    if residual is None:
        residual = equations.residual(u)
    ends = equations.ends_of(points, residual)
    factors, curvatures = segments.jacobians_and_curvatures(points, period, ends)
    # Least squares: an orbit that is one of a family (|Lambda| = 1) has a singular Jacobian.
    matrix = equations.assemble(points, period, factors, ends).toarray()
    way = np.linalg.lstsq(matrix, -residual)[0]
    length = float(np.linalg.norm(way))
    correction = Correction(length, lambda reach: equations.unpack(u + way * (reach / length)))
    gaps = np.zeros_like(factors)
    if segments.jacobian_method == "variational":
        gaps = jacobian_gaps(segments, points, period, factors, ends)
        if may_differ and gaps.any():
            instead = equations.by_differences()
            found = linearise(instead, points, period, solver, residual)
            return replace(found, jacobian_gap=_largest(gaps, segments))
    factors, errors = segments.refined(points, period, factors, curvatures, correction)
    errors = errors + gaps
    spectrum = solver(factors, errors, segments.scale)
    return FloquetResult(
        model=segments.model,
        x0=points[0],
        state_names=tuple(segments.model.state_names),
        period=period,
        start_time=segments.start,
        points=points,
        state_scale=segments.scale,
        residual=equations.closure(residual),
        monodromy=product(factors),
        segment_jacobians=factors,
        multipliers=spectrum.multipliers,
        multiplier_errors=spectrum.errors,
        modes=spectrum.modes,
        left_modes=spectrum.left_modes,
        modes_along=spectrum.modes_along,
        trivial_index=_trivial(equations, points, period, spectrum),
        jacobian_method=segments.jacobian_method,
        jacobian_gap=_largest(gaps, segments),
    )


def _largest(gaps: FloatArray, segments: Segments) -> float:
    return float((gaps / np.divide.outer(segments.scale, segments.scale)).max())


def _trivial(
    equations: ShootingEquations, points: FloatArray, period: float, spectrum: Spectrum
) -> int | None:
    if not equations.autonomous:
        return None
    velocity = equations.segments.velocities(points, period)[0]
    return trivial_mode(spectrum, velocity * period, equations.segments.scale)


def trivial_mode(spectrum: Spectrum, velocity: FloatArray, scale: FloatArray) -> int | None:
    """Position of the mode along an autonomous orbit with `velocity` (n,) per period at its start.

    `None` for one that stands still.
    """
    if np.abs(velocity / scale).max() < _STANDSTILL:
        return None
    # The mode along the orbit, not the multiplier nearest 1: at a fold there are two of those.
    return int(np.abs(spectrum.left_modes.conj().T @ velocity).argmax())
