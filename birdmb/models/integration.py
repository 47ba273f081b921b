"""Which integration the stiffest motion of a multibody bird needs."""

from __future__ import annotations

from typing import Literal, NamedTuple, Protocol

import numpy as np

from birdmb._typing import FloatArray
from birdmb.models.wing_model import STEPS_PER_BEAT
from birdmb.topology import Bird

# Step times fastest eigenvalue. RK67 is stable up to about 2; at 1 its error is about 1e-6.
_STEP_TIMES_EIGENVALUE = 1.0
# Beyond this, implicit steps are cheaper.
_MOST_EXPLICIT_STEPS = 480
_PHASES = 8
_RELATIVE_STEP = 1e-6


Integrator = Literal["auto", "explicit", "implicit"]


class Integration(NamedTuple):
    """A method with fixed steps: "explicit" is Exudyn's RK67, "implicit" Radau IIA of order 5."""

    method: Literal["explicit", "implicit"]
    steps_per_beat: int


class _Stiff(Protocol):
    bird: Bird

    @property
    def state_scale(self) -> FloatArray: ...

    def rates(self, times: FloatArray, states: FloatArray) -> FloatArray: ...

    def guess_along(self, times: FloatArray) -> FloatArray: ...


def fastest_eigenvalue(model: _Stiff) -> float:
    """Largest modulus (1/s) of an eigenvalue of the model's Jacobian along its drivers' motion."""
    times = np.arange(_PHASES) * model.bird.period / _PHASES
    states = model.guess_along(times)
    steps = _RELATIVE_STEP * model.state_scale
    n = steps.size
    shifted = np.stack([states[:, None] + sign * np.diag(steps) for sign in (1.0, -1.0)], axis=1)
    found = model.rates(np.repeat(times, 2 * n), shifted.reshape(-1, n)).reshape(-1, 2, n, n)
    slopes = (found[:, 0] - found[:, 1]) / (2.0 * steps[:, None])  # rows are by which state
    return float(np.abs(np.linalg.eigvals(slopes)).max())


def integration_for(model: _Stiff, steps_wanted: int | None, integrator: Integrator) -> Integration:
    """Choose method and steps per beat by the fastest motion of compliant joints and lags.

    Explicit steps follow the fastest motion, a multiple of the default. Where that takes too many,
    the motion is stiff: implicit steps of the default number pass over it once it has died out.
    """
    if steps_wanted is not None and integrator != "auto":
        return Integration(integrator, steps_wanted)
    fastest = fastest_eigenvalue(model)
    needed = int(np.ceil(model.bird.period * fastest / _STEP_TIMES_EIGENVALUE))
    needed = STEPS_PER_BEAT * max(1, -(-needed // STEPS_PER_BEAT))
    if integrator == "auto":
        allowed = _MOST_EXPLICIT_STEPS if steps_wanted is None else 2 * steps_wanted
        integrator = "explicit" if needed <= allowed else "implicit"
    if steps_wanted is None:
        steps_wanted = needed if integrator == "explicit" else STEPS_PER_BEAT
    return Integration(integrator, steps_wanted)
