"""What happens after a disturbance of an orbit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
import xarray as xr

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError, StateError
from birdmb.orbits.result import FloquetResult
from birdmb.orbits.segments import sample
from birdmb.summary import Summarised

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class PerturbedResponse(Summarised):
    """Motion after a disturbance of a periodic orbit.

    Attributes:
        state_names: names of the n states.
        times: (k,) in s, from the disturbance on.
        states: (k, n), by the full (nonlinear) model.
        orbit: (k, n), the undisturbed orbit at the same times.
        linear: (periods + 1, n), the deviation that the monodromy matrix predicts at the starts of
            the periods.
        failure: why the motion ended before its time; `None` if it did not.
    """

    state_names: tuple[str, ...]
    times: FloatArray
    states: FloatArray
    orbit: FloatArray
    linear: FloatArray
    failure: str | None

    @property
    def deviation(self) -> FloatArray:
        """States minus orbit, (k, n)."""
        return np.asarray(self.states - self.orbit)

    def to_xarray(self) -> xr.Dataset:
        """Return states and orbit over time as a labelled dataset."""
        dims = ("time", "state")
        return xr.Dataset(
            {"states": (dims, self.states), "orbit": (dims, self.orbit)},
            coords={"time": ("time", self.times, {"units": "s"}), "state": list(self.state_names)},
        )

    def plot(self) -> Figure:
        """Draw the disturbed states over the orbit."""
        from birdmb.figures import plot_response  # noqa: PLC0415 - it draws

        return plot_response(self)


@checked
def mode_disturbance(
    orbit: FloquetResult, mode: int, amplitude: float, phase: float = 0.0
) -> FloatArray:
    """Disturbance (n,) along one mode: amplitude * Re(exp(i phase) v), in the units of the states.

    `amplitude` is in units of the state scale, of which the largest entry of v is one; `phase` in
    radians picks a direction in the plane of a complex mode.
    """
    n = len(orbit.multipliers)
    if not 0 <= mode < n:
        raise ArgumentError(f"mode must be from 0 to {n - 1}, not {mode}.")
    return np.asarray(amplitude * (np.exp(1j * phase) * orbit.modes[:, mode]).real)


@checked
def perturbed_response(
    orbit: FloquetResult,
    disturbance: npt.ArrayLike,
    *,
    periods: int = 5,
    samples: int = 100,
) -> PerturbedResponse:
    """Follow the motion from the start of an orbit plus a disturbance of the state.

    Args:
        orbit: a `LimitCycle` or `FloquetResult`.
        disturbance: (n,) in the units of the states; `mode_disturbance` gives one along a mode.
        periods: how long to follow it.
        samples: number of times per period.

    Returns:
        The response; if the model cannot go on, what was reached, with the reason.

    Raises:
        ArgumentError: a disturbance of the wrong shape, or numbers that are not positive.
    """
    shift, n = np.asarray(disturbance, float), len(orbit.x0)
    if shift.shape != (n,):
        raise ArgumentError(f"the disturbance has shape {shift.shape}; the states need ({n},).")
    if periods < 1 or samples < 1:
        raise ArgumentError("periods and samples must be at least 1.")
    x, failure = orbit.x0 + shift, None
    linear = [shift]
    times, states = [np.array([orbit.start_time])], [x[None, :]]
    for k in range(periods):
        start = orbit.start_time + k * orbit.period
        at = start + orbit.period * np.arange(1, samples + 1) / samples
        try:
            path = sample(orbit.model, x, start, at, float(at[-1]))
        except StateError as error:
            failure = str(error)
            break
        x = path[-1]
        times.append(at)
        states.append(path)
        linear.append(orbit.monodromy @ linear[-1])
    all_times = np.concatenate(times)
    return PerturbedResponse(
        state_names=orbit.state_names,
        times=all_times,
        states=np.concatenate(states),
        orbit=orbit.trajectory(all_times).states,
        linear=np.array(linear),
        failure=failure,
    )
