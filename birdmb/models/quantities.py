"""The numbers that a flight is described by: one table for reports, files, sweeps and figures."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from operator import attrgetter
from typing import Any, NamedTuple

from birdmb.models.loads import DISSIPATORS


class Quantity(NamedTuple):
    """A number that a limit cycle of a bird has.

    Attributes:
        name: in files, datasets and JSON.
        unit: SI, or rad; "1" of what has none.
        about: what it is.
        of: computes it from a `FlightCycle`.
    """

    name: str
    unit: str
    about: str
    of: Callable[[Any], float]


def _own(name: str, unit: str, about: str) -> Quantity:
    """A quantity that is an attribute of the cycle."""
    return Quantity(name, unit, about, attrgetter(name))


def _lost(name: str) -> Quantity:
    about = {
        "lift": "power lost to the lift's induced drag",
        "profile": "power lost to the wings' profile drag",
        "tail": "power lost to the tail's drag",
        "body": "power lost to the body's drag",
    }[name]
    return Quantity(f"lost_to_{name}", "W", about, lambda cycle: cycle.dissipation[name])


QUANTITIES = (
    _own("mean_speed", "m/s", "mean speed"),
    _own("mean_climb_rate", "m/s", "mean climb rate, upwards positive"),
    _own("path_angle", "rad", "angle of the mean path above the horizon"),
    _own("mean_pitch", "rad", "mean pitch angle, nose up positive"),
    _own("mean_bank", "rad", "mean roll angle, right wing down positive"),
    _own("turn_rate", "rad/s", "mean rate of the heading, to the right positive"),
    _own("power", "W", "mean power to move the wings against the air"),
    _own("feather_power", "W", "the part of it that no joint or hinge delivers"),
    _own("potential_power", "W", "power drawn from sinking"),
    _own("corrected_power", "W", "power as if level"),
    _own("cost_of_transport", "1", "power / (weight x speed)"),
    *map(_lost, DISSIPATORS),
    _own("energy_imbalance", "1", "what a beat leaves over of the energy; a check"),
    _own("residual", "1", "closure error of the orbit, in the units of the states"),
    _own("state_error", "1", "error of a collocated orbit, in units of the state scale; 0 if shot"),
    _own("integration_error", "1", "the same, or of a shot one's flow over a beat"),
    _own("period", "s", "duration of a wingbeat"),
)


def quantities(names: Iterable[str]) -> tuple[Quantity, ...]:
    """Those of the table that have these names, in their order; raises `KeyError` for others."""
    by_name = {quantity.name: quantity for quantity in QUANTITIES}
    return tuple(by_name[name] for name in names)


def described_by(cycle: Any) -> dict[str, float]:
    """All of them of a `FlightCycle`, by name."""
    return {quantity.name: quantity.of(cycle) for quantity in QUANTITIES}
