"""What stability costs at a speed: the cheapest level flights, of all and of the stable ones."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from birdmb._typing import BoolArray, FloatArray
from birdmb.studies.tail import OPENING, VALID, within_limits
from birdmb.summary import Summarised

_SPEED_STEP = 0.5  # m/s


@dataclass(frozen=True, repr=False)
class PriceOfStability(Summarised):
    """The cheapest flights at a speed: of all within the limits, and of the stable ones.

    Attributes:
        speed: m/s.
        cheapest: least cost of transport.
        cheapest_stable: the same of those whose verdict is stable; NaN if there are none.
        opening: of the tail at the cheapest stable flight, degrees.
    """

    speed: float
    cheapest: float
    cheapest_stable: float
    opening: float

    @property
    def price(self) -> float:
        """How much more stable flight costs, as a part; NaN if there is none."""
        return self.cheapest_stable / self.cheapest - 1.0


def price_of_stability(
    data: xr.Dataset,
    *,
    limits: Mapping[str, float] = VALID,
    speeds: Sequence[float] | None = None,
) -> tuple[PriceOfStability, ...]:
    """Compare the cheapest flights of a study with the cheapest stable ones at the same speed.

    At exactly these speeds: cost and opening are interpolated linearly between neighbours on the
    grid that fly slower and faster, are both within the limits (and both stable), and lie on the
    same sheet of flights. Its error is of second order in the steps of the grid.

    Args:
        data: dataset of a study.
        limits: as for `within_limits`.
        speeds: m/s; by default all multiples of 0.5 m/s that are flown.
    """
    data = data.sortby([str(name) for name in data["cost_of_transport"].dims])
    allowed = within_limits(data, limits).transpose(*data["cost_of_transport"].dims).values
    stable = allowed & (data["stability"] == "stable").values
    speed = data["mean_speed"].values
    if speeds is None:
        flown = speed[allowed]
        if not flown.size:
            return ()
        first, last = np.ceil(flown.min() / _SPEED_STEP), np.floor(flown.max() / _SPEED_STEP)
        speeds = (_SPEED_STEP * np.arange(first, last + 1)).tolist()
    rows = []
    for wanted in speeds:
        cheapest, _ = _cheapest(data, allowed, wanted)
        if not np.isfinite(cheapest):
            continue
        cheapest_stable, opening = _cheapest(data, stable, wanted)
        rows.append(PriceOfStability(float(wanted), cheapest, cheapest_stable, opening))
    return tuple(rows)


def least_costs(
    data: xr.Dataset, speeds: Sequence[float], *, limits: Mapping[str, float] = VALID
) -> FloatArray:
    """Least cost of transport (K,) of level flights at speeds (K,) m/s, NaN where there is none.

    As of `price_of_stability`.
    """
    data = data.sortby([str(name) for name in data["cost_of_transport"].dims])
    allowed = within_limits(data, limits).transpose(*data["cost_of_transport"].dims).values
    return np.array([_cheapest(data, allowed, speed)[0] for speed in speeds])


def _cheapest(data: xr.Dataset, kept: BoolArray, wanted: float) -> tuple[float, float]:
    """Least cost at a speed among the flights kept, with the opening; NaN where there is none."""
    candidates = [found for pair in _pairs(data, kept) for found in _between(*pair, wanted)]
    return min(candidates, default=(np.nan, np.nan))


def _between(a: FloatArray, b: FloatArray, wanted: float) -> list[tuple[float, float]]:
    """Cost and opening at a speed between neighbours (3, K): speed, cost, opening."""
    across = (a[0] - wanted) * (b[0] - wanted) <= 0.0
    across &= a[0] != b[0]
    a, b = a[:, across], b[:, across]
    share = (wanted - a[0]) / (b[0] - a[0])
    _, cost, opening = a + share * (b - a)
    return list(zip(cost.tolist(), opening.tolist(), strict=True))


def _pairs(data: xr.Dataset, kept: BoolArray) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Neighbours along each parameter that are both kept and on one sheet, each (3, K)."""
    cost = data["cost_of_transport"]
    opening = data[OPENING].broadcast_like(cost).transpose(*cost.dims).values
    flights = np.array([data["mean_speed"].values, cost.values, opening])
    for axis, name in enumerate(cost.dims):
        jumps = data["sheet_jump"].sel(along=name).transpose(*cost.dims).values
        first, second = np.arange(data.sizes[name] - 1), np.arange(1, data.sizes[name])
        both = np.take(kept & ~jumps, first, axis) & np.take(kept, second, axis)
        yield (
            np.take(flights, first, axis + 1)[:, both],
            np.take(flights, second, axis + 1)[:, both],
        )
