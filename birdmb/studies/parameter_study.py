"""One parameter varied, and what becomes of the limit cycle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from birdmb.arguments import checked
from birdmb.errors import BirdmbError
from birdmb.models import FlightCycle, RigidModel
from birdmb.quantities import quantities
from birdmb.studies.cycles import ModelFactory, WarmCycles
from birdmb.studies.relevance import check_relevant
from birdmb.studies.validity import assess_validity
from birdmb.topology import Bird

_KEPT = quantities(("mean_speed", "mean_climb_rate", "path_angle", "power", "residual"))


@checked
def parameter_study(
    bird: Bird, name: str, values: Sequence[Any], model: ModelFactory = RigidModel
) -> xr.Dataset:
    """Find the limit cycle for each value of one parameter, each starting from the one before.

    Serial and in memory: for a few dozen values. Where several cycles exist, starting from the one
    before follows one family of them, so that the order of the values matters.

    Args:
        bird: the bird.
        name: dotted name of the parameter.
        values: its values, in the order in which they are computed.
        model: makes the model of a bird.

    Returns:
        By `name` as dimension: `x0` (state), `multiplier_real`, `multiplier_imag` and
        `multiplier_error` (multiplier, largest modulus first), `mean_speed`, `mean_climb_rate`
        (m/s), `path_angle` (rad), `power` (W, `FlightCycle.power`), `residual`. As texts, empty
        where all is well: `warning`, how the cycle leaves the model's validity
        (`assess_validity`), and `failure`, why there is no cycle, all numbers then being NaN.

    Raises:
        TopologyError: an unknown name. A value that is impossible only fails by itself.
        ArgumentError: the value has no effect on the model.
    """
    bird.value(name)
    if len(values):
        check_relevant(bird, {name: values}, model)
    find = WarmCycles(bird, model)
    cycles: list[FlightCycle | None] = []
    failures = []
    for value in values:
        try:
            cycles.append(find({name: value}))
            failures.append("")
        except BirdmbError as error:
            cycles.append(None)
            failures.append(str(error))
    found = [cycle for cycle in cycles if cycle is not None]
    states = found[0].state_names if found else model(bird).state_names
    rows = [_row(cycle, len(states)) for cycle in cycles]
    per_state = {"x0": "state"} | {
        f"multiplier_{part}": "multiplier" for part in ("real", "imag", "error")
    }
    variables: dict[str, Any] = {
        key: ((name, axis), np.array([row[key] for row in rows])) for key, axis in per_state.items()
    } | {
        each.name: (name, np.array([row[each.name] for row in rows]), {"units": each.unit})
        for each in _KEPT
    }
    return xr.Dataset(
        {
            **variables,
            "warning": (name, np.array([_warning(cycle) for cycle in cycles], dtype=str)),
            "failure": (name, np.array(failures, dtype=str)),
        },
        coords={
            name: (name, np.array(values), _about(name)),
            "state": list(states),
            "multiplier": np.arange(len(states)),
        },
        attrs={"bird": bird.name, "fingerprint": bird.fingerprint(), "parameter": name},
    )


def _row(cycle: FlightCycle | None, states: int) -> dict[str, Any]:
    if cycle is None:
        nothing = np.full(states, np.nan)
        of_states = ("x0", "multiplier_real", "multiplier_imag", "multiplier_error")
        return dict.fromkeys(of_states, nothing) | {each.name: np.nan for each in _KEPT}
    return {
        "x0": cycle.x0,
        "multiplier_real": cycle.multipliers.real,
        "multiplier_imag": cycle.multipliers.imag,
        "multiplier_error": cycle.verdict_errors,
        **{each.name: each.of(cycle) for each in _KEPT},
    }


def _warning(cycle: FlightCycle | None) -> str:
    return "" if cycle is None else " ".join(assess_validity(cycle).warnings)


def _about(name: str) -> dict[str, str]:
    return {"units": "deg"} if name.endswith("_deg") else {}
