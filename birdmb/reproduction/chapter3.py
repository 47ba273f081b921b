"""Chapter 3: the planform's feathers, and the numbers of the flight's regime."""

from __future__ import annotations

from collections.abc import Mapping

from birdmb.models import FlightCycle
from birdmb.reproduction.published import Case, Published
from birdmb.reproduction.quantities import reference_cycle
from birdmb.studies.validity import assess_validity

# m, of the printed table; feathers 2, 4 and 6 stand between those that span the wing.
PRINTED_FEATHERS = {"1": 0.25, "2": 0.275, "3": 0.25, "4": 0.225, "5": 0.20, "6": 0.175, "7": 0.15}
_OF_THE_PROGRAM = (
    "the printed lengths of the feathers are not those of the published program: with them the "
    "bird climbs at 2.2 m/s"
)
_LEVEL = {"shoulder__flap__amplitude_deg": 43.47}


def printed_feathers() -> FlightCycle:
    """Cycle of the reference gait with the printed lengths of the four feathers that count."""
    lengths = {f"feathers__{k}__length": PRINTED_FEATHERS[k] for k in ("1", "3", "5", "7")}
    return reference_cycle(**lengths)


def _feathers() -> Mapping[str, float]:
    cycle = printed_feathers()
    return {
        "u": float(cycle.x0[0]),
        "multiplier 1": float(cycle.multipliers[0].real),
    }


def _regime() -> Mapping[str, float]:
    validity = assess_validity(reference_cycle(**_LEVEL))
    return {
        "reduced frequency": validity.reduced_frequency,
        "Strouhal number": validity.strouhal_number,
    }


CASES = (
    Case(
        "3",
        "chapter 3, the printed feather lengths with the flight of chapter 5",
        "birdmb cycle ibis --model rigid --set wing.discretisation=published "
        "--set feathers.1.length=0.25 --set feathers.3.length=0.25 --set feathers.5.length=0.2 "
        "--set feathers.7.length=0.15",
        _feathers,
        (
            Published("u", "m/s", 18.24, 0.005, "contradicts", _OF_THE_PROGRAM),
            Published("multiplier 1", "", 1.40, 0.005, "contradicts", _OF_THE_PROGRAM),
        ),
    ),
    Case(
        "3",
        "chapter 3, regime of the level flight",
        "birdmb cycle ibis --model rigid --set shoulder.flap.amplitude_deg=43.47 "
        "--set wing.discretisation=published",
        _regime,
        (
            Published("reduced frequency", "", 0.1, 0.05),
            Published("Strouhal number", "", 0.18, 0.005),
        ),
    ),
)
