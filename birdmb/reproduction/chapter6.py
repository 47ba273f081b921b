"""Chapter 6: the bird with its tail spread, level at 14 m/s."""

from __future__ import annotations

from collections.abc import Mapping

from birdmb.reproduction.published import Case, Published
from birdmb.reproduction.quantities import ROLL_OFFSET, bird, flight_quantities, published_wing
from birdmb.studies.trim import trim_flight
from birdmb.topology import Bird


def _open_tail(roll_reason: str, power_reason: str) -> tuple[Published, ...]:
    return (
        Published("largest |multiplier|", "", 0.96, 0.005),
        Published("power", "W", 16.7, 0.05, "differs", power_reason),
        Published("speed", "m/s", 14.0, 0.2, reason="the thesis aims at 14 m/s"),
        Published("roll offset", "deg", -5.5, 0.05, "differs", roll_reason),
    )


def _level(one: Bird) -> Mapping[str, float]:
    trim = trim_flight(one)
    return flight_quantities(trim.cycle) | {"roll offset": trim.values[ROLL_OFFSET]}


CASES = (
    Case(
        "6",
        "chapter 6, tail 40 deg open, level, tail at 2 deg to the body",
        "birdmb trim ibis_tail --model rigid",
        lambda: _level(bird("ibis_tail")),
        _open_tail("the wake acts on the tail", "the wake acts on the tail"),
    ),
    Case(
        "6",
        "chapter 6, tail along the body, without downwash, published discretisation",
        "birdmb trim ibis_tail --model rigid --set tail.incidence_deg=0 "
        "--set tail.downwash=none --set wing.discretisation=published",
        lambda: _level(published_wing("ibis_tail", tail__incidence_deg=0.0, tail__downwash="none")),
        _open_tail("not explained", "not explained"),
    ),
)
