"""Chapter 5: the rigid bird's limit cycle, its multipliers and level flight."""

from __future__ import annotations

from collections.abc import Mapping

from birdmb.models import RigidModel
from birdmb.orbits import find_limit_cycle
from birdmb.reproduction.published import Case, Published, Verdict
from birdmb.reproduction.quantities import (
    FLAP_AMPLITUDE,
    bird,
    orbit_quantities,
    published_wing,
)
from birdmb.studies.trim import trim_flight
from birdmb.topology import Bird

_RIGID = "birdmb cycle ibis --model rigid"
_PROGRAM = (
    "the published program, run again, gives u = 18.068 m/s and multipliers 1.410, "
    "0.824 ± 0.263 i, 0.198 for this gait"
)
_COARSE = "the converged wing; the published discretisation is 1 to 2 % off"


def _reference_gait(expected: Verdict, reason: str) -> tuple[Published, ...]:
    printed = (
        ("u", "m/s", 18.24, 0.005),
        ("w", "m/s", -1.93, 0.005),
        ("q", "rad/s", -0.10, 0.005),
        ("theta", "rad", -0.115, 0.0005),
        ("multiplier 1", "", 1.40, 0.005),
        ("multiplier 2, Re", "", 0.829, 0.0005),
        ("multiplier 2, Im", "", 0.260, 0.0005),
        ("multiplier 4", "", 0.212, 0.0005),
    )
    return tuple(Published(*row, expected, reason) for row in printed)


def _orbit(one: Bird) -> Mapping[str, float]:
    return orbit_quantities(find_limit_cycle(RigidModel(one)))


def _level() -> Mapping[str, float]:
    trim = trim_flight(published_wing("ibis"), {FLAP_AMPLITUDE: (40.0, 47.0)})
    return {"flap amplitude": trim.values[FLAP_AMPLITUDE]}


CASES = (
    Case(
        "5",
        "chapter 5, reference gait, published discretisation",
        f"{_RIGID} --set wing.discretisation=published",
        lambda: _orbit(published_wing("ibis")),
        _reference_gait("contradicts", _PROGRAM),
    ),
    Case(
        "5",
        "chapter 5, reference gait, converged",
        _RIGID,
        lambda: _orbit(bird("ibis")),
        _reference_gait("differs", _COARSE),
    ),
    Case(
        "5",
        "chapter 5, level flight, published discretisation",
        "birdmb trim ibis --model rigid --by shoulder.flap.amplitude_deg=40:47 "
        "--set wing.discretisation=published",
        _level,
        (
            Published(
                "flap amplitude",
                "deg",
                43.47,
                0.005,
                "contradicts",
                "the published program, run again, levels the flight at 43.55 deg",
            ),
        ),
    ),
)
