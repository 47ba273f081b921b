"""A periodic orbit and what its linearisation says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
import xarray as xr

from birdmb._typing import ComplexArray, FloatArray
from birdmb.orbits.cycle_dataset import OF_STATE, described, stored_orbit
from birdmb.orbits.multipliers import Stability, verdict
from birdmb.orbits.ode import Trajectory
from birdmb.orbits.periodicity import turns
from birdmb.orbits.problem import HasDivergence, HasStateUnits, Model
from birdmb.orbits.segments import JacobianMethod, sample
from birdmb.summary import Fact, Summarised, with_error

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FAR_OUTSIDE = 10.0


@dataclass(frozen=True, repr=False)
class FloquetResult(Summarised):
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
        jacobian_gap: largest distance, in state scales, of the variational Jacobians from
            differences of the flow where these contradict; 0 where they agree. If the multipliers
            are from the variational Jacobians, the error bounds hold it.
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
    jacobian_gap: float

    def __post_init__(self) -> None:
        """Lay all arrays out alike, so that sums over those of a file have the same last bits."""
        for each in fields(self):
            value = getattr(self, each.name)
            if isinstance(value, np.ndarray):
                object.__setattr__(self, each.name, np.ascontiguousarray(value))

    def _summary(self) -> Iterator[Fact]:
        yield Fact("verdict", self.stability)
        yield largest_modulus(self)
        yield Fact("period", f"{self.period:.6g}", "s")
        yield from self._summary_of_search()
        yield Fact("states", str(len(self.state_names)))

    def _summary_of_search(self) -> Iterator[Fact]:
        """How the orbit was found; nothing of one that was given."""
        yield from ()

    def __str__(self) -> str:
        """Return the verdict, the period, the multipliers with their errors, and the remarks."""
        lines = [f"{self.stability}, period {self.period:.9g} s, multipliers"]
        for value, error in zip(self.multipliers, self.verdict_errors, strict=True):
            shown = f"{value.real:.9g}" if value.imag == 0 else f"{value:.9g}"
            lines.append(f"  {shown} +- {error:.1e}")
        return "\n".join([*lines, *self.remarks])

    @property
    def verdict_errors(self) -> FloatArray:
        """Errors (n,) of the multipliers that the verdict counts: here `multiplier_errors`.

        A subclass that knows the error of its model's integration adds that.
        """
        return self.multiplier_errors

    @property
    def stability(self) -> Stability:
        """Verdict of the non-trivial multipliers; "undecided" if error bars touch |Lambda| = 1.

        The error bars are `verdict_errors`. A trivial multiplier far outside its own shows that
        they do not hold, and leaves the verdict undecided too.
        """
        if self._trivial_is_off:
            return "undecided"
        keep = np.arange(len(self.multipliers)) != self.trivial_index
        return verdict(self.multipliers[keep], self.verdict_errors[keep])

    @property
    def _trivial_is_off(self) -> bool:
        index, error = self.trivial_index, self.trivial_error
        if index is None or error is None:
            return False
        return bool(error > _FAR_OUTSIDE * self.verdict_errors[index])

    @property
    def _consequence(self) -> str:
        if self.jacobian_method == "finite-differences":
            return "The multipliers are those of the differences."
        return 'The error bars hold this; jacobian="finite-differences" does without them.'

    @cached_property
    def minimal_period(self) -> float:
        """Period in s after which the orbit first repeats: `period`, or up to a twelfth of it.

        Of a forced system only a period counts in which the right-hand side repeats too.
        """
        return self.period / turns(
            self.model,
            lambda times: self.trajectory(times).states,
            self.state_scale,
            self.start_time,
            self.period,
        )

    @property
    def remarks(self) -> tuple[str, ...]:
        """What to know before the numbers are used, one sentence each; empty if all is well."""
        remarks = []
        if self._trivial_is_off:
            remarks.append(
                f"The trivial multiplier is off 1 by {self.trivial_error:.1e}, far more than its "
                f"error bar: do not trust the others to theirs."
            )
        if self.jacobian_gap > 0:
            remarks.append(
                f"The variational equations contradict differences of the flow, by up to "
                f"{self.jacobian_gap:.1e}: the right-hand side jumps, or a Jacobian given to the "
                f"model is wrong. {self._consequence}"
            )
        if self.minimal_period < self.period:
            remarks.append(
                f"The period is {round(self.period / self.minimal_period)} times the minimal one, "
                f"{self.minimal_period:.9g} s: the multipliers are powers of those of that orbit."
            )
        return tuple(remarks)

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

        Dimensions: state, state_at_start, multiplier, segment (or node), time. Complex values are
        split into variables that end in `_real` and `_imag`.
        """
        path = self.trajectory()
        units = ("1",) * len(self.x0)
        if isinstance(self.model, HasStateUnits):
            units = tuple(self.model.state_units)
        return xr.Dataset(
            {
                **stored_orbit({each.name: getattr(self, each.name) for each in fields(self)}),
                "trajectory": (
                    ("time", "state"),
                    path.states,
                    described(OF_STATE, "states over the period"),
                ),
                "exponent_real": (
                    "multiplier",
                    self.exponents.real,
                    described("s-1", "Floquet exponent, real part"),
                ),
                "exponent_imag": (
                    "multiplier",
                    self.exponents.imag,
                    described("s-1", "Floquet exponent, imaginary part"),
                ),
                "doubling_time": (
                    "multiplier",
                    self.doubling_times,
                    described("s", "time in which the mode doubles or halves"),
                ),
                "participation": (
                    ("state", "multiplier"),
                    self.participation,
                    described("1", "share of each state in each mode"),
                ),
            },
            coords={
                "state": list(self.state_names),
                "state_at_start": list(self.state_names),
                "state_unit": ("state", list(units), {"long_name": "units of the states"}),
                "multiplier": (
                    "multiplier",
                    np.arange(len(self.multipliers)),
                    described("1", "number of the multiplier, largest modulus first"),
                ),
                "time": ("time", path.times, described("s", "time")),
            },
            attrs={
                "period": self.period,
                "start_time": self.start_time,
                "residual": self.residual,
                "stability": self.stability,
                "jacobian_method": self.jacobian_method,
                "jacobian_gap": self.jacobian_gap,
                "minimal_period": self.minimal_period,
                "time_units": "s",
            },
        )

    def plot(self) -> Figure:
        """Draw the states over a period and the multipliers in the unit circle."""
        from birdmb.figures import plot_orbit  # noqa: PLC0415 - it draws

        return plot_orbit(self)


def largest_modulus(orbit: FloquetResult) -> Fact:
    """The largest modulus of the multipliers, the trivial one left out, with its error bar."""
    moduli = np.abs(orbit.multipliers)
    if orbit.trivial_index is not None:
        moduli[orbit.trivial_index] = -np.inf
    if not np.isfinite(moduli).any():
        return Fact("", "no multiplier but the trivial one")
    largest = int(moduli.argmax())
    value, error = float(moduli[largest]), float(orbit.verdict_errors[largest])
    return Fact("|Λ|max", with_error(value, error))
