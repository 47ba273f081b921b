"""The numbers that a flight is described by: one table for reports, files, sweeps and figures."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from operator import attrgetter
from typing import Any, NamedTuple

DISSIPATORS = ("lift", "profile", "tail", "body")
IN_DEGREES = {"rad": "°", "rad/s": "°/s"}
_SHOWN_AS = {**IN_DEGREES, "1": ""}


class Quantity(NamedTuple):
    """A number that describes a flight.

    Attributes:
        name: in files, datasets and JSON.
        unit: SI, or rad; "1" of what has none.
        label: in tables and on axes.
        about: what it is, beside the label.
        form: how many digits of it are shown, as a format specification.
        of: computes it, from a `FlightCycle` or from a `Validity`.
    """

    name: str
    unit: str
    label: str
    about: str
    form: str
    of: Callable[[Any], float]

    @property
    def shown_unit(self) -> str:
        """The unit as it is shown: degrees for rad, nothing for 1."""
        return _SHOWN_AS.get(self.unit, self.unit)

    @property
    def axis_label(self) -> str:
        """Label and unit."""
        return f"{self.label} ({self.shown_unit})" if self.shown_unit else self.label

    def shown(self, value: float) -> float:
        """The value in the unit that is shown."""
        return math.degrees(value) if self.unit.startswith("rad") else value

    def text(self, value: float) -> str:
        """The value as it is shown, without its unit; of what rounds to zero there is no sign."""
        text = format(self.shown(value), self.form)
        return format(0.0, self.form) if float(text) == 0.0 else text


def _own(name: str, unit: str, label: str, form: str, about: str = "") -> Quantity:
    """A quantity that is an attribute of what has it."""
    return Quantity(name, unit, label, about, form, attrgetter(name))


def _lost(name: str) -> Quantity:
    about = "its induced drag" if name == "lift" else ""
    return Quantity(
        f"lost_to_{name}", "W", f"lost to {name}", about, ".3f", lambda c: c.dissipation[name]
    )


QUANTITIES = (
    _own("mean_speed", "m/s", "speed", ".3f"),
    _own("mean_climb_rate", "m/s", "climb rate", "+.3f"),
    _own("path_angle", "rad", "path angle", "+.2f"),
    _own("mean_pitch", "rad", "pitch angle", "+.2f", "nose up positive"),
    _own("mean_bank", "rad", "bank", "+.2f", "right wing down positive"),
    _own("turn_rate", "rad/s", "turn rate", "+.2f", "to the right positive"),
    _own("power", "W", "wing power", ".3f", "to move the wings against the air"),
    _own("feather_power", "W", "of feathers", ".3f", "the part that no joint or hinge delivers"),
    _own("potential_power", "W", "potential power", ".3f", "drawn from sinking"),
    _own("corrected_power", "W", "corrected power", ".3f", "the sum: as if level"),
    _own("cost_of_transport", "1", "cost of transport", ".4f", "power / (weight x speed)"),
    *map(_lost, DISSIPATORS),
    _own("energy_imbalance", "1", "energy imbalance", ".1e", "a check: 0 if exact"),
    _own("residual", "1", "residual", ".1e", "closure error, in the units of the states"),
    _own("state_error", "1", "error of a collocated orbit", ".1e", "in typical sizes; 0 if shot"),
    _own("integration_error", "1", "error of the states", ".1e", "in typical sizes"),
    _own("period", "s", "wingbeat", ".4g", "duration of a beat"),
)

VALIDITIES = (
    _own("reduced_frequency", "1", "reduced frequency", ".3f", "pi f chord / speed"),
    _own("strouhal_number", "1", "Strouhal number", ".3f", "f x tip excursion / speed"),
    _own(
        *("largest_angle_of_attack", "rad", "angle of attack", ".1f"),
        "largest effective one, but for the tip",
    ),
    _own("largest_tail_angle", "rad", "angle of the tail", ".1f", "largest angle of attack"),
)

BY_NAME = {quantity.name: quantity for quantity in (*QUANTITIES, *VALIDITIES)}


def quantities(names: Iterable[str]) -> tuple[Quantity, ...]:
    """Those of the table that have these names, in their order; raises `KeyError` for others."""
    return tuple(BY_NAME[name] for name in names)


def described_by(cycle: Any) -> dict[str, float]:
    """All `QUANTITIES` of a `FlightCycle`, by name."""
    return {quantity.name: quantity.of(cycle) for quantity in QUANTITIES}


def valid_by(validity: Any) -> dict[str, float]:
    """All `VALIDITIES` of a `Validity`, by name."""
    return {quantity.name: quantity.of(validity) for quantity in VALIDITIES}
