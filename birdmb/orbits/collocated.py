"""A collocated orbit and its Floquet multipliers, with what its nodes leave of error in both."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from birdmb._typing import FloatArray
from birdmb.orbits.collocation import CollocationEquations
from birdmb.orbits.enough_nodes import Collocated, more_nodes
from birdmb.orbits.linearisation import trivial_mode
from birdmb.orbits.multipliers import Spectrum, paired_distances, product
from birdmb.orbits.periodic import periodic_multipliers
from birdmb.orbits.result import FloquetResult
from birdmb.orbits.variational import flow_jacobians

# The finer multipliers are better, not exact.
_ERROR_PER_DIFFERENCE = 3.0
# Errors below so many times the accuracy of the states, relative to multipliers above 1, are not
# worth more derivatives.
_GOOD_PER_ACCURACY = 10.0
# More instants that leave more than this part of the error meet another one, as of differences.
_FALLING = 0.5
_MOST_INSTANTS = 1025


@dataclass(frozen=True)
class _Linearised:
    equations: CollocationEquations
    u: FloatArray
    rate_jacobians: FloatArray
    factors: FloatArray
    spectrum: Spectrum


def linearise_collocated(
    found: Collocated[CollocationEquations],
    accuracy: float,
    derivative_gap: float = 0.0,
    rate_jacobians: FloatArray | None = None,
) -> FloquetResult:
    """Linearise the rates along a collocated orbit.

    The multipliers are those of the derivatives at its N nodes. Their error bounds hold what the
    solution and its derivatives on half as many nodes again make of them (three times the
    difference, each multiplier paired with its nearest), the differencing of the right-hand side,
    the stages of the variational equation and the round-off of the eigenvalues. Where the
    derivatives along a smooth orbit are rougher than it is, as those of stiff joints are, they are
    taken at more instants of it, as long as that makes the bounds smaller and they are above ten
    times the `accuracy` of the states; what the error of the orbit makes is then added.
    `derivative_gap` is by how much a derivative that the model gives contradicts the differences
    that are taken instead. `rate_jacobians` (N, n, n) are the derivatives of the rates at the
    nodes, if they are known.
    """
    at = _linearised(found.equations, found.u, rate_jacobians)
    # Of the finest one only the multipliers count, not their errors.
    finer = _linearised(found.finer, found.finer_u, with_errors=False)
    errors = _errors(at.spectrum, finer.spectrum)
    good = _GOOD_PER_ACCURACY * accuracy
    while not _relative(at.spectrum, errors) <= good:
        if more_nodes(finer.equations.nodes) > _MOST_INSTANTS:
            break
        finest = _linearised(*_on_more(finer), with_errors=False)
        finer = _linearised(finer.equations, finer.u, finer.rate_jacobians)
        better = _errors(finer.spectrum, finest.spectrum)
        if not _relative(finer.spectrum, better) < _FALLING * _relative(at.spectrum, errors):
            break
        at, finer, errors = finer, finest, better
    if at.equations is not found.equations:
        # Of one orbit at different instants, its own error does not show.
        rough = _linearised(
            *found.equations.on_nodes(at.equations.nodes, found.u), with_errors=False
        )
        errors = errors + paired_distances(at.spectrum.multipliers, rough.spectrum.multipliers)
    equations, spectrum = at.equations, at.spectrum
    points, period = equations.unpack(at.u)
    scale = equations.rhs.scale
    velocity = equations.rates(points, period)[0] * scale
    return FloquetResult(
        model=equations.rhs.model,
        x0=points[0] * scale,
        state_names=tuple(equations.rhs.model.state_names),
        period=period,
        start_time=equations.start,
        points=points * scale,
        state_scale=scale,
        residual=found.equations.closure(found.residual),
        monodromy=product(at.factors),
        segment_jacobians=at.factors,
        multipliers=spectrum.multipliers,
        multiplier_errors=errors,
        modes=spectrum.modes,
        left_modes=spectrum.left_modes,
        modes_along=spectrum.modes_along,
        trivial_index=trivial_mode(spectrum, velocity * period, scale)
        if equations.autonomous
        else None,
        jacobian_method="variational" if equations.rhs.has_derivative else "finite-differences",
        jacobian_gap=derivative_gap,
    )


def _linearised(
    equations: CollocationEquations,
    u: FloatArray,
    jacobians: FloatArray | None = None,
    *,
    with_errors: bool = True,
) -> _Linearised:
    points, period = equations.unpack(u)
    if jacobians is None:
        jacobians = equations.rate_jacobians(u)
    rhs = equations.rhs
    factors = flow_jacobians(period * jacobians)
    factor_errors = np.zeros_like(factors)
    if with_errors:
        errors = rhs.jacobian_errors(equations.times(period), points, jacobians)
        # To first order an error of the derivative acts for the length of an interval.
        size = np.maximum(np.abs(factors), np.eye(len(rhs.scale)))
        step = period / equations.nodes
        factor_errors = step * 0.5 * (size @ errors + errors @ size)
    units = np.divide.outer(rhs.scale, rhs.scale)
    spectrum = periodic_multipliers(factors * units, factor_errors * units, rhs.scale)
    return _Linearised(equations, u, jacobians, factors * units, spectrum)


def _on_more(at: _Linearised) -> tuple[CollocationEquations, FloatArray]:
    return at.equations.on_nodes(more_nodes(at.equations.nodes), at.u)


def _errors(spectrum: Spectrum, finer: Spectrum) -> FloatArray:
    apart = paired_distances(spectrum.multipliers, finer.multipliers)
    # Of one that happens to be right by chance, the others tell.
    size = np.maximum(np.abs(spectrum.multipliers), np.finfo(float).tiny)
    typical = size * float((apart / np.maximum(size, 1.0)).max())
    return np.asarray(spectrum.errors + _ERROR_PER_DIFFERENCE * np.maximum(apart, typical))


def _relative(spectrum: Spectrum, errors: FloatArray) -> float:
    """Largest error, relative to multipliers above 1."""
    return float((errors / np.maximum(1.0, np.abs(spectrum.multipliers))).max())
