"""A collocated orbit and its Floquet multipliers, with what its nodes leave of error in both."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from birdmb._typing import ComplexArray, FloatArray
from birdmb.orbits.collocation import CollocationEquations
from birdmb.orbits.enough_nodes import Collocated, more_nodes
from birdmb.orbits.linearisation import trivial_mode
from birdmb.orbits.multipliers import Spectrum, paired_distances, product
from birdmb.orbits.periodic import periodic_eigenvalues, periodic_multipliers
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
# Derivatives that miss more than this between nodes make growth of decay.
_MOST_UNSEEN = 1.0
# Larger errors say nothing of what more instants will make of them.
_KNOWN = 0.1


@dataclass(frozen=True)
class _Multipliers:
    equations: CollocationEquations
    u: FloatArray
    rate_jacobians: FloatArray
    multipliers: ComplexArray


@dataclass(frozen=True)
class _Linearised:
    equations: CollocationEquations
    u: FloatArray
    factors: FloatArray
    spectrum: Spectrum
    unseen: float


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
    finer = _multipliers(found.finer, found.finer_u)
    errors = _errors(at, finer.multipliers)
    good = _GOOD_PER_ACCURACY * accuracy
    while not _relative(at.spectrum, errors) <= good:
        if more_nodes(finer.equations.nodes) > _MOST_INSTANTS:
            break
        finest = _multipliers(*_on_more(finer))
        better = _linearised(finer.equations, finer.u, finer.rate_jacobians)
        left = _errors(better, finest.multipliers)
        before = _relative(at.spectrum, errors)
        if before < _KNOWN and not _relative(better.spectrum, left) < _FALLING * before:
            break
        at, finer, errors = better, finest, left
    if at.equations is not found.equations:
        # Of one orbit at different instants, its own error does not show.
        rough = _multipliers(*found.equations.on_nodes(at.equations.nodes, found.u))
        errors = errors + paired_distances(at.spectrum.multipliers, rough.multipliers)
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
    equations: CollocationEquations, u: FloatArray, jacobians: FloatArray | None
) -> _Linearised:
    points, period = equations.unpack(u)
    if jacobians is None:
        jacobians = equations.rate_jacobians(u)
    rhs = equations.rhs
    factors = flow_jacobians(period * jacobians)
    errors = rhs.jacobian_errors(equations.times(period), points, jacobians)
    # To first order an error of the derivative acts for the length of an interval.
    size = np.maximum(np.abs(factors), np.eye(len(rhs.scale)))
    factor_errors = period / equations.nodes * 0.5 * (size @ errors + errors @ size)
    units = np.divide.outer(rhs.scale, rhs.scale)
    spectrum = periodic_multipliers(factors * units, factor_errors * units, rhs.scale)
    return _Linearised(equations, u, factors * units, spectrum, _unseen(period * jacobians))


def _multipliers(equations: CollocationEquations, u: FloatArray) -> _Multipliers:
    _, period = equations.unpack(u)
    jacobians = equations.rate_jacobians(u)
    factors = flow_jacobians(period * jacobians)
    return _Multipliers(equations, u, jacobians, periodic_eigenvalues(factors))


def _on_more(at: _Multipliers) -> tuple[CollocationEquations, FloatArray]:
    return at.equations.on_nodes(more_nodes(at.equations.nodes), at.u)


def _errors(at: _Linearised, finer: ComplexArray) -> FloatArray:
    spectrum = at.spectrum
    apart = paired_distances(spectrum.multipliers, finer)
    # Of one that happens to be right by chance, the others tell.
    size = np.maximum(np.abs(spectrum.multipliers), np.finfo(float).tiny)
    typical = size * float((apart / np.maximum(size, 1.0)).max())
    errors = np.asarray(spectrum.errors + _ERROR_PER_DIFFERENCE * np.maximum(apart, typical))
    # Two wrong interpolants may agree.
    return errors if at.unseen < _MOST_UNSEEN else np.maximum(errors, at.unseen)


def _unseen(rate_jacobians: FloatArray) -> float:
    """By how much the derivatives (N, n, n) by phase are off between nodes, per interval.

    About the largest amplitude of their two highest harmonics.
    """
    nodes = len(rate_jacobians)
    highest = np.abs(np.fft.rfft(rate_jacobians, axis=0)[-2:])
    return float(highest.sum(axis=2).max()) * 2.0 / nodes**2


def _relative(spectrum: Spectrum, errors: FloatArray) -> float:
    """Largest error, relative to multipliers above 1."""
    return float((errors / np.maximum(1.0, np.abs(spectrum.multipliers))).max())
