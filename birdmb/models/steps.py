"""How many explicit steps a beat the stiffest motion of a multibody bird needs."""

from typing import Protocol

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.models.wing_model import STEPS_PER_BEAT
from birdmb.topology import Bird

# Step times fastest eigenvalue. RK67 is stable up to about 2; at 1 its error is about 1e-6.
_STEP_TIMES_EIGENVALUE = 1.0
_MOST_STEPS = 4000
_PHASES = 8
_RELATIVE_STEP = 1e-6


class _Stiff(Protocol):
    bird: Bird

    @property
    def state_scale(self) -> FloatArray: ...

    def rhs(self, t: float, x: FloatArray) -> FloatArray: ...

    def driven_state(self, t: float) -> FloatArray: ...


def fastest_eigenvalue(model: _Stiff) -> float:
    """Largest modulus (1/s) of an eigenvalue of the model's Jacobian along its drivers' motion."""
    largest = 0.0
    for t in np.arange(_PHASES) * model.bird.period / _PHASES:
        x = model.driven_state(float(t))
        steps = np.diag(_RELATIVE_STEP * model.state_scale)
        columns = [(model.rhs(t, x + h) - model.rhs(t, x - h)) / (2.0 * h.sum()) for h in steps]
        eigenvalues = np.linalg.eigvals(np.column_stack(columns))
        largest = max(largest, float(np.abs(eigenvalues).max()))
    return largest


def steps_for(model: _Stiff) -> int:
    """Steps per wingbeat that follow the fastest motion, a multiple of the default.

    Raises:
        StateError: it is so fast that explicit steps are out of the question.
    """
    fastest = fastest_eigenvalue(model)
    needed = int(np.ceil(model.bird.period * fastest / _STEP_TIMES_EIGENVALUE))
    if needed > _MOST_STEPS:
        joints = ", ".join(joint.name for joint in model.bird.compliant_joints)
        raise StateError(
            f"{model.bird.name}: the compliant joints ({joints}) move so little inertia that their "
            f"fastest motion (rate {fastest:.3g} 1/s) needs {needed} steps per beat; give the "
            f"segments they carry more inertia or less damping, or prescribe the joints."
        )
    return STEPS_PER_BEAT * max(1, -(-needed // STEPS_PER_BEAT))
