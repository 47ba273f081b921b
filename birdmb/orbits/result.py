"""A periodic orbit and what its linearisation says."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.figure import Figure

from birdmb._typing import ComplexArray, FloatArray
from birdmb.orbits import plots
from birdmb.orbits.multipliers import Stability, verdict
from birdmb.orbits.ode import Trajectory
from birdmb.orbits.problem import HasDivergence, HasStateUnits, Model
from birdmb.orbits.segments import JacobianMethod, sample


@dataclass(frozen=True)
class FloquetResult:
    """A periodic orbit of a model and its linearisation.

    Attributes:
        model: the model.
        x0: state (n,) at the start time.
        state_names: names of the n states.
        period: period in s.
        start_time: time of x0 in s.
        points: states (M, n) at the starts of the M shooting segments; the first is x0.
        state_scale: typical sizes (n,) with which states were made comparable.
        residual: largest closure error of a segment, in the units of the states.
        monodromy: derivative (n, n) of the state after a period with respect to x0.
        segment_jacobians: its factors (M, n, n), the first segment first.
        multipliers: eigenvalues (n,) of the monodromy, largest modulus first.
        multiplier_errors: bound (n,) of the error of each multiplier, from the errors of the
            Jacobians, round-off and the closure error, without the model's own discretisation.
        modes: eigenvectors in the columns (n, n), in the order of the multipliers; in each the
            largest entry in units of the state scale is 1.
        left_modes: left eigenvectors in the columns (n, n), with left^H right = 1: what each state
            of a disturbance contributes to the mode.
        modes_along: periodic parts (M, n, n) of the modes at `points`: the modes as the flow
            carries them, divided by exp(exponent * time).
        trivial_index: position of the trivial multiplier of an autonomous cycle, the one along the
            orbit, which is 1 but for errors; `None` where there is none.
        jacobian_method: "variational" or "finite-differences".
    """

    model: Model
    x0: FloatArray
    state_names: tuple[str, ...]
    period: float
    start_time: float
    points: FloatArray
    state_scale: FloatArray
    residual: float
    monodromy: FloatArray
    segment_jacobians: FloatArray
    multipliers: ComplexArray
    multiplier_errors: FloatArray
    modes: ComplexArray
    left_modes: ComplexArray
    modes_along: ComplexArray
    trivial_index: int | None
    jacobian_method: JacobianMethod

    @property
    def verdict_errors(self) -> FloatArray:
        """Errors (n,) of the multipliers that the verdict counts: here `multiplier_errors`.

        A subclass that knows the error of its model's integration adds that.
        """
        return self.multiplier_errors

    @property
    def stability(self) -> Stability:
        """Verdict of the non-trivial multipliers; "undecided" if error bars touch |Lambda| = 1.

        The error bars are `verdict_errors`.
        """
        keep = np.arange(len(self.multipliers)) != self.trivial_index
        return verdict(self.multipliers[keep], self.verdict_errors[keep])

    @property
    def exponents(self) -> ComplexArray:
        """Floquet exponents ln(Lambda)/T, (n,), in 1/s, imaginary part in (-pi/T, pi/T]."""
        with np.errstate(divide="ignore"):
            return np.asarray(np.log(self.multipliers) / self.period)

    @property
    def doubling_times(self) -> FloatArray:
        """Time (n,) in s in which each mode doubles (|Lambda| > 1) or halves: T ln 2/|ln|Lambda||.

        Infinite for |Lambda| = 1.
        """
        with np.errstate(divide="ignore"):
            rate = np.abs(np.log(np.abs(self.multipliers)))
            return np.asarray(self.period * np.log(2) / rate)

    @property
    def time_constants(self) -> FloatArray:
        """Time (n,) in s in which each mode grows or decays by the factor e: 1/|Re exponent|."""
        return np.asarray(self.doubling_times / np.log(2))

    @property
    def participation(self) -> FloatArray:
        """Share (n, n) of each state (row) in each mode (column), columns summing to 1.

        Modulus of left times right eigenvector entries (Perez-Arriaga, Verghese & Schweppe 1982),
        which does not depend on the units of the states.
        """
        share = np.abs(self.left_modes * self.modes)
        return np.asarray(share / share.sum(axis=0))

    @property
    def trivial_error(self) -> float | None:
        """Distance from 1 of the trivial multiplier, a check; `None` where there is none."""
        index = self.trivial_index
        return None if index is None else float(np.abs(self.multipliers[index] - 1))

    def liouville_defect(self) -> float | None:
        """Relative gap between the product of the multipliers and exp(integral of the divergence).

        A check of flow, Jacobians and multipliers (Liouville's formula); `None` if the model does
        not integrate its divergence. Small multipliers must be resolved for it: use segments.
        """
        if not isinstance(self.model, HasDivergence):
            return None
        times = np.linspace(self.start_time, self.start_time + self.period, len(self.points) + 1)
        expected = sum(map(self.model.divergence_integral, self.points, times[:-1], times[1:]))
        with np.errstate(divide="ignore", over="ignore"):
            found = float(np.sum(np.log(np.abs(self.multipliers))))
            return abs(float(np.expm1(found - expected)))

    def trajectory(self, times: npt.ArrayLike | None = None) -> Trajectory:
        """States at `times` (k,) in s, any times: the orbit is continued periodically.

        By default 201 times over the period from the start time. Each segment starts from its own
        point, so that an unstable orbit does not drift off.
        """
        if times is None:
            at = self.start_time + np.linspace(0, self.period, 201)
        else:
            at = np.asarray(times, float)
        m = len(self.points)
        phase = np.mod(at - self.start_time, self.period)
        segment = np.minimum((phase * m / self.period).astype(int), m - 1)
        grid = np.linspace(self.start_time, self.start_time + self.period, m + 1)
        states = np.empty((len(at), len(self.x0)))
        for k in np.unique(segment):
            inside = np.flatnonzero(segment == k)
            ascending, back = np.unique(self.start_time + phase[inside], return_inverse=True)
            ascending = np.clip(ascending, grid[k], grid[k + 1])
            path = sample(self.model, self.points[k], grid[k], ascending, grid[k + 1])
            states[inside] = path[back]
        return Trajectory(at, states)

    def to_xarray(self) -> xr.Dataset:
        """Return the orbit as a labelled dataset with real variables, fit for NetCDF.

        Dimensions: state, state_at_start, multiplier, time. Complex values are split into
        variables that end in `_real` and `_imag`.
        """
        path = self.trajectory()
        units = ("1",) * len(self.x0)
        if isinstance(self.model, HasStateUnits):
            units = tuple(self.model.state_units)
        both = ("state", "multiplier")
        return xr.Dataset(
            {
                "x0": ("state", self.x0),
                "trajectory": (("time", "state"), path.states),
                "monodromy": (("state", "state_at_start"), self.monodromy),
                "multiplier_real": ("multiplier", self.multipliers.real),
                "multiplier_imag": ("multiplier", self.multipliers.imag),
                "multiplier_error": ("multiplier", self.multiplier_errors),
                "exponent_real": ("multiplier", self.exponents.real, {"units": "1/s"}),
                "exponent_imag": ("multiplier", self.exponents.imag, {"units": "1/s"}),
                "doubling_time": ("multiplier", self.doubling_times, {"units": "s"}),
                "mode_real": (both, self.modes.real),
                "mode_imag": (both, self.modes.imag),
                "participation": (both, self.participation),
            },
            coords={
                "state": list(self.state_names),
                "state_at_start": list(self.state_names),
                "state_unit": ("state", list(units)),
                "multiplier": np.arange(len(self.multipliers)),
                "time": ("time", path.times, {"units": "s"}),
            },
            attrs={
                "period": self.period,
                "start_time": self.start_time,
                "residual": self.residual,
                "stability": self.stability,
                "jacobian_method": self.jacobian_method,
                "time_units": "s",
            },
        )

    def plot(self) -> Figure:
        """Draw the states over a period and the multipliers in the unit circle."""
        units = self.model.state_units if isinstance(self.model, HasStateUnits) else None
        return plots.plot_cycle(
            self.trajectory(), self.state_names, units, self.multipliers, self.multiplier_errors
        )
