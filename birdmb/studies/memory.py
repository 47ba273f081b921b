"""What the air's memory does to a flight: the same bird in air with one and without."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.models import FlightCycle
from birdmb.models.wing_model import BirdModel
from birdmb.orbits import find_limit_cycle
from birdmb.summary import Fact, Summarised

_INSTANTS = 32


@dataclass(frozen=True, repr=False)
class MemoryEffect(Summarised):
    """A flight in air whose circulation lags, and the flight beside it in quasi-steady air.

    `str()` of it is a sentence.
    """

    unsteady: FlightCycle
    """With `air.wake` unsteady: lags of the circulation, and apparent mass."""
    quasi_steady: FlightCycle
    """With `air.wake` quasi-steady."""

    def _title(self) -> str:
        return self.unsteady.model.bird.name

    def _summary(self) -> Iterator[Fact]:
        yield Fact("changes the verdict", "yes" if self.changes_verdict else "no")
        yield Fact("with memory", self.unsteady.stability)
        yield Fact("without", self.quasi_steady.stability)
        yield Fact("change of |Λ|max", f"{self.multiplier_change:+.4f}")

    @property
    def multiplier_change(self) -> float:
        """How much memory adds to the largest modulus of the Floquet multipliers."""
        return _largest(self.unsteady) - _largest(self.quasi_steady)

    @property
    def changes_verdict(self) -> bool:
        """Whether one flight is stable and the other one is not."""
        return self.unsteady.stability != self.quasi_steady.stability

    def __str__(self) -> str:
        """Say how speed, power and stability differ."""
        own, other = self.unsteady, self.quasi_steady
        verdict = "changes the verdict" if self.changes_verdict else "leaves the verdict as it is"
        return (
            f"The memory of the air {verdict}: with it {own.stability}, |Lambda|max "
            f"{_largest(own):.4f}, {own.mean_speed:.2f} m/s, {own.corrected_power:.2f} W as if "
            f"level; without it {other.stability}, {_largest(other):.4f}, "
            f"{other.mean_speed:.2f} m/s, {other.corrected_power:.2f} W."
        )


@checked
def memory_effect(cycle: FlightCycle) -> MemoryEffect:
    """Fly a bird in air with a memory and without, from the one flight to the other.

    Args:
        cycle: a flight in either.

    Returns:
        Both flights.

    Raises:
        OrbitError: there is no limit cycle nearby.
        TopologyError: the wing does not suit air with a memory (`birdmb.models.wake_states`).
    """
    model: BirdModel = cycle.model
    times = cycle.start_time + cycle.period * np.arange(_INSTANTS) / _INSTANTS
    states = cycle.trajectory(times).states[:, : len(model.motion_state_names)]
    if model.wake.count:
        other = model.in_air(wake="quasi-steady")
        return MemoryEffect(cycle, _flown(other, states, cycle.start_time))
    other = model.in_air(wake="unsteady")
    return MemoryEffect(_flown(other, other.with_lags(times, states), cycle.start_time), cycle)


def _flown(model: BirdModel, guess: FloatArray, start_time: float) -> FlightCycle:
    found = find_limit_cycle(model, guess, start_time=start_time)
    assert isinstance(found, FlightCycle)  # as all birds' are
    return found


def _largest(cycle: FlightCycle) -> float:
    return float(np.abs(cycle.multipliers).max())
