"""A computed flight: states at the integrator's steps and, between them, at any time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicHermiteSpline

from birdmb._typing import FloatArray
from birdmb.summary import Fact, Summarised, shortened


@dataclass(frozen=True, repr=False)
class Flight(Summarised):
    """States of a model along one solution."""

    state_names: tuple[str, ...]
    times: FloatArray
    """(K,) s, increasing."""
    states: FloatArray
    """(K, n), in SI units."""
    rates: FloatArray
    """(K, n), time derivatives of the states."""

    def _summary(self) -> Iterator[Fact]:
        yield Fact("times", str(len(self.times)))
        if len(self.times):
            yield Fact("from", f"{self.times[0]:.6g}", "s")
            yield Fact("to", f"{self.times[-1]:.6g}", "s")
        yield Fact("states", shortened(", ".join(self.state_names)))

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
