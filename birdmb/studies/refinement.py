"""How much the loads change on another number of elements: whether a wing's discretisation serves.

The bird is held at the motion in which its mean loads come closest to balance, and its wings follow
their drivers. Twice the elements tell the error of a method of second order to a third of itself;
of loads that do not settle they tell that.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from birdmb._typing import FloatArray
from birdmb.models.rigid import RigidModel
from birdmb.topology import Bird

LARGEST_CHANGE = 0.02
_PHASES = 12
# Twice as many would take seconds a phase: half as many tell as much.
_MOST_DOUBLED = 256


@dataclass(frozen=True)
class LoadChange:
    """Change of the loads from a bird's own number of elements to another one."""

    elements: int
    """The other number of elements a wing: twice its own, or half of very many."""
    force: float
    """Largest change of the resultant over a beat, as a part of the largest resultant."""
    circulation: float
    """Change of the largest circulation over a beat, as a part of it."""

    @property
    def largest(self) -> float:
        """The larger of both."""
        return max(self.force, self.circulation)


def load_change(bird: Bird) -> LoadChange:
    """Compare the loads of a beat at mean trim on two numbers of elements, of the right wing.

    Raises:
        StateError: the wing has no loads somewhere in the beat.
    """
    own = bird.wing.resolved_discretisation.elements
    other = 2 * own if own <= _MOST_DOUBLED else own // 2
    bird = bird.side("right")
    model = RigidModel(bird)
    state = model.initial_guess()
    changed = RigidModel(bird.with_values({"wing.discretisation.elements": other}))
    (force, circulation), (other_force, other_circulation) = (
        _over_a_beat(of, state) for of in (model, changed)
    )
    change = float(np.linalg.norm(other_force - force, axis=1).max())
    return LoadChange(
        elements=other,
        force=_part(change, float(np.linalg.norm(other_force, axis=1).max())),
        circulation=_part(abs(other_circulation - circulation), other_circulation),
    )


def _over_a_beat(model: RigidModel, state: FloatArray) -> tuple[FloatArray, float]:
    """Resultants (P, 3) N and the largest modulus of a circulation, m2/s."""
    times = np.arange(_PHASES) / _PHASES * model.bird.period
    loads = [model.loads(t, state) for t in times]
    return (
        np.array([at.force for at in loads]),
        max(float(np.abs(at.right.circulation).max()) for at in loads),
    )


def _part(change: float, whole: float) -> float:
    return change / whole if whole > 0.0 else 0.0
