"""What is written beside a flying bird."""

from __future__ import annotations

import numpy as np

from birdmb._typing import FloatArray
from birdmb.figures.style import downstrokes, holds_still, title_of
from birdmb.models import FlightCycle, MultibodyModel


def title_words(cycle: FlightCycle) -> str:
    """Bird and model."""
    model = "multibody" if isinstance(cycle.model, MultibodyModel) else "rigid"
    return f"{title_of(cycle)}, {model} model"


def flight_words(cycle: FlightCycle) -> str:
    """Speed, climb rate and frequency, in a line."""
    return (
        f"{cycle.mean_speed:.1f} m/s, climbing {_signed(cycle.mean_climb_rate)} m/s, "
        f"{1.0 / cycle.period:.3g} beats a second"
    )


def mode_words(cycle: FlightCycle, mode: int, amplitude: float) -> tuple[str, ...]:
    """What a mode is and what a beat makes of it; how large it is at the start."""
    kind = cycle.flight_modes[mode]
    name = " ".join(filter(None, [kind.plane, kind.name])) + " mode"
    size = abs(kind.multiplier)
    does = "grows" if size > 1 else "decays"
    swing = ""
    if kind.multiplier.imag:
        turn = 2.0 * np.pi / abs(np.angle(kind.multiplier))
        swing = f", oscillates in {turn:.3g} beats"
    return (
        f"{name}, {does} by the factor {size:.3g} a beat{swing}",
        f"at the start {amplitude:.2g} of the states' typical sizes",
    )


def _signed(rate: float) -> str:
    # No sign of what is rounded to zero.
    rounded = round(rate, 1) + 0.0
    return f"{rounded:+.1f}".replace("-", "−") if rounded else "0.0"


def stroke_words(cycle: FlightCycle, times: FloatArray) -> tuple[str, ...]:
    """Whether the wings go down or up at `times` (F,) s, or keep still."""
    if holds_still(cycle):
        return ("gliding",) * len(times)
    intervals = downstrokes(cycle)
    phases = np.mod(times - cycle.start_time + 1e-9 * cycle.period, cycle.period)
    within = cycle.start_time + phases
    down = [any(start <= t < end for start, end in intervals) for t in within]
    return tuple("downstroke" if each else "upstroke" for each in down)
