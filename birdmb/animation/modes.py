"""A flight along a Floquet mode: the limit cycle and a deviation that grows or decays."""

from __future__ import annotations

import numpy as np

from birdmb._typing import ComplexArray, FloatArray
from birdmb.errors import ArgumentError
from birdmb.models import FlightCycle
from birdmb.orbits.segments import sample
from birdmb.orbits.trigonometric import along_path

# Of the mode, in differences of the flow.
_STEP = 1e-5


def mode_deviation(
    cycle: FlightCycle, mode: int, amplitude: float, times: FloatArray
) -> FloatArray:
    """Deviation (K, n) from the cycle along one mode at `times` (K,) s, in the states' units.

    By the linearised equations: amplitude * Re(exp(mu t) p(t)), with the mode's Floquet exponent mu
    and its periodic part p, t from the cycle's start. Each beat multiplies the mode by its
    multiplier. Source: Floquet (1883).

    Args:
        cycle: limit cycle of a bird.
        mode: position among `cycle.multipliers`.
        amplitude: of the largest entry of the mode at the cycle's start, in units of the state
            scale, as of `birdmb.mode_disturbance`.
        times: not before the cycle's start.

    Raises:
        ArgumentError: there is no such mode.
        StateError: the flow beside a cycle that was shot fails.
    """
    require_mode(cycle, mode)
    beats = (times - cycle.start_time) / cycle.period
    # Times at a beat's borders must not fall on either side of them by round-off.
    whole = np.floor(beats + 1e-9)
    phases = np.maximum(beats - whole, 0.0)
    multiplier = cycle.multipliers[mode]
    within = np.exp(cycle.exponents[mode] * cycle.period * phases)
    along = multiplier**whole * within
    return np.asarray(amplitude * (along[:, None] * _periodic_part(cycle, mode, phases)).real)


def require_mode(cycle: FlightCycle, mode: int) -> None:
    """Raise `ArgumentError` where a cycle has no such mode."""
    count = len(cycle.multipliers)
    if not 0 <= mode < count:
        raise ArgumentError(f"mode must be from 0 to {count - 1}, not {mode}.")


def shown_amplitude(cycle: FlightCycle, mode: int, beats: int) -> float:
    """Amplitude with which a mode over some beats is at most 1, in units of the state scale."""
    require_mode(cycle, mode)
    return float(max(1.0, abs(cycle.multipliers[mode])) ** -beats)


def _periodic_part(cycle: FlightCycle, mode: int, phases: FloatArray) -> ComplexArray:
    """Periodic part (K, n) of a mode at `phases` (K,), parts of the beat."""
    if cycle.nodes is not None and cycle.pieces is None:
        values = cycle.modes_along[:, :, mode]
        return along_path(values.real, phases) + 1j * along_path(values.imag, phases)
    return _flown_part(cycle, mode, phases)


def _flown_part(cycle: FlightCycle, mode: int, phases: FloatArray) -> ComplexArray:
    """As `_periodic_part`, by differences of the flow over a beat."""
    distinct, back = np.unique(phases, return_inverse=True)
    times = cycle.start_time + cycle.period * distinct
    end = cycle.start_time + cycle.period

    def flown(shift: FloatArray) -> FloatArray:
        return sample(cycle.model, cycle.x0 + shift, cycle.start_time, times, end)

    vector = cycle.modes[:, mode]
    real, imaginary = (
        (flown(_STEP * part) - flown(-_STEP * part)) / (2.0 * _STEP)
        for part in (vector.real, vector.imag)
    )
    carried = np.exp(-cycle.exponents[mode] * cycle.period * distinct)
    return np.asarray((carried[:, None] * (real + 1j * imaginary))[back])
