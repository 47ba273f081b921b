"""The steps of a search, as its callbacks, its results and its errors keep them."""

from __future__ import annotations

from dataclasses import dataclass

from birdmb._typing import FloatArray


@dataclass(frozen=True)
class Iteration:
    """One accepted step of a search; number 0 is the guess.

    Attributes:
        number: steps taken so far.
        residual: Euclidean norm of the closure errors, in units of the state scale.
        step_length: Euclidean length of the step, in units of the state scale.
        damping: fraction of the Newton step taken, or the Levenberg-Marquardt parameter.
        x: state (n,) at the start of the orbit.
        period: period in s.
        jacobian_reused: the step was made with the Jacobian of an earlier point, or a given one,
            updated by the steps since.
        nodes: number of collocation nodes; `None` for shooting.
    """

    number: int
    residual: float
    step_length: float
    damping: float
    x: FloatArray
    period: float
    jacobian_reused: bool = False
    nodes: int | None = None
