"""A collocated orbit and its Floquet multipliers, with what its nodes leave of error in both."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from birdmb._typing import ComplexArray, FloatArray
from birdmb.orbits.collocation import Collocated, CollocationEquations
from birdmb.orbits.linearisation import trivial_mode
from birdmb.orbits.multipliers import Spectrum, product
from birdmb.orbits.periodic import periodic_multipliers
from birdmb.orbits.variational import flow_jacobians

# The finer multipliers are better, not exact.
_ERROR_PER_DIFFERENCE = 2.0


@dataclass(frozen=True)
class _Linearised:
    factors: FloatArray
    spectrum: Spectrum


def linearise_collocated(
    found: Collocated[CollocationEquations],
    rate_jacobians: FloatArray,
    derivative_gap: float = 0.0,
) -> dict[str, Any]:
    """Linearise the rates along a collocated orbit.

    The multipliers are those of the derivatives at its N nodes. Their error bounds hold what the
    solution and its derivatives on half as many nodes again make of them (twice the difference,
    each multiplier paired with its nearest), the differencing of the right-hand side, the stages of
    the variational equation and the round-off of the eigenvalues. `rate_jacobians` (N, n, n) are
    the derivatives of the rates at the nodes; `derivative_gap` is by how much a derivative that the
    model gives contradicts the differences that are taken instead.

    Returns:
        The fields of a `FloquetResult`, by name.
    """
    equations = found.equations
    points, period = equations.unpack(found.u)
    coarse = _linearised(equations, found.u, rate_jacobians)
    fine = _linearised(found.finer, found.finer_u, found.finer.rate_jacobians(found.finer_u))
    spectrum, scale = coarse.spectrum, equations.rhs.scale
    apart = _distances(spectrum.multipliers, fine.spectrum.multipliers)
    velocity = equations.rates(points, period)[0] * scale
    return {
        "model": equations.rhs.model,
        "x0": points[0] * scale,
        "state_names": tuple(equations.rhs.model.state_names),
        "period": period,
        "start_time": equations.start,
        "points": points * scale,
        "state_scale": scale,
        "residual": found.state_error * float(scale.max()),
        "monodromy": product(coarse.factors),
        "segment_jacobians": coarse.factors,
        "multipliers": spectrum.multipliers,
        "multiplier_errors": spectrum.errors + _ERROR_PER_DIFFERENCE * apart,
        "modes": spectrum.modes,
        "left_modes": spectrum.left_modes,
        "modes_along": spectrum.modes_along,
        "trivial_index": trivial_mode(spectrum, velocity * period, scale)
        if equations.autonomous
        else None,
        "jacobian_method": "variational" if equations.rhs.has_derivative else "finite-differences",
        "jacobian_gap": derivative_gap,
    }


def _linearised(
    equations: CollocationEquations, u: FloatArray, jacobians: FloatArray
) -> _Linearised:
    points, period = equations.unpack(u)
    times, rhs = equations.times(period), equations.rhs
    errors = rhs.jacobian_errors(times, points, jacobians)
    factors, factor_errors = flow_jacobians(period * jacobians)
    # To first order an error of the derivative acts for the length of an interval.
    size = np.maximum(np.abs(factors), np.eye(len(rhs.scale)))
    step = period / equations.nodes
    factor_errors = factor_errors + step * 0.5 * (size @ errors + errors @ size)
    units = np.divide.outer(rhs.scale, rhs.scale)
    spectrum = periodic_multipliers(factors * units, factor_errors * units, rhs.scale)
    return _Linearised(factors * units, spectrum)


def _distances(one: ComplexArray, other: ComplexArray) -> FloatArray:
    """Distances (n,) of a spectrum's members from another's, paired so that the sum is least."""
    distance = np.abs(np.subtract.outer(one, other))
    # Among multipliers of very different size, each by its own.
    size = np.maximum(np.abs(one)[:, None], np.abs(other)[None, :])
    with np.errstate(invalid="ignore"):
        relative = np.nan_to_num(distance / size, nan=0.0)
    rows, columns = linear_sum_assignment(relative)
    return np.asarray(distance[rows, columns])
