"""The largest Lyapunov exponent, with its convergence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.orbits.errors import ArgumentError
from birdmb.orbits.problem import Model, VariationalModel
from birdmb.orbits.scales import lay_out

LyapunovMethod = Literal["variational", "neighbours"]

_BLOCKS = 10


@dataclass(frozen=True)
class LyapunovEstimate:
    """Largest Lyapunov exponent of a solution.

    Attributes:
        exponent: mean rate of separation of neighbours in 1/s.
        error: its standard error in 1/s from the means over ten blocks of the time used; it shows
            the scatter, not a drift: look at `running`.
        times: ends (k,) of the rescaling intervals in s, the transient left out.
        running: exponent (k,) in 1/s as it would be if the computation ended at each of `times`.
        method: "variational" or "neighbours".
    """

    exponent: float
    error: float
    times: FloatArray
    running: FloatArray
    method: LyapunovMethod


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
    if not interval > 0 or intervals < _BLOCKS or transient < 0:
        raise ArgumentError(
            f"interval must be positive, intervals at least {_BLOCKS}, transient not negative."
        )
    able = isinstance(model, VariationalModel)
    method = method or ("variational" if able else "neighbours")
    if method not in {"variational", "neighbours"}:
        raise ArgumentError(f'method must be "variational" or "neighbours", not "{method}".')
    if method == "variational" and not able:
        raise ArgumentError('method="variational" needs a model with flow_jacobian.')
    scale, points = lay_out(model, x0, start_time, interval, 1)
    x, n = points[0], len(scale)
    direction = np.full(n, 1 / np.sqrt(n))
    logs = np.empty(transient + intervals)
    grid: FloatArray = start_time + interval * np.arange(transient + intervals + 1.0)
    for i in range(len(logs)):
        if isinstance(model, VariationalModel) and method == "variational":
            x, tangent = model.flow_jacobian(x, grid[i], grid[i + 1])
            grown = tangent @ (direction * scale) / scale
        else:
            neighbour = model.flow(x + separation * direction * scale, grid[i], grid[i + 1])
            x = model.flow(x, grid[i], grid[i + 1])
            grown = (neighbour - x) / scale / separation
        length = float(np.linalg.norm(grown))
        if not np.isfinite(length) or length == 0:
            raise StateError(
                f"The neighbouring solution cannot be rescaled at t = {grid[i + 1]:.6g}: the "
                f"separation grew by the factor {length}."
            )
        logs[i], direction = np.log(length), grown / length
    rates = logs[transient:] / interval
    blocks = [float(block.mean()) for block in np.array_split(rates, _BLOCKS)]
    running = np.cumsum(rates) / np.arange(1, intervals + 1)
    return LyapunovEstimate(
        exponent=float(running[-1]),
        error=float(np.std(blocks, ddof=1) / np.sqrt(_BLOCKS)),
        times=grid[transient + 1 :],
        running=running,
        method=method,
    )
