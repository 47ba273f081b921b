"""What a point of a sweep is computed from, and what becomes of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from birdmb._typing import FloatArray
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.sweeps.grid import Value
from birdmb.studies.sweeps.settings import Search, Trimming
from birdmb.summary import Summarised
from birdmb.topology import Bird

KEPT_FOR_NEIGHBOURS = (
    *("x0", "monodromy", "trimmed", "method", "orbit", "state_scale", "sensitivity"),
)

# In units of the state scale and of the distance between bounds.
_FURTHEST = 0.2


@dataclass(frozen=True)
class Guess:
    """A neighbour's flight to start from.

    Attributes:
        place: the neighbour's, as the store writes it.
        values: of the parameters there, by name.
        flight: what the store keeps of it, as `described`, by the names KEPT_FOR_NEIGHBOURS.
    """

    place: str
    values: Mapping[str, Value]
    flight: Mapping[str, Any]

    @property
    def state_names(self) -> tuple[str, ...]:
        """Names of its n states."""
        return tuple(self.flight["x0"])

    @property
    def orbit(self) -> FloatArray:
        """States (K, n) at K even instants of its beat; K = 1 if it was shot."""
        if self.flight["orbit"] is None:
            return np.array([list(self.flight["x0"].values())])
        return np.array(self.flight["orbit"]) * self.flight["state_scale"]

    def moved_to(
        self, values: Mapping[str, Value], bounds: Mapping[str, tuple[float, float]]
    ) -> tuple[FloatArray, dict[str, float]]:
        """The orbit, and what it is trimmed by within `bounds`, at other values of the parameters.

        To first order: the whole orbit moves as its first state does. Where the flight would change
        by much it stays the neighbour's: the derivatives of one beside a fold tell of nothing else.
        """
        size, trimmed = len(self.state_names), dict(self.flight["trimmed"])
        change = np.zeros(size + len(bounds))
        for name, by_value in self.flight["sensitivity"].items():
            if values[name] != self.values[name]:
                change += np.array(by_value) * (float(values[name]) - float(self.values[name]))
        if np.abs(change).max() > _FURTHEST:
            return self.orbit, trimmed
        for (name, (low, high)), share in zip(bounds.items(), change[size:], strict=True):
            trimmed[name] = float(np.clip(trimmed[name] + share * (high - low), low, high))
        return self.orbit + change[:size] * np.array(self.flight["state_scale"]), trimmed


@dataclass(frozen=True)
class Task:
    """All that the outcome of a point depends on; `steps` are those of its sensitivities."""

    bird: Bird
    model: ModelFactory
    search: Search
    values: Mapping[str, Value]
    steps: Mapping[str, float]
    guess: Guess | None
    trimming: Trimming | None
    keep_to_sheet: bool = False


@dataclass(frozen=True, repr=False)
class Outcome(Summarised):
    """What became of a point.

    Attributes:
        result: the limit cycle as `described`; `None` if none was found.
        reason: why none was found, else empty.
        start: place of the neighbour that the search succeeded from, or "cold" where it had, or was
            left with, the model's own guess.
        seconds: how long it took.
    """

    result: dict[str, Any] | None
    reason: str
    start: str
    seconds: float
