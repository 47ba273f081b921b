"""How many harmonics the samples tell of each joint."""

from __future__ import annotations

import numpy as np

from birdmb._typing import FloatArray
from birdmb.kinematics.beats import most_harmonics
from birdmb.kinematics.errors import KinematicsError
from birdmb.kinematics.observations import Observations
from birdmb.kinematics.series import Gait, Solved, fit_series, reweighted

_MOST = 6
_PATIENCE = 2  # numbers of harmonics without use, after which no more are tried
_SIGNIFICANT = 9.21  # chi squared of two coefficients, which 1 % of noise exceeds


def fit_orders(
    seen: Observations,
    start: Gait,
    scatter: FloatArray,
    harmonics: int | None,
    *,
    hold_frequency: bool,
) -> Solved:
    """Fit a gait with `harmonics`, or with as many as the Bayesian information criterion takes.

    Of the latter, those of a joint are left out, from the highest on, that are not significant.

    Raises:
        KinematicsError: the samples do not tell as many.
    """
    count = len(start.joints)
    most = most_harmonics(start.phases(seen.times))
    if harmonics is not None:
        if harmonics > most:
            raise KinematicsError(
                f"{seen.origin}: the samples tell {most} harmonics, not {harmonics}."
            )
        gait = start.with_orders((harmonics,) * count)
        solved = fit_series(seen, gait, scatter, hold_frequency=hold_frequency)
        return reweighted(seen, solved, hold_frequency=hold_frequency)
    gait = start.with_orders((min(max(start.orders), most),) * count)
    best = fit_series(seen, gait, scatter, hold_frequency=hold_frequency)
    best = reweighted(seen, best, hold_frequency=hold_frequency)
    tried = best.gait.harmonics
    while tried < min(best.gait.harmonics + _PATIENCE, _MOST, most):
        tried += 1
        gait = best.gait.with_orders((tried,) * count)
        more = fit_series(seen, gait, best.scatter, hold_frequency=hold_frequency)
        if more.criterion < best.criterion:
            best = reweighted(seen, more, hold_frequency=hold_frequency)
    orders = _significant(best)
    if orders != best.gait.orders:
        gait = best.gait.with_orders(orders)
        best = fit_series(seen, gait, best.scatter, hold_frequency=hold_frequency)
        best = reweighted(seen, best, hold_frequency=hold_frequency)
    return best


def _significant(solved: Solved) -> tuple[int, ...]:
    covariance = np.linalg.pinv(solved.information, hermitian=True) * solved.variance
    rows, places = solved.gait.unknowns
    kept = []
    for row, most in enumerate(solved.gait.orders):
        order = most
        while order > 1:
            own = np.flatnonzero((rows == row) & ((places + 1) // 2 == order))
            pair = solved.gait.coefficients[row, places[own]]
            if pair @ np.linalg.solve(covariance[np.ix_(own, own)], pair) > _SIGNIFICANT:
                break
            order -= 1
        kept.append(order)
    return tuple(kept)
