"""The conclusions of chapter 6 that are numbers, beside those computed here."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from pathlib import Path

from birdmb.models import GaussianGust
from birdmb.reproduction.chapter6_flights import (
    AS_PUBLISHED,
    SHIPPED,
    TABLE_6_2,
    Values,
    flight_of_table_6_2,
    peaks_apart,
    slow_period,
    stable_opening,
    with_gait,
)
from birdmb.reproduction.published import Case, Published
from birdmb.reproduction.quantities import FLAP_AMPLITUDE
from birdmb.reproduction.tail_study import RULES, TRIM, chapter_6_study
from birdmb.studies.gust import gust_response
from birdmb.studies.tail import within_limits
from birdmb.studies.trim import trim_flight

_SPEED = 14.0  # m/s
_AMPLITUDES = {FLAP_AMPLITUDE: (25.0, 50.0)}
# Sweep offsets (degrees) at which level flight at 14 m/s is cheapest, on a grid of 1 degree.
_CHEAPEST_SWEEPS = {"shipped": {0.0: -11.0, 40.0: -14.0}, "published": {0.0: -10.0, 40.0: -15.0}}
_CHEAPEST = (37.0, -9.0, 30.0)  # opening, sweep offset, flap amplitude; of the study's flights


def _price_of_opening(wing: str, values: Values) -> Mapping[str, float]:
    costs = []
    for opening, sweep in _CHEAPEST_SWEEPS[wing].items():
        gait = with_gait(opening, sweep, 40.0, values)
        cycle = trim_flight(gait, TRIM | _AMPLITUDES, speed=_SPEED).cycle
        costs.append(cycle.cost_of_transport)
    furled, opened = costs
    return {"more cost of transport": 100.0 * (opened / furled - 1.0)}


def _least_cost() -> Mapping[str, float]:
    cycle = trim_flight(with_gait(*_CHEAPEST), TRIM).cycle
    return {"least cost of transport": cycle.cost_of_transport}


def _of_whole_study() -> Mapping[str, float]:
    with tempfile.TemporaryDirectory() as folder:
        data = chapter_6_study(Path(folder) / "study.db").to_xarray()
    return {"admissible flights": float(within_limits(data, RULES).sum())}


def _opening_of_stability() -> Mapping[str, float]:
    return {"stable from an opening of": stable_opening(with_gait(*TABLE_6_2["b"][0]))}


def _phugoid() -> Mapping[str, float]:
    cycle = flight_of_table_6_2("b").cycle
    flight = gust_response(cycle, GaussianGust(vertical=1.0), axes="body", periods=44)
    return {
        "phugoid by its multiplier": slow_period(cycle),
        "phugoid by peaks of u": peaks_apart(flight),
    }


_PRICE = (
    "each opening with the sweep and amplitude that are cheapest at 14 m/s; the flights (a) and "
    "(b) of table 6.2, whose sweeps and amplitudes are others, are 8 % apart here too"
)
_STABLE = (
    "for the gait of table 6.2 (b); 21 to 30 deg with the sweep offset at -12 deg, and 20.2 deg "
    "with the printed chord of 0.25 m"
)
CONCLUSIONS = (
    Case(
        "6",
        "chapter 6, price of a tail open 40 deg at 14 m/s, as shipped",
        "python -m birdmb.reproduction --figure 6.5",
        lambda: _price_of_opening("shipped", SHIPPED),
        (Published("more cost of transport", "%", 10.0, 1.0, "differs", _PRICE),),
    ),
    Case(
        "6",
        "chapter 6, price of a tail open 40 deg at 14 m/s, published wing, no downwash",
        "python -m birdmb.reproduction --figure 6.5",
        lambda: _price_of_opening("published", AS_PUBLISHED),
        (Published("more cost of transport", "%", 10.0, 1.0, "differs", _PRICE),),
    ),
    Case(
        "6",
        "chapter 6, the cheapest flight, as shipped",
        "python -m birdmb.reproduction --figure 6.5",
        _least_cost,
        (
            Published(
                "least cost of transport",
                "",
                0.085,
                0.0005,
                "differs",
                "a fifth of it is the wing: 0.0812 with the published one and no downwash on the "
                "tail, on every fifth value of the ranges; the rest is not explained",
            ),
        ),
    ),
    Case(
        "6",
        "chapter 6, opening from which level flight is stable, as shipped",
        "python -m birdmb.reproduction --table 6.openings",
        _opening_of_stability,
        (Published("stable from an opening of", "deg", 25.0, 2.5, "differs", _STABLE),),
    ),
    Case(
        "6",
        "figure 6.4 (b), slow oscillation after a gust, as shipped",
        "birdmb gust ibis_tail --model rigid --vertical 1 --axes body --beats 44",
        _phugoid,
        (
            Published(
                "phugoid by its multiplier",
                "s",
                8.0,
                0.5,
                "differs",
                "read between the first two peaks of u it is 8: the first one is the gust's own",
            ),
            Published(
                *("phugoid by peaks of u", "s", 8.0, 0.5),
                reason="printed as about 8 s",
            ),
        ),
    ),
    Case(
        "6",
        "chapter 6, flights within the two rules, as shipped",
        "python -m birdmb.reproduction --figure 6.5",
        _of_whole_study,
        (
            Published(
                "admissible flights",
                "",
                5604.0,
                0.5,
                "differs",
                "not explained: neither downwash, incidence nor wing changes the share of flights "
                "within the rules by more than 7 %",
            ),
        ),
        long=True,
    ),
)
