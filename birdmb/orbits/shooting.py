"""The multiple-shooting equations, for a known and for an unknown period."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.orbits.segments import Segments


@dataclass(frozen=True)
class ShootingEquations:
    """Closure of M segments (Seydel 2010, chapter 7; Keller 1968).

    Unknowns: the states at the starts of the segments in units of the state scale and, for an
    autonomous system, the period in units of `period`. Residual: flow(x_k) - x_{k+1} in the same
    units, the last segment closing on the first point. The phase of an autonomous orbit is fixed by
    asking that a step be orthogonal to the velocities along the iterate itself (a Poincare
    condition that moves with it), so that row of the residual is always zero.
    """

    segments: Segments
    period: float
    autonomous: bool

    def by_differences(self) -> ShootingEquations:
        """The same equations with Jacobians by differences of the flow."""
        return replace(self, segments=replace(self.segments, jacobian_method="finite-differences"))

    def pack(self, points: FloatArray, period: float) -> FloatArray:
        """Unknowns of the orbit through `points` (M, n)."""
        u = (points / self.segments.scale).ravel()
        return np.append(u, period / self.period) if self.autonomous else u

    def unpack(self, u: FloatArray) -> tuple[FloatArray, float]:
        """Points (M, n) and period of the unknowns."""
        period = self.period
        if self.autonomous:
            u, period = u[:-1], float(u[-1]) * self.period
        scale = self.segments.scale
        return u.reshape(-1, len(scale)) * scale, period

    @property
    def expensive_jacobian(self) -> bool:
        """Differences cost 2 n flows for each segment, variational equations about one."""
        return self.segments.jacobian_method == "finite-differences"

    def start_and_period(self, u: FloatArray) -> tuple[FloatArray, float]:
        """State (n,) at the start and the period."""
        points, period = self.unpack(u)
        return points[0], period

    def closure(self, residual: FloatArray) -> float:
        """Largest closure error in the units of the states."""
        gaps = residual[:-1] if self.autonomous else residual
        return float(np.abs(gaps.reshape(-1, len(self.segments.scale)) * self.segments.scale).max())

    def residual(self, u: FloatArray) -> FloatArray:
        """Scaled closure errors; StateError where the flow fails or the period is not positive."""
        points, period = self.unpack(u)
        if not period > 0:
            raise StateError(f"The period {period:.6g} is not positive.")
        gaps = self.segments.ends(points, period) - np.roll(points, -1, axis=0)
        scaled = (gaps / self.segments.scale).ravel()
        return np.append(scaled, 0.0) if self.autonomous else scaled

    def ends_of(self, points: FloatArray, residual: FloatArray) -> FloatArray:
        """Ends (M, n) of the segments from `points` (M, n) that leave this residual."""
        gaps = residual[: points.size].reshape(points.shape) * self.segments.scale
        return np.asarray(np.roll(points, -1, axis=0) + gaps)

    def jacobian(self, u: FloatArray) -> sp.csc_array:
        """Derivative of the residual."""
        points, period = self.unpack(u)
        return self.assemble(points, period, self.segments.jacobians(points, period))

    def assemble(
        self,
        points: FloatArray,
        period: float,
        factors: FloatArray,
        ends: FloatArray | None = None,
    ) -> sp.csc_array:
        """Derivative of the residual from the segment Jacobians (M, n, n), and ends if known."""
        m, n = points.shape
        scale = self.segments.scale
        following = np.roll(np.arange(m), -1)
        shift = sp.kron(
            sp.coo_array((np.ones(m), (np.arange(m), following)), shape=(m, m)), sp.eye_array(n)
        )
        units = np.divide.outer(scale, scale)
        # Dense blocks would come back as a matrix of the old kind, of which scipy warns.
        matrix = sp.block_diag([sp.coo_array(factor / units) for factor in factors]) - shift
        if self.autonomous:
            if ends is None:
                ends = self.segments.ends(points, period)
            stretch = self.segments.velocities(ends, period) * (self.period / m) / scale
            phase = (self.segments.velocities(points, period) / scale).ravel()
            phase /= np.linalg.norm(phase) or 1.0
            matrix = sp.block_array(
                [
                    [matrix, sp.coo_array(stretch.reshape(-1, 1))],
                    [sp.coo_array(phase[None, :]), None],
                ]
            )
        return sp.csc_array(matrix)
