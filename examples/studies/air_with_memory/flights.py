"""The birds of the package in both kinds of air: in the plane, in space, and by discretisation."""

from collections.abc import Sequence
from functools import partial

import numpy as np
from matplotlib.figure import Figure
from partial_memory import WithoutLag
from report import MULTIBODY, RIGID, Report, in_both, largest

import birdmb
from birdmb._typing import FloatArray

Model = type[birdmb.RigidModel] | type[birdmb.MultibodyModel]

FLIGHTS: tuple[tuple[str, Model], ...] = (
    ("ibis", RIGID),
    ("ibis_compliant_shoulder", MULTIBODY),
    ("ibis_tail", RIGID),
    ("ibis_tail", MULTIBODY),
    ("pigeon", RIGID),
    ("pigeon", MULTIBODY),
    ("flapping_robot", MULTIBODY),
    ("gull_glider", RIGID),
    ("gull_glider", MULTIBODY),
)
IN_SPACE = ("ibis_tail", "pigeon")
REFINED = ("ibis", "ibis_tail", "gull_glider")
NUMBERS = ((16, 6), (32, 4), (32, 6), (32, 8), (64, 6), (64, 10))  # elements a wing, wake points
TOLD = ("air", "m/s", "climb", "W as if level", "|Λ|max", "±", "verdict", "α, deg")


def told(cycle: birdmb.FlightCycle) -> list[str]:
    """Speed, climb, power, largest multiplier, verdict and angle of attack."""
    angle = np.degrees(birdmb.assess_validity(cycle).largest_angle_of_attack)
    return [
        f"{cycle.mean_speed:.2f}", f"{cycle.mean_climb_rate:+.2f}", f"{cycle.corrected_power:.2f}",
        f"{largest(cycle.multipliers):.4f}", f"{cycle.verdict_errors[0]:.0e}",
        cycle.stability, f"{angle:.1f}",
    ]  # fmt: skip


def flights(report: Report) -> None:
    """All birds in the plane, with what memory consists of, and two in space."""
    rows, parts, labels, moduli = [], [], list[str](), list[list[float]]()
    for name, model in FLIGHTS[::4] if report.coarse else FLIGHTS:
        effect = in_both(report.bird(name), model)
        label = f"{name}, {model.__name__.removesuffix('Model').lower()}"
        if effect is None:
            rows.append([label, "no flight"])
            continue
        rows += [[label, "quasi-steady", *told(effect.quasi_steady)]]
        rows += [["", "unsteady", *told(effect.unsteady)]]
        values = [largest(effect.quasi_steady.multipliers), without_lag(effect)]
        values.append(largest(effect.unsteady.multipliers))
        steps = [f"{value:+.4f}" for value in np.diff(values)]
        parts.append([label, *(f"{value:.4f}" for value in values), *steps])
        labels.append(label)
        moduli.append(values)
    report.table("flights", "Flights without and with memory", ("flight", *TOLD), rows)
    columns = ("flight", "quasi-steady", "without lag", "unsteady", "at once", "by the lag")
    report.table("parts", "|Λ|max: what acts at once, and the lag", columns, parts)
    report.picture("flights", changes_picture(labels, np.array(moduli)))
    lateral(report)


def without_lag(effect: birdmb.MemoryEffect) -> float:
    """|Λ|max of the flight whose lags have settled at every instant; NaN if there is none."""
    cycle = effect.quasi_steady
    times = cycle.start_time + cycle.period * np.arange(64) / 64
    try:
        found = birdmb.find_limit_cycle(
            WithoutLag(effect.unsteady.model),
            cycle.trajectory(times).states,
            method="collocation",
            start_time=cycle.start_time,
        )
    except birdmb.BirdmbError:
        return np.nan
    return largest(found.multipliers)


def lateral(report: Report) -> None:
    """Lateral modes of flights in space."""
    rows = []
    for name in IN_SPACE[:1] if report.coarse else IN_SPACE:
        effect = in_both(report.bird(name), partial(RIGID, motion="free"))
        if effect is None:
            rows.append([name, "no flight"])
            continue
        for air, cycle in (("quasi-steady", effect.quasi_steady), ("unsteady", effect.unsteady)):
            # Roll may fade together with the wake, and be a mode of neither alone.
            slow, *_ = (
                abs(mode.multiplier)
                for mode in cycle.flight_modes
                if mode.plane == "lateral" and mode.multiplier.imag == 0.0
            )
            dutch, *_ = (
                abs(mode.multiplier) for mode in cycle.flight_modes if mode.name == "Dutch roll"
            )
            rows.append([name, air, f"{slow:.4f}", f"{dutch:.4f}", cycle.stability])
    columns = ("flight in space", "air", "spiral", "Dutch roll", "verdict")
    report.table("lateral", "Slow lateral modes, |Λ|", columns, rows)


def changes_picture(labels: Sequence[str], moduli: FloatArray) -> Figure:
    """What memory adds to |Λ|max of each flight: at once, and with the lag."""
    figure = Figure(figsize=(8, 4), layout="constrained")
    axes = figure.subplots()
    places = np.arange(len(labels))
    axes.plot(moduli[:, 1] - moduli[:, 0], places, "o", mfc="none", ms=8, label="without the lag")
    axes.plot(moduli[:, 2] - moduli[:, 0], places, "D", ms=5, label="all of it")
    axes.axvline(0.0, color="0.6", lw=0.8)
    named = zip(labels, moduli[:, 0], strict=True)
    axes.set_yticks(places, [f"{label} ({modulus:.3f})" for label, modulus in named])
    axes.invert_yaxis()
    axes.set_xlabel("what memory adds to |Λ|max (that of quasi-steady air in brackets)")
    axes.legend(frameon=False)
    return figure


def refinement(report: Report) -> None:
    """|Λ|max over the numbers of elements and of points with lags."""
    rows = []
    for name in REFINED[:1] if report.coarse else REFINED:
        for elements, points in ((6, 4), (6, 6)) if report.coarse else NUMBERS:
            bird = report.bird(name, wing__discretisation=elements, air__wake_points=points)
            effect = in_both(bird, RIGID)
            cells = ["no flight"]
            if effect is not None:
                pair = effect.quasi_steady, effect.unsteady
                cells = [f"{largest(cycle.multipliers):.5f}" for cycle in pair]
                cells.append(f"{effect.multiplier_change:+.5f}")
            rows.append([name, str(elements), str(points), *cells])
    columns = ("flight", "elements", "wake points", "quasi-steady", "unsteady", "change")
    report.table("refinement", "|Λ|max by the numbers of elements and points", columns, rows)
