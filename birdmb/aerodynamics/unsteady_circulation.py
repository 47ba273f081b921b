"""Circulations of wings whose air remembers, and how their lags change (compiled kernels).

The lags and the equations are those of `birdmb.aerodynamics.wake_lags`, and, where flow separates,
of `birdmb.aerodynamics.separation`. Wings are the right one, or both, the left one mirrored onto
the right side: S sides with N elements each, M = S N in all. Of lags there are J kinds, 4 or 5.
Arrays with a last axis of 1 + D hold a value and its derivatives, those by the lags last.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray
from birdmb.aerodynamics.elements import Elements, downwash_share
from birdmb.aerodynamics.separation import Separation, no_separation, separated_flow
from birdmb.aerodynamics.wake_lags import (
    AT_ONCE,
    BOUND_RATES,
    BOUND_SHARES,
    TRAILING_RATES,
    TRAILING_SHARES,
    WakeLags,
)

_LAGGING = BOUND_SHARES[0] + BOUND_SHARES[1]


class LagSystem(NamedTuple):
    """What the circulations of M elements obey at an instant."""

    per_velocity: FloatArray  # (M,) m, circulation per normal velocity
    chord: FloatArray  # (M,) m
    half_span: FloatArray  # (S,) m
    downwash: FloatArray  # (M, M) 1/m, normal velocity lost per trailing circulation
    inverse: FloatArray  # (M, M), of what the normal velocities that lift obey


class Unsteady(NamedTuple):
    """Circulations of M elements, and the rates of the lags."""

    circulation: FloatArray  # (M, 1 + D) m2/s, bound
    trailing: FloatArray  # (M, 1 + D) m2/s, of the trailing vortices as they act on the wings
    shed: FloatArray  # (M, 1 + D) m/s, downwash of the shed vortices
    lag_rates: FloatArray  # (S J K, 1 + D)
    section: FloatArray  # (M, 3, 1 + D) of `Separation`; empty where no flow separates


@kernel
def _missed(lags: WakeLags, values: FloatArray) -> FloatArray:
    """What of `values` (M, ...) the curves through those kept miss."""
    n, sides = lags.spread.shape[0], values.shape[0] // lags.spread.shape[0]
    missed = values.copy()
    for side in range(sides):
        kept = np.empty((lags.kept.size, values.shape[1]))
        for k in range(lags.kept.size):
            kept[k] = values[side * n + lags.kept[k]]
        missed[side * n : (side + 1) * n] -= lags.spread @ kept
    return missed


@kernel
def _acting(lags: WakeLags, velocities: FloatArray) -> FloatArray:
    """What of normal velocities (M, ...) m/s acts at once."""
    return AT_ONCE * velocities + _LAGGING * _missed(lags, velocities)


@kernel
def lag_system(
    right: Elements, left: Elements, induced_y: FloatArray, induced_z: FloatArray, lags: WakeLags
) -> LagSystem:
    """The system of the right wing, or of both where the influences (M, M) 1/m are of 2 N elements.

    The left wing is mirrored onto the right side.
    """
    n, m = right.chord.size, induced_y.shape[0]
    sides = m // n
    per_velocity, chord, half_span = np.empty(m), np.empty(m), np.empty(sides)
    downwash = np.empty((m, m))
    for side in range(sides):
        wing = right if side == 0 else left
        rows = slice(side * n, (side + 1) * n)
        chord[rows] = wing.chord
        per_velocity[rows] = 0.5 * wing.profile[:, 0] * wing.chord
        half_span[side] = np.sum(wing.width)
        downwash[rows] = downwash_share(wing, induced_y[rows], induced_z[rows])
    for i in range(m):
        downwash[i] /= per_velocity[i]
    # Only what is not kept along the span acts at once on the wing that it leaves.
    own = np.zeros((m, m))
    for i in range(m):
        own[i, i] = per_velocity[i]
    matrix = _acting(lags, downwash @ _missed(lags, own))
    for i in range(m):
        matrix[i, i] += 1.0
    inverse = np.empty((m, m))
    inverse[:] = np.linalg.inv(matrix)
    return LagSystem(per_velocity, chord, half_span, downwash, inverse)


@kernel
def unsteady_circulations(
    system: LagSystem,
    lags: WakeLags,
    driving: FloatArray,
    speed: FloatArray,
    states: FloatArray,
    slopes_wanted: bool,
) -> Unsteady:
    """Circulations of M elements and the rates of the lags.

    `driving` (M, 1 + d) m/s are the normal velocities at the three-quarter-chord points without
    downwash, `speed` (M, 1 + d) m/s those along the stream, `states` (S J K,) the lags, side by
    side, kind by kind (`wake_lags.KINDS`), each from the root outwards. D is d, and with
    `slopes_wanted` the number of lags more.
    """
    given = driving.shape[1]
    lagging, trailing = _spread(lags, states, given, driving.shape[0], slopes_wanted)
    normal = -(system.downwash @ trailing)
    normal[:, :given] += driving
    lifting = system.inverse @ (_acting(lags, normal) + lagging)
    circulation = np.empty_like(lifting)
    for i in range(circulation.shape[0]):
        circulation[i] = system.per_velocity[i] * lifting[i]
    at_once = _missed(lags, circulation)
    separation = no_separation()
    separates = lags.separation.of.size > 0
    if separates:
        separation = _separation(system, lags, lifting, speed, states)
        circulation -= separation.lost
    trailing += at_once
    normal -= system.downwash @ at_once
    rates = _lag_rates(system, lags, normal, circulation, speed, states)
    if slopes_wanted:
        nothing, still = np.zeros((normal.shape[0], 1)), speed[:, :1].copy()
        fading = _lag_rates(system, lags, nothing, nothing, still, np.ones(states.size))
        for i in range(states.size):
            rates[i, given + i] += fading[i, 0]
    if separates:
        _put_shares(lags, separation.rates, rates)
    return Unsteady(circulation, trailing, normal - lifting, rates, separation.section)


@kernel
def _kinds(lags: WakeLags) -> int:
    """How many kinds of lags there are."""
    return 5 if lags.separation.of.size > 0 else 4


@kernel
def _separation(
    system: LagSystem, lags: WakeLags, lifting: FloatArray, speed: FloatArray, states: FloatArray
) -> Separation:
    """What separated flow does, of all lags."""
    kept, block = lags.kept.size, _kinds(lags) * lags.kept.size
    sides = states.size // block
    attached = np.empty(sides * kept)
    for side in range(sides):
        last = (side + 1) * block
        attached[side * kept : (side + 1) * kept] = states[last - kept : last]
    return separated_flow(
        lags.separation,
        lags.kept,
        lags.spread,
        system.per_velocity,
        system.chord,
        lifting,
        speed,
        attached,
        speed.shape[1] + block - kept,
        block,
    )


@kernel
def _put_shares(lags: WakeLags, shares: FloatArray, rates: FloatArray) -> None:
    """Put the rates (S K, 1 + D) of the attached shares among those of all lags."""
    kept, block = lags.kept.size, _kinds(lags) * lags.kept.size
    for side in range(shares.shape[0] // kept):
        last = (side + 1) * block
        rates[last - kept : last] = shares[side * kept : (side + 1) * kept]


@kernel
def _spread(
    lags: WakeLags, states: FloatArray, given: int, m: int, slopes_wanted: bool
) -> tuple[FloatArray, FloatArray]:
    """What of the lifting velocities and of the trailing circulations lags, (M, 1 + D) each."""
    n, kept = lags.spread.shape
    columns = given + states.size if slopes_wanted else given
    lagging, trailing = np.zeros((m, columns)), np.zeros((m, columns))
    for side in range(m // n):
        for kind in range(4):
            share = BOUND_SHARES[kind] if kind < 2 else TRAILING_SHARES[kind - 2]
            into = lagging if kind < 2 else trailing
            first = (_kinds(lags) * side + kind) * kept
            for e in range(n):
                for k in range(kept):
                    weight = share * lags.spread[e, k]
                    into[side * n + e, 0] += weight * states[first + k]
                    if slopes_wanted:
                        into[side * n + e, given + first + k] += weight
    return lagging, trailing


@kernel
def _lag_rates(
    system: LagSystem,
    lags: WakeLags,
    normal: FloatArray,
    circulation: FloatArray,
    speed: FloatArray,
    states: FloatArray,
) -> FloatArray:
    """Rates (S J K, 1 + D) of the lags, without the derivative by each one's own state.

    Those of attached shares are left at zero.
    """
    n, kept = lags.spread.shape
    kinds = _kinds(lags)
    rates = np.zeros((states.size, normal.shape[1]))
    for state in range(states.size):
        side, kind, k = state // (kinds * kept), state // kept % kinds, state % kept
        i = side * n + lags.kept[k]
        if kind == 4:
            continue
        if kind < 2:
            per_distance = 2.0 * BOUND_RATES[kind] / system.chord[i]
            rates[state] = per_distance * speed[i, 0] * normal[i]
            behind = normal[i, 0] - states[state]
        else:
            per_distance = TRAILING_RATES[kind - 2] / system.half_span[side]
            rates[state] = per_distance * speed[i, 0] * circulation[i]
            behind = circulation[i, 0] - states[state]
        rates[state, 0] = per_distance * speed[i, 0] * behind
        for c in range(1, speed.shape[1]):
            rates[state, c] += per_distance * speed[i, c] * behind
    return rates
