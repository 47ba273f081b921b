"""Whether a right-hand side repeats in the period it is given, and how often an orbit does."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError, StateError
from birdmb.orbits.problem import HasRates, HasRhs, KnowsRepetition, Model
from birdmb.orbits.right_hand_side import batched_rates

# A period typed with eight digits is off by less than this; one of another forcing by far more.
_SAME_RHS = 1e-7
# Of rates in state scales per period: what round-off leaves where the terms of a rate cancel.
_ROUND_OFF = 1e-9
# Phases that no simple fraction of the period meets, at which coincidences and jumps are unlikely.
_PHASES = np.array([0.0617, 0.2391, 0.4273, 0.6181, 0.8719])
# In units of the state scale, and of the orbit's own extent.
_SAME_STATE = 1e-6
_SAME_SHAPE = 1e-3
_MOST_TURNS = 12
_INSTANTS_COMPARED = 3


def require_period(
    model: Model, x: FloatArray, scale: FloatArray, start_time: float, period: float
) -> None:
    """Refuse a period in which the right-hand side does not repeat.

    Compared at the state `x` (n,): rhs(t) with rhs(t + period) of a forced system, with any other
    time of an autonomous one. A model without a right-hand side is believed.

    Raises:
        ArgumentError: it does not repeat.
    """
    if model.period is None:
        # The golden section of the period: no forcing that divides it looks constant.
        if not _rhs_repeats(model, x, scale, start_time, period, 0.6180339887 * period):
            raise ArgumentError(
                "the right-hand side depends on time, but the model has no period (None: "
                "autonomous). Give the model the period of its forcing."
            )
    elif not _rhs_repeats(model, x, scale, start_time, period, period):
        raise ArgumentError(
            f"the right-hand side does not repeat after {period:.12g} s, the period of the forcing "
            f"or a multiple of it. Give the period with all its digits, such as "
            f"2*numpy.pi/omega for cos(omega*t)."
        )


def turns(
    model: Model,
    states_at: Callable[[FloatArray], FloatArray],
    scale: FloatArray,
    start_time: float,
    period: float,
) -> int:
    """How often a closed orbit goes round in its period, up to 12; 1 for one that stands still.

    `states_at` returns the states (k, n) at times (k,). A forced orbit goes round several times
    only where the right-hand side repeats as often.
    """
    numbers = range(2, _MOST_TURNS + 1)
    shifted = np.mod(np.add.outer([0.0, *(1 / k for k in numbers)], _PHASES), 1.0)
    states = states_at(start_time + period * shifted.ravel()).reshape(*shifted.shape, -1) / scale
    allowed = min(_SAME_STATE, _SAME_SHAPE * float(np.abs(states - states[0, 0]).max()))
    if allowed == 0:
        return 1
    for number, turned in reversed(list(zip(numbers, states[1:], strict=True))):
        if np.abs(turned - states[0]).max() > allowed:
            continue
        if model.period is None or (
            isinstance(model, HasRates | HasRhs)
            and _rhs_repeats(
                model, states[0, 0] * scale, scale, start_time, period, period / number
            )
        ):
            return number
    return 1


def _rhs_repeats(
    model: Model, x: FloatArray, scale: FloatArray, start: float, period: float, shift: float
) -> bool:
    if not isinstance(model, HasRates | HasRhs):
        return True
    if isinstance(model, KnowsRepetition) and model.repeats_after(shift):
        return True
    times = start + period * _PHASES[:_INSTANTS_COMPARED]
    try:
        at = np.concatenate([times, times + shift])
        now, then = np.split(batched_rates(model)(at, np.tile(x, (len(at), 1))), 2)
    except StateError:
        return True
    late = float(np.finfo(float).eps * np.abs(times).max() / period)
    rates = np.abs(now).max(axis=0)
    allowed = (_SAME_RHS + 100 * late) * rates + _ROUND_OFF * scale / period
    return bool((np.abs(then - now) <= allowed).all())
