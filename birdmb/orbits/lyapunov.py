"""The largest Lyapunov exponent, with its convergence."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError, StateError
from birdmb.orbits.problem import Model, Scalable, VariationalModel, flow_accuracy
from birdmb.orbits.scales import lay_out
from birdmb.summary import Fact, Summarised, with_error

LyapunovMethod = Literal["variational", "neighbours"]

_BLOCKS = 10
# A separation that shrinks to less than so many errors of the flow is lost in them, and one that
# grows beyond this part of the state scale is no neighbour's.
_LEAST_IN_ERRORS, _LEAST = 1e3, 0.1
_LARGEST_GROWN, _LARGEST = 0.1, 1e6
_MOST_PIECES = 2**12
_LARGEST_SEPARATION = 0.01


@dataclass(frozen=True, repr=False)
class LyapunovEstimate(Summarised):
    """Largest Lyapunov exponent of a solution.

    Attributes:
        exponent: mean rate of separation of neighbours in 1/s.
        error: its standard error in 1/s from the means over ten blocks of the time used, plus what
            the accuracy of the flow leaves of each separation; it shows the scatter, not a drift:
            look at `running`.
        times: ends (k,) of the rescaling intervals in s, the transient left out.
        running: exponent (k,) in 1/s as it would be if the computation ended at each of `times`.
        method: "variational" or "neighbours".
    """

    exponent: float
    error: float
    times: FloatArray
    running: FloatArray
    method: LyapunovMethod

    def _summary(self) -> Iterator[Fact]:
        yield Fact("exponent", with_error(self.exponent, self.error), "1/s")
        yield Fact("method", self.method)
        yield Fact("intervals", str(len(self.times)))


@checked
def largest_lyapunov_exponent(
    model: Model,
    x0: npt.ArrayLike,
    interval: float,
    intervals: int = 200,
    *,
    transient: int = 20,
    method: LyapunovMethod | None = None,
    separation: float = 1e-6,
    start_time: float = 0.0,
) -> LyapunovEstimate:
    """Estimate the largest Lyapunov exponent by rescaling after every interval.

    Also within an interval, in which the separation would be lost in the error of the flow or grow
    out of the neighbourhood.

    "variational" carries a tangent vector by the flow Jacobian: exact rates, no separation to
    choose; take it where the model has `flow_jacobian`. "neighbours" carries a second solution at
    a small distance (Benettin, Galgani, Giorgilli & Strelcyn 1980), for any flow; its rates err by
    about `separation` plus the accuracy of the flow over `separation`.

    Args:
        model: anything that satisfies `birdmb.orbits.Model`.
        x0: state (n,) at `start_time`.
        interval: time between rescalings in s; short enough that neighbours stay neighbours. For a
            forced system, take its period or a part of it.
        intervals: number of intervals that count.
        transient: number of intervals before them, in which the solution settles and the
            separation turns into its fastest growing direction.
        method: by default "variational" where the model can, else "neighbours".
        separation: distance of the neighbour in units of the state scale.
        start_time: time of x0 in s.

    Raises:
        ArgumentError: wrong shapes or numbers, or a method that the model cannot serve.
        StateError: the solution leaves the model's validity.
    """
    if not 0 < interval < np.inf or intervals < _BLOCKS or transient < 0:
        raise ArgumentError(
            f"interval must be positive and finite, intervals at least {_BLOCKS}, transient not "
            f"negative."
        )
    if not 0 < separation <= _LARGEST_SEPARATION:
        raise ArgumentError(
            f"separation must be positive and at most {_LARGEST_SEPARATION:g} of the state scale, "
            f"not {separation}."
        )
    able = isinstance(model, VariationalModel)
    method = method or ("variational" if able else "neighbours")
    if method == "variational" and not able:
        raise ArgumentError('method="variational" needs a model with flow_jacobian.')
    scale, points = lay_out(model, x0, start_time, interval, 1)
    if isinstance(model, Scalable):
        model = model.scaled_to(scale)
    carrier = _Carrier(model, scale, method, separation)
    x, n = points[0], len(scale)
    direction = np.full(n, 1 / np.sqrt(n))
    logs, errors = np.empty(transient + intervals), np.empty(transient + intervals)
    grid: FloatArray = start_time + interval * np.arange(transient + intervals + 1.0)
    for i in range(len(logs)):
        x, direction, logs[i], errors[i] = carrier.over(x, direction, grid[i], grid[i + 1])
    rates = logs[transient:] / interval
    blocks = [float(block.mean()) for block in np.array_split(rates, _BLOCKS)]
    running = np.cumsum(rates) / np.arange(1, intervals + 1)
    return LyapunovEstimate(
        exponent=float(running[-1]),
        error=float(np.std(blocks, ddof=1) / np.sqrt(_BLOCKS))
        + float(errors[transient:].mean() / interval),
        times=grid[transient + 1 :],
        running=running,
        method=method,
    )


@dataclass
class _Carrier:
    """Carries a separation along a solution, in pieces over which it keeps a similar length."""

    model: Model
    scale: FloatArray
    method: LyapunovMethod
    separation: float
    pieces: int = 1

    def over(
        self, x: FloatArray, direction: FloatArray, t0: float, t1: float
    ) -> tuple[FloatArray, FloatArray, float, float]:
        """State and unit direction (n,) at t1, the logarithm of the growth and its error."""
        # One interval may need many pieces where the next one does with few.
        self.pieces = max(1, self.pieces // 2)
        while True:
            carried = self._in_pieces(x, direction, t0, t1)
            if carried is not None:
                return carried
            self.pieces *= 2

    def _in_pieces(
        self, x: FloatArray, direction: FloatArray, t0: float, t1: float
    ) -> tuple[FloatArray, FloatArray, float, float] | None:
        total, error = 0.0, 0.0
        low, high = self._lengths
        times = np.linspace(t0, t1, self.pieces + 1)
        for begin, end in itertools.pairwise(times.tolist()):
            x, grown = self._carry(x, direction, begin, end)
            length = float(np.linalg.norm(grown))
            if not low <= length <= high and self.pieces < _MOST_PIECES:
                return None
            if not np.isfinite(length) or length == 0:
                raise StateError(
                    f"The neighbouring solution cannot be rescaled at t = {end:.6g}: the "
                    f"separation grew by the factor {length}."
                )
            total += float(np.log(length))
            # What the flow errs by early in a piece grows with the separation.
            error += self._accuracy / min(length, 1.0)
            direction = grown / length
        return x, direction, total, error

    def _carry(
        self, x: FloatArray, direction: FloatArray, t0: float, t1: float
    ) -> tuple[FloatArray, FloatArray]:
        model, scale = self.model, self.scale
        if isinstance(model, VariationalModel) and self.method == "variational":
            end, tangent = model.flow_jacobian(x, t0, t1)
            return end, tangent @ (direction * scale) / scale
        neighbour = model.flow(x + self.separation * direction * scale, t0, t1)
        end = model.flow(x, t0, t1)
        return end, (neighbour - end) / scale / self.separation

    @property
    def _lengths(self) -> tuple[float, float]:
        """Least and largest length of a carried separation, in units of its length before."""
        least = min(_LEAST, _LEAST_IN_ERRORS * self._accuracy)
        if self.method == "variational":
            return least, _LARGEST
        return least, _LARGEST_GROWN / self.separation

    @property
    def _accuracy(self) -> float:
        """Error of a carried separation, in units of its length before."""
        accuracy = flow_accuracy(self.model)
        if self.method == "variational":
            return accuracy
        return accuracy / self.separation + self.separation
