"""The birds behind the printed numbers, and the numbers that a flight gives."""

from __future__ import annotations

import numpy as np
import xarray as xr

from birdmb._typing import FloatArray
from birdmb.models import FlightCycle, RigidModel
from birdmb.orbits import find_limit_cycle
from birdmb.topology import Bird, load_bird

PUBLISHED_WING = {"wing.discretisation": "published"}
FLAP_AMPLITUDE = "shoulder.flap.amplitude_deg"
ROLL_OFFSET = "forearm.roll.offset_deg"
STATES = ("u", "w", "q", "theta")


def bird(name: str, **values: object) -> Bird:
    """A bird of the package with values by dotted name, a double underscore for each dot."""
    return load_bird(name).with_values({k.replace("__", "."): v for k, v in values.items()})


def published_wing(name: str, **values: object) -> Bird:
    """A bird of the package with the published discretisation of its wing."""
    return bird(name, **values).with_values(PUBLISHED_WING)


def orbit_quantities(cycle: FlightCycle) -> dict[str, float]:
    """Initial state and multipliers of a cycle with two real multipliers and one pair."""
    multipliers = cycle.multipliers
    real = multipliers[np.abs(multipliers.imag) < 1e-9].real
    pair = multipliers[multipliers.imag > 1e-9]
    return dict(zip(STATES, map(float, cycle.x0), strict=False)) | {
        "multiplier 1": float(real[0]),
        "multiplier 2, Re": float(pair[0].real),
        "multiplier 2, Im": float(pair[0].imag),
        "multiplier 4": float(real[1]),
    }


def multiplier_moduli(study: xr.Dataset) -> FloatArray:
    """Moduli of the multipliers of a parameter study, (values, multipliers)."""
    real, imag = study["multiplier_real"].values, study["multiplier_imag"].values
    return np.asarray(np.hypot(real, imag))


def flight_quantities(cycle: FlightCycle) -> dict[str, float]:
    """Largest |multiplier|, powers and means of a cycle."""
    return {
        "largest |multiplier|": float(np.abs(cycle.multipliers).max()),
        "speed": cycle.mean_speed,
        "climb rate": cycle.mean_climb_rate,
        "power": cycle.power,
        "P_act": cycle.power,
        "P_g": cycle.potential_power,
        "cost of transport": cycle.cost_of_transport,
    }


def reference_cycle(**values: object) -> FlightCycle:
    """Limit cycle of the rigid reference bird with the published wing, with further values."""
    return find_limit_cycle(RigidModel(published_wing("ibis", **values)))
