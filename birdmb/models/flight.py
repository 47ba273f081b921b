"""A computed flight: states at the integrator's steps and, between them, at any time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicHermiteSpline

from birdmb._typing import FloatArray


@dataclass(frozen=True)
class Flight:
    """States of a model along one solution."""

    state_names: tuple[str, ...]
    times: FloatArray
    """(K,) s, increasing."""
    states: FloatArray
    """(K, n), in SI units."""
    rates: FloatArray
    """(K, n), time derivatives of the states."""

    @cached_property
    def _spline(self) -> CubicHermiteSpline:
        return CubicHermiteSpline(self.times, self.states, self.rates)

    def __call__(self, times: npt.ArrayLike) -> FloatArray:
        """States (..., n) at any times (...) s within the solution (cubic Hermite, 4th order)."""
        return np.asarray(self._spline(np.asarray(times, dtype=float)))

    def at(self, times: npt.ArrayLike) -> Flight:
        """The same solution, tabulated at other times (K,) s."""
        when = np.atleast_1d(np.asarray(times, dtype=float))
        rates = np.asarray(self._spline.derivative()(when))
        return Flight(self.state_names, when, self(when), rates)

    def __getitem__(self, name: str) -> FloatArray:
        """One state by its name, (K,)."""
        return self.states[:, self.state_names.index(name)]
