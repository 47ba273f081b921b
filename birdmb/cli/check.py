"""The command `birdmb check`: what bird a topology file describes, and what to beware of."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict

import numpy as np
import typer
from rich.table import Table

from birdmb.aerodynamics.body_drag import body_drag, body_drag_force
from birdmb.aerodynamics.tail import tail_surface
from birdmb.cli.console import messages, output
from birdmb.cli.progress import Progress
from birdmb.cli.results import finite
from birdmb.cli.tables import table_of
from birdmb.errors import StateError
from birdmb.models.natural_oscillation import (
    NaturalOscillation,
    hinge_oscillations,
    joint_oscillations,
)
from birdmb.studies.bird_warnings import bird_warnings, load_warnings
from birdmb.studies.flight_regime import LIFT_COEFFICIENT, FlightRegime, flight_regime
from birdmb.studies.refinement import LoadChange, load_change
from birdmb.topology import SIDES, Bird, Joint

_DRAG_SPEED = 10.0  # m/s


def run(bird: Bird, *, as_json: bool) -> None:
    """Print what a bird is, and warnings."""
    progress = Progress(messages())
    with progress.shown():
        progress.doing("measuring the wing")
        warnings = bird_warnings(bird)
        change = _load_change(bird, progress)
        if change is not None:
            warnings += load_warnings(change)
        told = _object(bird, change, warnings) if as_json else _tables(bird, change)
    if as_json:
        json.dump(told, sys.stdout, indent=2, allow_nan=False)
        typer.echo()
        return
    console = output()
    for table in told:
        console.print()
        console.print(table)
    console.print()
    for warning in warnings:
        console.print(f"Warning: {warning}", style="yellow", highlight=False, markup=False)
    if not warnings:
        console.print("No warnings.", style="green")


def _tables(bird: Bird, change: LoadChange | None) -> list[Table]:
    tables = [_bird(bird), _segments(bird), _joints(bird)]
    if any(not _is_one_sine(joint) for _, joint in _joints_by_side(bird)):
        tables.append(_drivers(bird))
    if bird.compliant_joints:
        tables.append(_oscillations("Compliant joints", "joint", joint_oscillations(bird)))
    if bird.hinged_feathers:
        tables.append(_oscillations("Hinges of feathers", "hinge", hinge_oscillations(bird)))
    if change is not None:
        tables.insert(1, _loads(bird, change))
    return tables


def _object(bird: Bird, change: LoadChange | None, warnings: list[str]) -> dict[str, object]:
    """What `birdmb check --json` prints, in SI units and rad."""
    regime, numbers = flight_regime(bird), bird.wing.resolved_discretisation
    swinging = joint_oscillations(bird) | hinge_oscillations(bird)
    return {
        "bird": bird.name,
        "fingerprint": bird.fingerprint(),
        "mass": bird.total_mass,
        "body_mass": bird.body.mass,
        "inertia_yy": bird.body.inertia_yy,
        "frequency": bird.gait.frequency,
        "lift_coefficient": LIFT_COEFFICIENT,
        **{name: finite(value) for name, value in asdict(regime).items()},
        "elements": numbers.elements,
        "scheme": numbers.scheme,
        "load_change": None if change is None else asdict(change),
        "segments": {
            name: {"length": segment.length, "mass": segment.mass}
            for name, segment in bird.segments.items()
        },
        "joints": {name: _joint_object(joint) for name, joint in _joints_by_side(bird)},
        "oscillations": {name: _free_object(free) for name, free in swinging.items()},
        "warnings": warnings,
    }


def _joint_object(joint: Joint) -> dict[str, object]:
    low, high = joint.driver.range
    return {
        "segment": joint.segment,
        "mode": joint.mode,
        "stiffness": joint.stiffness,
        "damping": joint.damping,
        "mean": joint.driver.mean,
        "lowest": low,
        "highest": high,
        "harmonics": len(joint.driver.cosine),
    }


def _free_object(free: NaturalOscillation) -> dict[str, object]:
    return {
        "stiffness": free.stiffness,
        "damping": free.damping,
        "inertia": free.inertia,
        "frequency": finite(free.frequency) if free.inertia else None,
    }


def _load_change(bird: Bird, progress: Progress) -> LoadChange | None:
    """None where the wing has no loads, of which `bird_warnings` tells."""
    progress.doing("comparing the loads on two numbers of elements")
    try:
        return load_change(bird)
    except StateError:
        return None


def _loads(bird: Bird, change: LoadChange) -> Table:
    own = bird.wing.resolved_discretisation.elements
    table = table_of(
        f"Loads of a beat at mean trim, change from {own} to {change.elements} elements",
        "quantity", "change", "unit",
        numbers=(1,),
    )  # fmt: skip
    table.add_row("force, wings and all", f"{1e2 * change.force:.2g}", "%")
    table.add_row("largest circulation", f"{1e2 * change.circulation:.2g}", "%")
    return table


def _bird(bird: Bird) -> Table:
    table = table_of(bird.name, "quantity", "value", "unit", numbers=(1,))
    regime = flight_regime(bird)
    numbers = bird.wing.resolved_discretisation
    weight = bird.total_mass * bird.gravity
    rows = (
        ("mass of the whole bird", f"{bird.total_mass:.6g}", "kg"),
        ("mass of the body", f"{bird.body.mass:.6g}", "kg"),
        ("pitch inertia of the body", f"{bird.body.inertia_yy:.4g}", "kg m2"),
        *_with_attachments(bird),
        ("span, joints at zero", f"{regime.span:.3f}", "m"),
        ("wing area, joints at zero", f"{regime.area:.4f}", "m2"),
        ("aspect ratio, joints at zero", f"{regime.aspect_ratio:.3g}", ""),
        ("wing loading", f"{weight / regime.area:.1f}", "N/m2"),
        ("wingbeat frequency", f"{bird.gait.frequency:.4g}", "Hz"),
        *_at_speed(regime),
        ("elements per wing", f"{numbers.elements}", f"{numbers.scheme}"),
        *_tail_and_drag(bird),
    )
    for row in rows:
        table.add_row(*row)
    return table


def _at_speed(regime: FlightRegime) -> list[tuple[str, str, str]]:
    if np.isnan(regime.speed):
        return []
    rows = [
        (f"speed U at lift coefficient {LIFT_COEFFICIENT:g}", f"{regime.speed:.3g}", "m/s"),
        ("Reynolds number of the mean chord at U", f"{regime.reynolds_number:.2g}", ""),
    ]
    if not np.isnan(regime.reduced_frequency):
        rows += [
            ("reduced frequency at U", f"{regime.reduced_frequency:.2g}", ""),
            ("Strouhal number at U", f"{regime.strouhal_number:.2g}", ""),
        ]
    return rows


def _with_attachments(bird: Bird) -> list[tuple[str, str, str]]:
    """What the body has with all that is attached to it, and where its centre of mass is then."""
    if not bird.attachments:
        return []
    whole = bird.assembled
    moved = bird.wing.root.x - whole.wing.root.x
    return [
        ("mass of the body, all attached", f"{whole.body.mass:.6g}", "kg"),
        ("pitch inertia of the body, all attached", f"{whole.body.inertia_yy:.4g}", "kg m2"),
        ("its centre of mass, ahead by", f"{moved:.4g}", "m"),
    ]


def _tail_and_drag(bird: Bird) -> list[tuple[str, str, str]]:
    rows = []
    if bird.tail is not None:
        surface = tail_surface(bird)
        rows += [
            ("tail opening", f"{np.degrees(bird.tail.opening):.4g}", "°"),
            ("tail span", f"{surface.span:.3f}", "m"),
            ("tail area", f"{surface.area:.4f}", "m2"),
        ]
    if bird.drag.profile_coefficient:
        rows.append(("profile drag coefficient", f"{bird.drag.profile_coefficient:.4g}", ""))
    if bird.drag.body:
        drag = -body_drag_force(body_drag(bird.assembled), np.array([_DRAG_SPEED, 0.0, 0.0]))[0, 0]
        rows.append((f"body drag at {_DRAG_SPEED:g} m/s", f"{drag:.3g}", "N"))
    return rows


def _segments(bird: Bird) -> Table:
    table = table_of("Segments of one wing", "segment", "length, m", "mass, kg", numbers=(1, 2))
    for bone, segment in bird.segments.items():
        table.add_row(bone, f"{segment.length:.4g}", f"{segment.mass:.4g}")
    return table


def _joints(bird: Bird) -> Table:
    table = table_of(
        "Joints from the body outwards; drivers in degrees",
        "joint", "segment", "mode", "offset", "amplitude", "phase",
        numbers=(3, 4, 5),
    )  # fmt: skip
    for name, joint in _joints_by_side(bird):
        sine = _is_one_sine(joint)
        swing = map(_in_degrees, (joint.gain * joint.amplitude, joint.phase))
        table.add_row(
            name,
            joint.segment,
            joint.mode,
            _in_degrees(joint.driver.mean),
            *(swing if sine else ("*", "*")),
        )
    return table


def _joints_by_side(bird: Bird) -> list[tuple[str, Joint]]:
    """The joints by name, or those of each side where the sides differ."""
    return [
        (name, own)
        for joint in bird.joints
        for name, own in (
            [(joint.name, joint.on("right"))]
            if joint.on("right") == joint.on("left")
            else [(f"{joint.name}.{side}", joint.on(side)) for side in SIDES]
        )
    ]


def _drivers(bird: Bird) -> Table:
    table = table_of(
        "* Drivers other than sines, degrees; residuals, error",
        "joint", "from", "to", "harmonics", "rms", "largest", "error",
        numbers=(1, 2, 3, 4, 5, 6),
    )  # fmt: skip
    for name, joint in _joints_by_side(bird):
        driver, fit = joint.driver, joint.driver.fit
        if _is_one_sine(joint):
            continue
        left = (fit.rms_residual, fit.largest_residual, fit.truncation) if fit else ()
        table.add_row(
            name,
            *map(_in_degrees, driver.range),
            f"{len(driver.cosine)}",
            *(f"{np.degrees(angle):.2g}" for angle in left),
        )
    return table


def _in_degrees(angle: float) -> str:
    return f"{np.degrees(angle):.2f}"


def _is_one_sine(joint: Joint) -> bool:
    """Whether offset, amplitude and phase say all."""
    return joint.samples is None and joint.driver.is_one_sine


def _oscillations(title: str, kind: str, rows: dict[str, NaturalOscillation]) -> Table:
    table = table_of(
        f"{title}, by themselves without air",
        kind, "k, N m/rad", "C, N m s/rad", "I, kg m2", "swings at",
        numbers=(1, 2, 3, 4),
    )  # fmt: skip
    for name, free in rows.items():
        frequency = "-" if free.inertia == 0 else f"{free.frequency:.3g} Hz"
        table.add_row(
            name,
            f"{free.stiffness:.4g}",
            f"{free.damping:.4g}",
            f"{free.inertia:.3g}",
            frequency,
        )
    return table
