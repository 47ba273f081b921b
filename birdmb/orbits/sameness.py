"""Whether two orbits are the same: within their errors, at any phase, turned by whole periods."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from birdmb._typing import FloatArray
from birdmb.orbits.cycle import LimitCycle
from birdmb.orbits.deflation import Known, apart
from birdmb.orbits.problem import HasStatePeriods, Model

# In units of the state scale: what is left of an orbit found twice.
_FLOOR = 1e-6
_SHOT = 1e-5
_MARGIN = 10.0
_NODES = 65


def state_repeats(model: Model, scale: FloatArray) -> FloatArray:
    """Periods (n,) of the states in units of the scale (n,), infinite of those without one."""
    if not isinstance(model, HasStatePeriods):
        return np.full(len(scale), np.inf)
    return np.asarray(model.state_periods, float) / scale


def among(cycle: LimitCycle, others: Iterable[LimitCycle]) -> bool:
    """Whether an orbit is one of others within the errors of both."""
    return any(same_orbit(cycle, other) for other in others)


def same_orbit(one: LimitCycle, other: LimitCycle) -> bool:
    """Whether two orbits of a model are one within their errors.

    Of an autonomous system whatever state they begin at, and however often they go round in their
    periods; of any system a whole number of periods of its states apart.
    """
    scale = one.state_scale
    autonomous = one.model.period is None
    period, known_period = one.period, other.period
    if autonomous:
        period, known_period = one.minimal_period, other.minimal_period
    nodes = np.arange(_NODES) / _NODES
    gap = apart(
        one.trajectory(one.start_time + period * nodes).states / scale,
        period,
        Known(
            other.trajectory(one.start_time + known_period * nodes).states / scale,
            known_period if autonomous else None,
        ),
        state_repeats(one.model, scale),
        any_phase=autonomous,
    )
    largest = max(float(np.abs(gap.difference).max()), abs(gap.stretch))
    return largest <= _FLOOR + _MARGIN * (_error(one) + _error(other))


def _error(cycle: LimitCycle) -> float:
    return cycle.state_error if cycle.method == "collocation" else _SHOT
