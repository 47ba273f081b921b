"""A limit cycle as tables on a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from birdmb.cli.results import growth, verdict_sentence
from birdmb.cli.tables import table_of
from birdmb.quantities import BY_NAME, DISSIPATORS, IN_DEGREES, VALIDITIES

if TYPE_CHECKING:
    from birdmb.models import FlightCycle
    from birdmb.models.wing_model import BirdModel
    from birdmb.studies import Validity

_STYLES = {"stable": "bold green", "unstable": "bold red", "undecided": "bold yellow"}


def print_report(console: Console, cycle: FlightCycle, validity: Validity) -> None:
    """Print orbit, multipliers, flight and joints of a limit cycle, verdict and warnings."""
    for table in (_orbit(cycle), _multipliers(cycle), _flight(cycle, validity), _joints(cycle)):
        console.print()
        console.print(table)
    console.print()
    verdict = Text(verdict_sentence(cycle))
    verdict.highlight_words([cycle.stability], _STYLES[cycle.stability])
    if cycle.failed_checks or cycle.why_no_flight is not None:
        verdict.stylize("bold red", 0, verdict.plain.index(cycle.stability))
    console.print(verdict)
    for remark in cycle.remarks:
        console.print(remark, style="yellow", highlight=False)
    if validity.stall:
        console.print(f"stall: {validity.stall}", highlight=False)
    for warning in validity.warnings:
        console.print(f"outside the model's validity: {warning}", style="yellow", highlight=False)


def _orbit(cycle: FlightCycle) -> Table:
    known = (
        f"closed to {cycle.residual:.1e}"
        if cycle.nodes is None
        else f"known to {cycle.state_error:.1e} of typical sizes"
    )
    title = f"Orbit at t = {cycle.start_time:g} s, {known}"
    table = table_of(title, "state", "value", "unit", "in degrees", numbers=(1, 3))
    units = cycle.model.state_units
    moving = cycle.model.motion_state_names
    for name, value, unit in zip(moving, cycle.x0, units, strict=False):
        degrees = f"{np.degrees(value):.2f} {IN_DEGREES[unit]}" if unit in IN_DEGREES else ""
        table.add_row(name, f"{value:.6f}", unit, degrees)
    if lags := cycle.model.wake.count:
        table.caption = f"and {lags} lags of the wake"
    return table


def _multipliers(cycle: FlightCycle) -> Table:
    columns = ["Re", "Im", "modulus", "error", "a disturbance"]
    in_space = not cycle.model.motion.is_symmetric
    if in_space:
        columns.append("mode")
    table = table_of("Floquet multipliers", *columns, numbers=(0, 1, 2, 3))
    fading = [i for i, mode in enumerate(cycle.flight_modes) if mode.name == "wake"]
    for i, (value, error) in enumerate(zip(cycle.multipliers, cycle.verdict_errors, strict=True)):
        mode = cycle.flight_modes[i]
        # Of the wake's the largest tells of all, as long as they fade.
        if i in fading[1:] and abs(value) + error < 1.0:
            continue
        table.add_row(
            _number(value.real),
            _number(value.imag) if value.imag else "",
            _number(abs(value)),
            f"{error:.0e}",
            growth(cycle, i).partition(" (")[0] if in_space else growth(cycle, i),
            *([mode.name or mode.plane] if in_space else []),
            style="red" if abs(value) - error > 1 else None,
        )
    if len(fading) > 1:
        table.caption = (
            f"the wake's memory has {len(fading)} of them, of which the largest is shown: "
            f"{_number(abs(cycle.multipliers[fading[0]]))}"
        )
    return table


def _number(value: float) -> str:
    return f"{value:.6f}" if abs(value) >= 1e-3 else f"{value:.1e}"


def _flight(cycle: FlightCycle, validity: Validity) -> Table:
    table = table_of("Flight, mean over a beat", "quantity", "value", "unit", "", numbers=(1,))
    in_space = not cycle.model.motion.is_symmetric
    # Where nothing else takes power, all of it goes to the lift's induced drag.
    lost = any(cycle.dissipation[name] for name in DISSIPATORS if name != "lift")
    rows: list[tuple[str, FlightCycle | Validity, str]] = [
        *((name, cycle, "") for name in ("mean_speed", "mean_climb_rate", "path_angle")),
        *((name, cycle, "") for name in ("mean_bank", "turn_rate") if in_space),
        ("power", cycle, ""),
        ("feather_power", cycle, "  "),
        ("potential_power", cycle, ""),
        ("corrected_power", cycle, ""),
        *((f"lost_to_{name}", cycle, "  ") for name in DISSIPATORS if lost),
        ("cost_of_transport", cycle, ""),
        *((each.name, validity, "") for each in VALIDITIES),
        ("energy_imbalance", cycle, ""),
    ]
    for name, owner, indent in rows:
        quantity = BY_NAME[name]
        value = quantity.of(owner)
        if not np.isnan(value):
            table.add_row(
                indent + quantity.label, quantity.text(value), quantity.shown_unit, quantity.about
            )
    for row in _method(cycle, cycle.model):
        table.add_row(*row)
    return table


def _method(cycle: FlightCycle, model: BirdModel) -> list[tuple[str, str, str, str]]:
    """How the cycle was found, and what is known of its errors."""
    error = f"{cycle.integration_error:.1e}"
    if cycle.nodes is not None:
        return [
            ("method", "collocation", "", f"{cycle.nodes} nodes{_mesh(cycle)}"),
            ("error of the states", error, "", "in typical sizes, against more nodes"),
            ("flown closure", f"{cycle.flown_closure:.1e}", "", f"a check: {_flown(model)}"),
        ]
    return [
        ("method", "shooting", "", cycle.method_reason),
        ("integration", model.integration_method, "", _steps(model)),
        ("integration error", error, "", "of a beat, against half steps"),
        (
            "  of multipliers",
            f"{cycle.multiplier_integration_errors.max():.1e}",
            "",
            "counted in their errors above",
        ),
    ]


def _mesh(cycle: FlightCycle) -> str:
    return "" if cycle.intervals is None else f" on a mesh of {cycle.intervals} intervals"


def _flown(model: BirdModel) -> str:
    return f"{model.integration_method} integration, {_steps(model)}"


def _steps(model: BirdModel) -> str:
    if model.integration_method == "explicit":
        return f"{model.steps_per_beat} steps a beat"
    stiff = "joints or lags" if model.wake.count else "joints"
    return f"{model.steps_per_beat} steps a beat of Radau IIA: stiff {stiff}"


def _joints(cycle: FlightCycle) -> Table:
    """Powers into the joints, and of their drivers by sign."""
    joints, work = cycle.joint_powers, cycle.driver_work
    table = table_of(
        "Joint power, both wings: into the joint; of its driver, delivered and absorbed",
        "joint", "joint, W", "driver, W", "delivered", "absorbed",
        numbers=(1, 2, 3, 4),
    )  # fmt: skip
    rows = {name: (joints[name], work[name].net(), *work[name]) for name in joints}
    # Where there are no joints, numpy's sum of no rows is no row.
    whole = np.reshape(list(rows.values()), (-1, 4)).sum(axis=0)
    for name, row in (*rows.items(), ("all", whole)):
        table.add_row(name, *(f"{power:.3f}" for power in row))
    return table
