"""Implicit integration with fixed steps, for joints too stiff for explicit ones.

Radau IIA of three stages (order 5, L-stable; Hairer and Wanner, Solving Ordinary Differential
Equations II, section IV.5). Fixed steps and a tightly converged Newton iteration keep the flow
smooth in its start, which differences of it need; libraries offer this method with step control
only.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from birdmb._typing import FloatArray
from birdmb.errors import StateError

_S6 = np.sqrt(6.0)
_NODES = np.array([(4.0 - _S6) / 10.0, (4.0 + _S6) / 10.0, 1.0])
_MATRIX = np.array(
    [
        [(88 - 7 * _S6) / 360, (296 - 169 * _S6) / 1800, (-2 + 3 * _S6) / 225],
        [(296 + 169 * _S6) / 1800, (88 + 7 * _S6) / 360, (-2 - 3 * _S6) / 225],
        [(16 - _S6) / 36, (16 + _S6) / 36, 1 / 9],
    ]
)
_NEWTON_STEPS = 10
_JACOBIANS = 4
# In units of the state scale; well below the 1e-5 over which flows are differenced.
_NEWTON_TOLERANCE = 1e-12
_STALLED = 1e-9
_RELATIVE_STEP = 1e-7

# Rates (K, n) at K times of K states (K, n).
Rates = Callable[[FloatArray, FloatArray], FloatArray]


def integrate_implicitly(
    rates: Rates, x0: FloatArray, t0: float, t1: float, steps: int, scale: FloatArray
) -> FloatArray:
    """State (n,) at t1 after `steps` steps of Radau IIA from x0 (n,) at t0.

    `scale` (n,) are typical sizes of the states. Raises `StateError` where the stage equations have
    no solution nearby.
    """
    h = (t1 - t0) / steps
    x = x0
    # A motion that runs away overflows; it is told by what is not finite, not by warnings.
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        for i in range(steps):
            x = x + _step(rates, t0 + i * h, x, h, scale)
    return x


def _step(rates: Rates, t: float, x: FloatArray, h: float, scale: FloatArray) -> FloatArray:
    times = t + _NODES * h
    stages = np.zeros((3, x.size))
    before = np.inf
    for _ in range(_JACOBIANS):
        if not np.isfinite(stages).all():
            raise _no_solution(t)
        solve = _linearised(rates, times, x + stages, h, scale)
        for _ in range(_NEWTON_STEPS):
            residual = h * (_MATRIX @ rates(times, x + stages)) - stages
            if not np.isfinite(residual).all():
                raise _no_solution(t)
            change = solve(residual)
            stages = stages + change
            size = float(np.abs(change / scale).max())
            # Round-off may stop the decrease short of the tolerance.
            if size < _NEWTON_TOLERANCE or (size < _STALLED and size >= 0.5 * before):
                return np.asarray(stages[-1])
            before = size
    raise _no_solution(t)


def _no_solution(t: float) -> StateError:
    return StateError(f"the stiff integration found no solution at t = {t:.6g} s.")


def _linearised(
    rates: Rates, times: FloatArray, states: FloatArray, h: float, scale: FloatArray
) -> Callable[[FloatArray], FloatArray]:
    """Solver of the linearised stage equations, each stage with a Jacobian of its own.

    One for all would not do: as the elbow bends, the inertia that a shoulder joint moves, and with
    it the fastest rate, can change several times over within a step. Forward differences are
    enough: the Jacobians decide how fast Newton converges, not where.
    """
    n = states.shape[1]
    shifted = states[:, None, :] + np.diag(_RELATIVE_STEP * scale)
    taken = np.einsum("ijj->ij", shifted - states[:, None, :])
    rows = np.concatenate([states[:, None, :], shifted], axis=1).reshape(-1, n)
    found = rates(np.repeat(times, n + 1), rows).reshape(3, n + 1, n)
    jacobians = np.swapaxes((found[:, 1:] - found[:, :1]) / taken[:, :, None], 1, 2)
    matrix = np.eye(3 * n) - h * np.einsum("ij,jab->iajb", _MATRIX, jacobians).reshape(3 * n, 3 * n)
    if not np.isfinite(matrix).all():
        raise _no_solution(float(times[0]))
    factors = lu_factor(matrix)
    return lambda residual: np.asarray(lu_solve(factors, residual.ravel()).reshape(3, n))
