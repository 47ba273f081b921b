"""Floquet analysis of an orbit that is already known."""

from __future__ import annotations

from concurrent.futures import Executor
from typing import Literal

import numpy as np
import numpy.typing as npt

from birdmb.arguments import checked
from birdmb.errors import ArgumentError
from birdmb.orbits.errors import NotClosedError, require_tolerance
from birdmb.orbits.linearisation import linearise
from birdmb.orbits.multipliers import MultiplierSolver
from birdmb.orbits.periodic import periodic_multipliers
from birdmb.orbits.periodicity import require_period
from birdmb.orbits.problem import Model
from birdmb.orbits.result import FloquetResult
from birdmb.orbits.scales import lay_out
from birdmb.orbits.segments import Segments, choose_jacobian
from birdmb.orbits.shooting import ShootingEquations


@checked
def floquet(
    model: Model,
    x0: npt.ArrayLike,
    period: float | None = None,
    *,
    segments: int = 1,
    start_time: float = 0.0,
    solver: MultiplierSolver = periodic_multipliers,
    closure_tolerance: float = 1e-6,
    jacobian: Literal["auto", "variational", "finite-differences"] = "auto",
    executor: Executor | None = None,
) -> FloquetResult:
    """Find the Floquet multipliers, modes and exponents of a known periodic orbit.

    The zero solution of a linear periodic system is one; so is an equilibrium, over any period.

    Args:
        model: anything that satisfies `birdmb.orbits.Model`.
        x0: state (n,) of the orbit at `start_time`, or states (segments, n) at the starts of the
            segments, which an unstable orbit needs to be given accurately.
        period: period in s; by default `model.period`. A multiple goes round several times.
        segments: number M of segments whose Jacobians are multiplied; small multipliers need more.
        start_time: time of the first state, in s.
        solver: `periodic_multipliers` (keeps small multipliers) or `product_multipliers`.
        closure_tolerance: largest closure error for which x0 counts as periodic, in units of the
            state scale, at most 0.01. What there is of it is part of the error bounds.
        jacobian: as in `find_limit_cycle`.
        executor: spreads flows over workers; results do not depend on it.

    Raises:
        ArgumentError: wrong shapes or numbers, no period known, or one in which the right-hand side
            does not repeat.
        NotClosedError: the orbit does not close.
        StateError: the flow fails on the way round.
    """
    period = model.period if period is None else period
    if period is None:
        raise ArgumentError("an orbit of an autonomous system needs its period.")
    if not 0 < period < np.inf:
        raise ArgumentError(f"period must be positive and finite, not {period}.")
    require_tolerance("closure_tolerance", closure_tolerance)
    scale, points = lay_out(model, x0, start_time, period, segments)
    require_period(model, points[0], scale, start_time, period)
    work = Segments(model, scale, start_time, choose_jacobian(model, jacobian), executor)
    equations = ShootingEquations(work, period, model.period is None)
    residual = equations.residual(equations.pack(points, period))
    closure = float(np.abs(residual).max())
    if closure > closure_tolerance:
        raise NotClosedError(
            f"The orbit does not close: after {period:.6g} s it misses its start by "
            f"{closure:.3g} of the state scale ({equations.closure(residual):.3g} in the units of "
            f"the states; allowed {closure_tolerance:.1g}). Refine it by find_limit_cycle first.",
            closure,
        )
    may_differ = jacobian == "auto"
    return linearise(equations, points, period, solver, residual, may_differ)
