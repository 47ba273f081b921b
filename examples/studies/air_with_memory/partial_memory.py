"""Birds in air of which a part has a memory, or all of it at once."""

import numpy as np

import birdmb
from birdmb._typing import FloatArray
from birdmb.models.wing_model import BirdModel


class Blend:
    """A bird in air of which a part, from 0 to 1, has a memory.

    The motion's rates are the weighted mean of those in both kinds of air; the lags always follow.
    """

    def __init__(self, model: BirdModel, part: float) -> None:
        self._with, self._without = model, model.in_air(wake="quasi-steady")
        self._part, self._motion = part, len(model.motion_state_names)
        self.state_names, self.period = model.state_names, model.period
        self.state_scale = model.state_scale

    def rates(self, times: FloatArray, states: FloatArray) -> FloatArray:
        """Rates (K, n) at `times` (K,) s of `states` (K, n)."""
        found, n = np.array(self._with.rates(times, states)), self._motion
        without = self._without.rates(times, states[:, :n])
        found[:, :n] = self._part * found[:, :n] + (1.0 - self._part) * without
        return found

    def rhs(self, t: float, x: FloatArray) -> FloatArray:
        """Rates (n,) at t (s) of x (n,)."""
        return np.asarray(self.rates(np.array([t]), x[None])[0])

    def flow(self, x0: FloatArray, t0: float, t1: float) -> FloatArray:
        """State (n,) at t1 (s) from x0 (n,) at t0."""
        ode = birdmb.OdeModel(self.rhs, self.state_names, self.period)
        return ode.flow(x0, t0, t1)


class WithoutLag:
    """A bird in air whose lags have always settled: apparent mass without a lag."""

    def __init__(self, model: BirdModel) -> None:
        self._model, self._motion = model, len(model.motion_state_names)
        self.state_names, self.period = model.motion_state_names, model.period
        self.state_scale = model.state_scale[: self._motion]

    def rates(self, times: FloatArray, states: FloatArray) -> FloatArray:
        """Rates (K, n) at `times` (K,) s of `states` (K, n)."""
        settled = self._model.with_lags(times, states)
        return self._model.rates(times, settled)[:, : self._motion]

    def rhs(self, t: float, x: FloatArray) -> FloatArray:
        """Rates (n,) at t (s) of x (n,)."""
        return np.asarray(self.rates(np.array([t]), x[None])[0])

    def flow(self, x0: FloatArray, t0: float, t1: float) -> FloatArray:
        """State (n,) at t1 (s) from x0 (n,) at t0."""
        ode = birdmb.OdeModel(self.rhs, self.state_names, self.period)
        return ode.flow(x0, t0, t1)
