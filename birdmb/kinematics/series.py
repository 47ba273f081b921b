"""A gait over whole beats, fitted to all samples at once by nonlinear least squares."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.prescribed import driver_motion_along
from birdmb.kinematics.observations import Observations, without
from birdmb.topology.samples import series_basis

_LEAST_WEIGHT_SHARE = 0.2  # of the median scatter, below which no marker is believed to scatter
_REWEIGHTINGS = 3


@dataclass(frozen=True)
class Gait:
    """Fourier series of those joints that are solved for; the others follow their drivers.

    Attributes:
        joints: which joints are solved for.
        orders: the highest harmonic of each of them.
        coefficients: (joints, 2 H + 1) mean, cosine, sine, cosine of twice the phase..., rad.
        frequency: Hz.
        middle: time at which the phase is 0, s.
        lead: phase of the others' drivers there, in beats.
    """

    joints: tuple[int, ...]
    orders: tuple[int, ...]
    coefficients: FloatArray
    frequency: float
    middle: float
    lead: float

    @property
    def harmonics(self) -> int:
        """The highest harmonic H that there is room for."""
        return self.coefficients.shape[1] // 2

    @property
    def unknowns(self) -> tuple[IntArray, IntArray]:
        """Row and column in `coefficients` of each that is solved for."""
        columns = np.arange(self.coefficients.shape[1])
        rows, places = np.nonzero(columns <= 2 * np.array(self.orders)[:, None])
        return rows, places

    def phases(self, times: FloatArray) -> FloatArray:
        """Phases (N,), in beats, at times."""
        return self.frequency * (times - self.middle)

    def angles(self, seen: Observations, phases: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Angles and their derivatives by the phase, each (N, A), at `phases` in beats."""
        beat = 2.0 * np.pi / seen.wing.angular_frequency
        angles, rates, _ = driver_motion_along(seen.wing, (phases + self.lead) * beat)
        rates = rates * beat
        basis = series_basis(phases, self.harmonics)
        orders = 2.0 * np.pi * np.arange(1, self.harmonics + 1)
        slope = np.zeros_like(basis)
        slope[:, 1::2], slope[:, 2::2] = -orders * basis[:, 2::2], orders * basis[:, 1::2]
        joints = list(self.joints)
        angles[:, joints] = basis @ self.coefficients.T
        rates[:, joints] = slope @ self.coefficients.T
        return angles, rates

    def with_unknowns(self, solved: FloatArray, span: float) -> Gait:
        """The same with other coefficients and frequency (the last, in beats over `span`)."""
        coefficients = np.zeros_like(self.coefficients)
        coefficients[self.unknowns] = solved[:-1]
        return Gait(
            self.joints, self.orders, coefficients, solved[-1] / span, self.middle, self.lead
        )

    def with_orders(self, orders: tuple[int, ...]) -> Gait:
        """The same with room for other orders."""
        coefficients = np.zeros((len(self.joints), 2 * max(orders) + 1))
        for row, order in enumerate(orders):
            kept = min(2 * order + 1, self.coefficients.shape[1])
            coefficients[row, :kept] = self.coefficients[row, :kept]
        return Gait(self.joints, orders, coefficients, self.frequency, self.middle, self.lead)


@dataclass(frozen=True)
class Solved:
    """A fitted gait with its linearisation.

    Attributes:
        gait: the gait.
        scatter: standard deviation of each marker's or joint's columns.
        residuals: distances (N, R) of the columns, the body's unknown motion taken off.
        weighted: the same times weights.
        slopes: derivatives (N, R, p) of the weighted columns by the unknowns, frequency last.
        spare: degrees of freedom.
    """

    gait: Gait
    scatter: FloatArray
    residuals: FloatArray
    weighted: FloatArray
    slopes: FloatArray
    spare: int

    @property
    def variance(self) -> float:
        """Variance of a weighted residual, 1 where the scatter is what it is taken for."""
        return float(np.sum(self.weighted**2) / max(1, self.spare))

    @property
    def information(self) -> FloatArray:
        """Normal matrix (p, p) of the unknowns."""
        flat = self.slopes.reshape(-1, self.slopes.shape[2])
        return np.asarray(flat.T @ flat)

    @property
    def criterion(self) -> float:
        """Bayesian information criterion; of models with the same weights, the least is best."""
        count = np.count_nonzero(self.weighted)
        left = max(float(np.sum(self.weighted**2)), 1e-30)
        return float(count * np.log(left / count) + self.slopes.shape[2] * np.log(count))


def fit_series(
    seen: Observations, start: Gait, scatter: FloatArray, *, hold_frequency: bool
) -> Solved:
    """Fit a gait to all columns, each weighed by the `scatter` of its marker."""
    problem = _Problem(seen, start, scatter, hold_frequency)
    first = np.append(start.coefficients[start.unknowns], start.frequency * problem.span)
    solved = least_squares(
        problem.residuals, first, problem.jacobian, method="lm", x_scale="jac", xtol=1e-12,
        ftol=1e-12, gtol=1e-12, max_nfev=100,
    )  # fmt: skip
    return problem.solved(solved.x)


