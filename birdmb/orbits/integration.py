"""Time integration of ordinary differential equations that says where and why it failed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.integrate import DOP853, LSODA, OdeSolver, Radau

from birdmb._typing import FloatArray
from birdmb.errors import StateError

Integrator = Literal["DOP853", "LSODA", "Radau"]

SOLVERS: dict[str, Callable[..., OdeSolver]] = {"DOP853": DOP853, "LSODA": LSODA, "Radau": Radau}
_RUNAWAY = 1e6


@dataclass(frozen=True)
class Integration:
    """How to integrate.

    Attributes:
        integrator: a key of `SOLVERS`.
        rtol: relative tolerance of a step.
        most_steps: a solution that takes more steps than these is given up.
    """

    integrator: Integrator
    rtol: float
    most_steps: int

    def run(
        self,
        function: Callable[[float, FloatArray], FloatArray],
        start: FloatArray,
        t0: float,
        t1: float,
        atol: FloatArray,
        times: FloatArray | None = None,
    ) -> FloatArray:
        """Values (k, n) at ascending `times` (k,) in [t0, t1], by default at t1 alone.

        `atol` (n,) are absolute tolerances in the units of `start`.

        Raises:
            StateError: the solution does not reach t1 or is not finite.
        """
        at = np.array([t1]) if times is None else times
        forward = 1.0 if t1 >= t0 else -1.0
        values = np.empty((len(at), len(start)))
        filled = int(np.searchsorted(forward * at, forward * t0, side="right"))
        values[:filled] = start
        # A solution that runs away overflows before the integrator gives up; StateError says it.
        with np.errstate(all="ignore"):
            # scipy seeks a first step for ever where the first rate is no number.
            if not np.isfinite(function(t0, start)).all():
                raise StateError(f"The right-hand side at the start, t = {t0:.6g}, is not finite.")
            solver = SOLVERS[self.integrator](function, t0, start, t1, rtol=self.rtol, atol=atol)
            for _ in range(self.most_steps):
                if filled == len(at):
                    return values
                message = _step(solver)
                if solver.status == "failed" or not np.isfinite(solver.y).all():
                    raise self._failure(solver, start, t0, message or "values are not finite")
                end = int(np.searchsorted(forward * at, forward * solver.t, side="right"))
                passed = at[filled:end]
                if (passed != solver.t).any():
                    values[filled:end] = solver.dense_output()(passed).T
                values[filled:end][passed == solver.t] = solver.y
                filled = end
        raise self._failure(solver, start, t0, f"most_steps = {self.most_steps} were not enough")

    def _failure(self, solver: OdeSolver, start: FloatArray, t0: float, why: str) -> StateError:
        size, before = float(np.abs(solver.y).max()), float(np.abs(start).max())
        if not size <= _RUNAWAY * (before or 1.0):
            advice = f"The solution runs away: its largest value there is {size:.3g}."
        elif self.integrator == "DOP853":
            advice = (
                "Where the solution is bounded, the system is stiff or its right-hand side jumps: "
                'for a stiff one choose integrator="LSODA" or "Radau".'
            )
        else:
            advice = "Where the solution is bounded, the right-hand side may jump."
        return StateError(
            f"The integration from t = {t0:.6g} to {solver.t_bound:.6g} failed after t = "
            f"{solver.t:.6g}: {why.rstrip('.')}. {advice}"
        )


def _step(solver: OdeSolver) -> str | None:
    try:
        return solver.step()
    except (ValueError, np.linalg.LinAlgError) as error:  # of the implicit ones, for NaN
        solver.status = "failed"
        return str(error)
