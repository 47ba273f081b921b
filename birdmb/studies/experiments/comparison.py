"""A number from elsewhere beside what the program makes of it with each kind of wake."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import TypedDict

from birdmb._typing import FloatArray
from birdmb.studies.moving_wing import Wake
from birdmb.topology import Stall

QUASI_STEADY, WITH_APPARENT_MASS, UNSTEADY = (
    "quasi-steady",
    "quasi-steady with apparent mass",
    "unsteady",
)


class WakeChoice(TypedDict):
    """Arguments of `moving_wing_loads` that say how the air remembers."""

    wake: Wake
    apparent_mass: bool


CHOICES: Mapping[str, WakeChoice] = {
    QUASI_STEADY: {"wake": "quasi-steady", "apparent_mass": False},
    WITH_APPARENT_MASS: {"wake": "quasi-steady", "apparent_mass": True},
    UNSTEADY: {"wake": "unsteady", "apparent_mass": True},
}
# Where sections stall in the experiment, "unsteady" has them stall; and this model does not.
ATTACHED = "unsteady, attached"
MODELS = (*CHOICES, ATTACHED)


def with_stall(
    stall: Stall, compute: Callable[[WakeChoice, Stall | None], FloatArray]
) -> dict[str, FloatArray]:
    """What all models make of a wing whose sections stall so, by their names."""
    found = {name: compute(choice, None) for name, choice in CHOICES.items()}
    found[ATTACHED] = found[UNSTEADY]
    found[UNSTEADY] = compute(CHOICES[UNSTEADY], stall)
    return found


@dataclass(frozen=True)
class Comparison:
    """One number.

    Attributes:
        case: letter of the experiment.
        quantity: what it is.
        unit: empty where it has none.
        measured: the number from elsewhere; 0 where the quantity is an error.
        computed: the same by this program, by name of the model (`MODELS`).
        others: the same by other authors' models, by name.
        failure: why a model computed nothing.
    """

    case: str
    quantity: str
    unit: str
    measured: float
    computed: Mapping[str, float]
    others: Mapping[str, float] = field(default_factory=dict)
    failure: str = ""

    def as_object(self) -> dict[str, object]:
        """Object for other programs; null for what was not computed."""
        return {
            "case": self.case,
            "quantity": self.quantity,
            "unit": self.unit,
            "measured": self.measured,
            **{name: self.computed.get(name) for name in MODELS},
            "others": dict(self.others),
            "failure": self.failure,
        }


@dataclass(frozen=True)
class Experiment:
    """A case.

    Attributes:
        case: its letter.
        title: what was done.
        source: who measured or computed it.
        compare: computes the numbers of this program beside those of the source.
    """

    case: str
    title: str
    source: str
    compare: Callable[[], Iterator[Comparison]]