def reweighted(seen: Observations, solved: Solved, *, hold_frequency: bool) -> Solved:
    """The fit with each marker weighed by the scatter that it turns out to have."""
    for _ in range(_REWEIGHTINGS):
        scatter = marker_scatter(seen, solved)
        done = np.allclose(scatter, solved.scatter, rtol=0.02)
        solved = fit_series(seen, solved.gait, scatter, hold_frequency=hold_frequency)
        if done:
            break
    return solved


def marker_scatter(seen: Observations, solved: Solved) -> FloatArray:
    """Standard deviation of each marker: of its residuals, by the freedom that the fit left them.

    The trace of the residuals' projector over a marker's columns is its share of that freedom.
    """
    weights = _weights(seen, solved.scatter)
    basis = seen.body_motion_basis(weights, np.nan_to_num(seen.values))
    covariance = np.linalg.pinv(solved.information, hermitian=True)
    known = np.sum((solved.slopes @ covariance) * solved.slopes, axis=2)
    bound = np.sum(basis**2, axis=2) + known
    freedom = np.where(weights > 0.0, 1.0 - bound, 0.0).sum(axis=0)
    squares = np.sum(solved.residuals**2, axis=0)
    count = len(seen.names)
    free = np.bincount(seen.group, freedom, minlength=count)
    found = np.sqrt(np.bincount(seen.group, squares, minlength=count) / np.maximum(free, 1.0))
    of_points = np.arange(count) < len(seen.markers.names)
    for kind in (of_points, ~of_points):
        measured = kind & (free >= 1.0)
        if measured.any():
            found[kind] = np.maximum(found[kind], _LEAST_WEIGHT_SHARE * np.median(found[measured]))
    smallest = np.where(of_points, 1e-9 * seen.reach, 1e-9)
    return np.asarray(np.maximum(found, smallest))


def _weights(seen: Observations, scatter: FloatArray) -> FloatArray:
    return np.asarray(np.isfinite(seen.values) / scatter[seen.group])


class _Problem:
    """Residuals and Jacobian of a gait, for the least squares."""

    def __init__(
        self, seen: Observations, start: Gait, scatter: FloatArray, hold_frequency: bool
    ) -> None:
        self.seen, self.start, self.scatter = seen, start, scatter
        self.span = float(seen.times[-1] - seen.times[0])
        self.weights = _weights(seen, scatter)
        self.values = np.nan_to_num(seen.values)
        self.basis = seen.body_motion_basis(self.weights, self.values)
        self.held = hold_frequency

    def gait(self, unknowns: FloatArray) -> Gait:
        return self.start.with_unknowns(unknowns, self.span)

    def residuals(self, unknowns: FloatArray) -> FloatArray:
        return -self.left(unknowns).ravel()

    def left(self, unknowns: FloatArray) -> FloatArray:
        gait = self.gait(unknowns)
        angles, _ = gait.angles(self.seen, gait.phases(self.seen.times))
        return without(self.basis, (self.values - self.seen.predicted(angles)) * self.weights)

    def jacobian(self, unknowns: FloatArray) -> FloatArray:
        return self.slopes(unknowns).reshape(self.weights.size, -1)

    def slopes(self, unknowns: FloatArray) -> FloatArray:
        gait, seen = self.gait(unknowns), self.seen
        phases = gait.phases(seen.times)
        angles, rates = gait.angles(seen, phases)
        by_angle = seen.derivatives(angles) * self.weights[:, :, None]
        by_angle = without(self.basis, by_angle)
        rows, places = gait.unknowns
        series = series_basis(phases, gait.harmonics)[:, places]
        found = np.empty((*self.weights.shape, len(rows) + 1))
        found[:, :, :-1] = by_angle[:, :, np.array(gait.joints)[rows]] * series[:, None, :]
        joints = by_angle.shape[2]
        drift = (rates[:, :joints] * ((seen.times - gait.middle) / self.span)[:, None])[:, :, None]
        found[:, :, -1] = 0.0 if self.held else (by_angle @ drift)[:, :, 0]
        return found

    def solved(self, unknowns: FloatArray) -> Solved:
        weighted = self.left(unknowns)
        scatter = self.scatter[self.seen.group]
        bound = self.seen.body_motions * int((self.weights > 0.0).any(axis=1).sum())
        spare = int(np.count_nonzero(self.weights)) - bound - len(unknowns) + int(self.held)
        residuals = weighted * scatter
        return Solved(
            self.gait(unknowns), self.scatter, residuals, weighted, self.slopes(unknowns), spare
        )
