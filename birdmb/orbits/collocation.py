"""The Fourier collocation equations of a periodic orbit."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.orbits.newton import Linear
from birdmb.orbits.right_hand_side import RightHandSide
from birdmb.orbits.trigonometric import differentiation_matrix, resampled

_EPS = float(np.finfo(float).eps)
# Round-off of the residual, in units of machine precision times its largest term.
_NOISE = 100.0


class LatestJacobians:
    """The derivatives of the rates that a search took last."""

    jacobians: FloatArray | None = None


class _Latest(LatestJacobians):
    """What was evaluated last: a residual and a Jacobian at the same point share the rates."""

    period = math.nan
    points = rates = np.empty(0)


@dataclass(frozen=True)
class CollocationEquations:
    """D X = T f(t, X) at N equidistant nodes, D the trigonometric differentiation matrix.

    Unknowns: the states at the nodes in units of the scale and, for an autonomous system, the
    period in units of `period`. Residual: the mismatch of the slopes by phase, in the same units,
    divided by the root of N so that its norm does not depend on N. The phase of an autonomous orbit
    is fixed as in shooting: a step is orthogonal to the velocities along the iterate itself, and
    that row of the residual is always zero (Doedel, Keller & Kernevez 1991).
    """

    rhs: RightHandSide
    start: float
    period: float
    autonomous: bool
    nodes: int
    latest: _Latest = field(default_factory=_Latest, repr=False, compare=False)

    # One Jacobian costs 2 n residuals where it is taken by differences, and an LU anyway.
    expensive_jacobian = True

    def on_nodes(self, nodes: int, u: FloatArray) -> tuple[CollocationEquations, FloatArray]:
        """The same equations and unknowns on other nodes."""
        points, period = self.unpack(u)
        other = self.with_nodes(nodes)
        return other, other.pack(resampled(points, nodes), period)

    def with_nodes(self, nodes: int) -> CollocationEquations:
        """The same equations on other nodes."""
        return replace(self, nodes=nodes, latest=_Latest())

    def by_differences(self) -> CollocationEquations:
        """The same equations with derivatives of the rates by differences."""
        return replace(self, rhs=replace(self.rhs, by_differences=True), latest=_Latest())

    def pack(self, points: FloatArray, period: float) -> FloatArray:
        """Unknowns of the orbit with scaled states `points` (N, n)."""
        return (
            np.append(points.ravel(), period / self.period) if self.autonomous else points.ravel()
        )

    def unpack(self, u: FloatArray) -> tuple[FloatArray, float]:
        """Scaled states (N, n) and period of the unknowns."""
        period = self.period
        if self.autonomous:
            u, period = u[:-1], float(u[-1]) * self.period
        return u.reshape(self.nodes, -1), period

    def times(self, period: float) -> FloatArray:
        """Times (N,) of the nodes in s."""
        return self.start + period * np.arange(self.nodes) / self.nodes

    def start_and_period(self, u: FloatArray) -> tuple[FloatArray, float]:
        """State (n,) at the start, in its own units, and the period."""
        points, period = self.unpack(u)
        return points[0] * self.rhs.scale, period

    def path(self, u: FloatArray) -> FloatArray:
        """States (N, n) at the nodes, in their own units."""
        return self.unpack(u)[0] * self.rhs.scale

    def closure(self, residual: FloatArray) -> float:
        """Largest mismatch of slopes, in the units of the states per period."""
        gaps = residual[:-1] if self.autonomous else residual
        gaps = gaps.reshape(self.nodes, -1) * self.rhs.scale * np.sqrt(self.nodes)
        return float(np.abs(gaps).max())

    def rates(self, points: FloatArray, period: float) -> FloatArray:
        """Rates (N, n) of scaled states per second at the nodes; raises `StateError`."""
        latest = self.latest
        if latest.period != period or not np.array_equal(latest.points, points):
            latest.rates = self.rhs.rates(self.times(period), points)
            latest.points, latest.period = points.copy(), period
        return latest.rates

    def residual(self, u: FloatArray) -> FloatArray:
        """Scaled mismatch of slopes; StateError where the right-hand side fails."""
        points, period = self.unpack(u)
        if not period > 0:
            raise StateError(f"The period {period:.6g} is not positive.")
        gaps = differentiation_matrix(self.nodes) @ points - period * self.rates(points, period)
        scaled = gaps.ravel() / np.sqrt(self.nodes)
        return np.append(scaled, 0.0) if self.autonomous else scaled

    def jacobian(self, u: FloatArray) -> FloatArray:
        """Derivative of the residual."""
        self.latest.jacobians = self.rate_jacobians(u)
        return self.assemble(u, self.latest.jacobians)

    def rate_jacobians(self, u: FloatArray) -> FloatArray:
        """Derivatives (N, n, n) of the rates by the scaled states at the nodes."""
        points, period = self.unpack(u)
        return self.rhs.jacobians(self.times(period), points)

    def derivative_gap(self, u: FloatArray) -> float:
        """By how much a derivative that the model gives contradicts differences; 0 if it agrees."""
        points, period = self.unpack(u)
        return self.rhs.derivative_gap(self.times(period), points)

    def assemble(self, u: FloatArray, rate_jacobians: FloatArray) -> FloatArray:
        """Derivative of the residual from the derivatives (N, n, n) of the rates."""
        points, period = self.unpack(u)
        nodes, n = points.shape
        blocks = differentiation_matrix(nodes)[:, None, :, None] * np.eye(n)[None, :, None, :]
        at = np.arange(nodes)
        blocks[at, :, at, :] -= period * rate_jacobians
        matrix = blocks.reshape(nodes * n, nodes * n) / np.sqrt(nodes)
        if not self.autonomous:
            return np.asarray(matrix)
        rates = self.rates(points, period)
        stretch = -self.period * rates.ravel() / np.sqrt(self.nodes)
        phase = rates.ravel() / (np.linalg.norm(rates) or 1.0)
        return np.block([[matrix, stretch[:, None]], [phase[None, :], np.zeros((1, 1))]])

    def product(self, u: FloatArray, rate_jacobians: FloatArray) -> Linear:
        """What the derivative makes of a change of the unknowns, without its matrix."""
        if self.autonomous:
            return self.assemble(u, rate_jacobians).__matmul__
        by_phase = self.period * rate_jacobians

        def slopes(change: FloatArray) -> FloatArray:
            points = change.reshape(self.nodes, -1)
            along = differentiation_matrix(self.nodes) @ points
            along -= (by_phase @ points[:, :, None])[:, :, 0]
            return along.ravel() / np.sqrt(self.nodes)

        return slopes

    def round_off(self, u: FloatArray) -> float:
        """Norm that round-off leaves of the residual."""
        points, period = self.unpack(u)
        slopes = period * self.rates(points, period)
        largest = self.nodes * np.abs(points).max() + np.abs(slopes).max()
        return float(_NOISE * _EPS * largest)
