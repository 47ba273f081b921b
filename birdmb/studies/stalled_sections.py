"""Which sections of a bird's wings are stalled, and when in the beat."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from birdmb._typing import FloatArray
from birdmb.models import FlightCycle
from birdmb.summary import Summarised

STALLED = 0.5  # of the chord: below it flow is attached over less


@dataclass(frozen=True, repr=False)
class StalledSection(Summarised):
    """A section over which flow is separated from more than half of the chord in part of the beat.

    `str()` of it says where, when and how far.
    """

    point: int
    """Number, from the root, of the section among those whose separation is a state."""
    side: str
    """"right" or "left" where both wings do not do the same, else empty."""
    span_fraction: float
    """Place, a part of the half-span, averaged over the beat."""
    phases: tuple[tuple[float, float], ...]
    """Parts of the beat, from phase to phase in [0, 1), in which it is stalled.

    (0, 1) where it is all the time; past the end of the beat where the second is the smaller one.
    """
    largest_separation: float
    """Largest part of the chord that is separated."""
    phase: float
    """When that is, in [0, 1)."""

    def __str__(self) -> str:
        """Say where, when and how far."""
        of_wing = f" of the {self.side} wing" if self.side else ""
        when = " and ".join(
            "all of the beat" if (start, end) == (0.0, 1.0) else f"phases {start:.2f} to {end:.2f}"
            for start, end in self.phases
        )
        return (
            f"{self.span_fraction:.0%} of the half-span{of_wing} in {when}, at most "
            f"{self.largest_separation:.0%} of the chord (phase {self.phase:.2f})"
        )


def stall_sentence(sections: tuple[StalledSection, ...]) -> str:
    """Say which sections are stalled when."""
    if not sections:
        return "no section is stalled."
    return (
        "flow is separated from more than half of the chord at "
        f"{'; '.join(map(str, sections))}. Separation, its lag and the loads of the separated "
        "sections are part of the model."
    )


def stalled_sections(cycle: FlightCycle, wings: list[xr.Dataset]) -> tuple[StalledSection, ...]:
    """The sections that are stalled in a limit cycle.

    `wings`, the right one first, are as `Validity.data`, which tells places and side.
    """
    model, beat = cycle.model, cycle.beat
    wake = model.wake
    first = len(model.motion_state_names)
    shares = beat.states[:, first + wake.shares].reshape(beat.times.size, wake.sides, -1)
    phases = np.mod(beat.times / cycle.period, 1.0)
    found = []
    for side, wing in enumerate(wings):
        places = wing["span_fraction"].values.mean(axis=0)
        for point, element in enumerate(wake.lags.kept.tolist()):
            share = shares[:, min(side, wake.sides - 1), point]
            if share.min() >= STALLED:
                continue
            worst = int(np.argmin(share))
            found.append(
                StalledSection(
                    point=point + 1,
                    side=wing.attrs["side"],
                    span_fraction=float(places[element]),
                    phases=_phases_below(phases, share),
                    largest_separation=float(1.0 - share[worst]),
                    phase=float(phases[worst]),
                )
            )
    return tuple(found)


def _phases_below(phases: FloatArray, share: FloatArray) -> tuple[tuple[float, float], ...]:
    """Parts of the beat in which a share (K,), at equidistant phases (K,), is below the limit."""
    below = share < STALLED
    if below.all():
        return ((0.0, 1.0),)
    step = 1.0 / (share.size - 1)
    beyond = share[:-1] - STALLED
    fall = -np.diff(share)
    crossing = phases[:-1] + step * beyond / np.where(fall, fall, 1.0)
    starts = np.mod(crossing[~below[:-1] & below[1:]], 1.0)
    ends = np.mod(crossing[below[:-1] & ~below[1:]], 1.0)
    # Each start with the end that comes next.
    order = [int(np.argmin(np.mod(ends - start, 1.0))) for start in starts]
    return tuple((float(start), float(ends[end])) for start, end in zip(starts, order, strict=True))
