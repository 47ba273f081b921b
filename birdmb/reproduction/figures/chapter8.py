"""Figures and tables of chapter 8: what the spring of the shoulder does to the limit cycle."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.patches import Circle

from birdmb.errors import BirdmbError
from birdmb.figures.labels import IMAGINARY, LARGEST_MODULUS, REAL, in_words, state_symbol
from birdmb.figures.page import is_narrow, label_x, legend_below, new_figure, panels, title
from birdmb.figures.style import BLUE, VERMILION, families
from birdmb.models import FlightCycle
from birdmb.reproduction.chapter8_birds import (
    TABLE_8_1,
    light_and_flap_first,
    readings,
    sprung_flight,
)
from birdmb.reproduction.figures import chapter8_gust, chapter8_inertia
from birdmb.reproduction.figures.drawing import Drawing, keep_figure, keep_table
from birdmb.reproduction.quantities import bird, reference_cycle
from birdmb.topology import Bird

Spring = tuple[float, float]
"""Stiffness (N m/rad) and damping (N m s/rad)."""

_BIRDS: Mapping[str, Callable[[], Bird]] = {
    "0.002 kg m² a segment": partial(bird, "ibis_thesis_ch8"),
    "slender bones, flap before pitch": light_and_flap_first,
}
_STIFFNESSES: Sequence[Spring] = ((20.0, 0.2), (15.0, 0.2), (10.0, 0.2))
_DAMPINGS: Sequence[Spring] = ((20.0, 0.2), (20.0, 0.1), (20.0, 0.0))
_STATES = {"u": "m/s", "w": "m/s", "q": "°/s", "theta": "°", "shoulder.flap": "°"}


def _resolved(one: Bird, coarse: bool) -> Bird:
    return one.with_values({"wing.discretisation": 8}) if coarse else one


def _flights(one: Bird, springs: Sequence[Spring]) -> Iterator[tuple[Spring, FlightCycle]]:
    """Limit cycles, each found from the one before; those that are not found are left out."""
    guess = None
    for spring in springs:
        try:
            cycle = sprung_flight(one, *spring, guess)
        except BirdmbError:
            continue
        guess = cycle.x0
        yield spring, cycle


def _overlay(springs: Sequence[Spring], name: str, out: Path, coarse: bool) -> None:
    """Draw the states over a beat for some springs, with the flap's driver."""
    figure = new_figure(3.2 * len(_STATES), 6.0, rows=len(_BIRDS), columns=len(_STATES))
    rows = panels(figure, len(_BIRDS), len(_STATES), sharex=True)
    styles = families(len(springs))
    for row, (about, make) in zip(rows, _BIRDS.items(), strict=True):
        one = _resolved(make(), coarse)
        for spring, cycle in _flights(one, springs):
            style = styles[list(springs).index(spring)]
            for axes, state in zip(row, _STATES, strict=True):
                _state(axes, cycle, state, style, _named(spring))
        title(row[0], about, loc="left")
        row[-1].plot(*_driver(one), color=VERMILION, ls=(0, (10, 3)), lw=1, label="driver")
        for axes, state in zip(row, _STATES, strict=True):
            words = in_words(state_symbol(state)).replace(" ", "\n" if is_narrow() else " ")
            axes.set_ylabel(f"{words} ({_STATES[state]})")
            axes.spines[["top", "right"]].set_visible(False)
    rows[0, 0].set_xlim(0.0, 1.0)
    label_x(rows, "time (beats)")
    figure.align_ylabels(rows)
    legend_below(figure, about="k in N m/rad, C in N m s/rad", most=4)
    keep_figure(out, name, figure)


def _state(axes: Axes, cycle: FlightCycle, state: str, style: dict[str, Any], label: str) -> None:
    scale = 1.0 if _STATES[state] == "m/s" else np.degrees(1.0)
    values = cycle.beat.states[:, cycle.state_names.index(state)]
    shown = label if state == next(iter(_STATES)) else None
    axes.plot(cycle.beat.times / cycle.period, scale * values, label=shown, **style)


def _driver(one: Bird) -> tuple[np.ndarray, np.ndarray]:
    """Phase and angle (degrees) of the flap's driver."""
    joint = one.joint("shoulder.flap")
    phase = np.linspace(0.0, 1.0, 101)
    angle = joint.offset + joint.amplitude * np.sin(2.0 * np.pi * phase + joint.phase)
    return phase, np.degrees(angle)


def _named(spring: Spring) -> str:
    return f"k = {spring[0]:g}, C = {spring[1]:g}"


def _locus(springs: Sequence[Spring], label: str, name: str, out: Path, coarse: bool) -> None:
    """Draw the multipliers in the plane and the largest modulus over k or C."""
    chosen = springs[:: max(1, len(springs) // 3)] if coarse else springs
    which = 0 if label.startswith("k") else 1
    figure = new_figure(14, 3.8 if is_narrow() else 5, columns=len(_BIRDS) + 1)
    planes = panels(figure, 1, len(_BIRDS) + 1)[0]
    colours = matplotlib.colormaps["viridis"]
    values = [spring[which] for spring in springs]
    norm = (LogNorm if min(values) > 0.0 else Normalize)(min(values), max(values))
    for axes, marker, (about, make) in zip(planes, "os", _BIRDS.items(), strict=False):
        axes.add_patch(Circle((0.0, 0.0), 1.0, fill=False, color="0.7"))
        flown = list(_flights(_resolved(make(), coarse), chosen))
        for spring, cycle in flown:
            colour = colours(norm(spring[which]))
            axes.plot(cycle.multipliers.real, cycle.multipliers.imag, ".", color=colour, ms=7)
        axes.set(xlabel=REAL, ylabel=IMAGINARY, aspect="equal", xlim=(-1.1, 1.7), ylim=(-1.1, 1.1))
        title(axes, about)
        largest = [float(np.abs(cycle.multipliers).max()) for _, cycle in flown]
        over = [spring[which] for spring, _ in flown]
        dashes = {"o": "-", "s": "--"}[marker]
        shade = {"o": BLUE, "s": VERMILION}[marker]
        planes[-1].plot(over, largest, marker=marker, ls=dashes, color=shade, ms=4, label=about)
    printed = {
        spring[which]: row[0]
        for spring, row in TABLE_8_1.items()
        if spring[1 - which] == _FIXED[which]
    }
    planes[-1].plot(*zip(*printed.items(), strict=True), "k*", ms=9, label="printed")
    planes[-1].set(xlabel=label, ylabel=LARGEST_MODULUS)
    legend_below(figure)
    for axes in planes:
        axes.spines[["top", "right"]].set_visible(False)
    bar = figure.colorbar(
        ScalarMappable(norm, colours), ax=planes[:-1].tolist(), label=label, shrink=0.8,
        format="{x:g}", location="bottom" if is_narrow() else "right",
    )  # fmt: skip
    if isinstance(norm, LogNorm):
        bar.set_ticks([10.0, 20.0, 40.0, 80.0])
        bar.minorticks_off()
    keep_figure(out, name, figure)


_FIXED = (0.2, 20.0)  # C while k varies, and k while C varies
_OVER_STIFFNESS = [(float(k), _FIXED[0]) for k in np.geomspace(80.0, 8.0, 14)]
_OVER_DAMPING = [(_FIXED[1], float(c)) for c in np.linspace(0.4, 0.0, 9)]


def _table_8_1(out: Path, coarse: bool) -> None:
    columns = (
        "k N m/rad", "C N m s/rad", "reading", "|multiplier|", "printed", "P_act W", "printed",
        "P_g W", "printed", "speed m/s", "climb rate m/s",
    )  # fmt: skip
    rows: list[list[object]] = []
    for about, make in _BIRDS.items():
        for (k, c), cycle in _flights(_resolved(make(), coarse), list(TABLE_8_1)):
            largest, active, potential = TABLE_8_1[k, c]
            rows.append(
                [
                    k, c, about, float(np.abs(cycle.multipliers).max()), largest,
                    cycle.power, active, cycle.potential_power, potential,
                    cycle.mean_speed, cycle.mean_climb_rate,
                ]
            )  # fmt: skip
    rigid = reference_cycle(shoulder__flap__amplitude_deg=43.47)
    rows.append(
        [
            "infinity", "", "flap amplitude 43.47 deg; sweep offset -19 deg; published wing",
            float(np.abs(rigid.multipliers).max()), "", rigid.power, 6.58,
            rigid.potential_power, "", rigid.mean_speed, rigid.mean_climb_rate,
        ]
    )  # fmt: skip
    keep_table(out, "table 8.1", columns, rows)


def _readings(out: Path, coarse: bool) -> None:
    columns = (
        "reading", "k N m/rad", "C N m s/rad", "|multiplier|", "printed", "P_act W", "printed",
        "P_g W", "printed", "speed m/s", "lowest flap deg", "highest flap deg",
    )  # fmt: skip
    rows: list[list[object]] = []
    for about, one in list(readings().items())[: 1 if coarse else None]:
        found = dict(_flights(_resolved(one, coarse), list(TABLE_8_1)))
        for spring, (largest, active, potential) in TABLE_8_1.items():
            cycle = found.get(spring)
            if cycle is None:
                rows.append([about, *spring, "no cycle found", largest])
                continue
            flap = np.degrees(cycle.beat.states[:, cycle.state_names.index("shoulder.flap")])
            rows.append(
                [
                    about, *spring, float(np.abs(cycle.multipliers).max()), largest,
                    cycle.power, active, cycle.potential_power, potential, cycle.mean_speed,
                    float(flap.min()), float(flap.max()),
                ]
            )  # fmt: skip
    keep_table(out, "table 8.readings", columns, rows)


DRAWINGS: Mapping[str, Drawing] = {
    "table 8.1": Drawing("largest multiplier and powers over k and C", _table_8_1),
    "table 8.readings": Drawing(
        "table 8.1 under eleven readings of the text (no number in the thesis)", _readings
    ),
    "figure 8.3": Drawing(
        "limit cycles over the stiffness", partial(_overlay, _STIFFNESSES, "figure 8.3")
    ),
    "figure 8.4": Drawing(
        "multipliers over the stiffness",
        partial(_locus, _OVER_STIFFNESS, "k (N m/rad)", "figure 8.4"),
    ),
    "figure 8.5": Drawing(
        "limit cycles over the damping", partial(_overlay, _DAMPINGS, "figure 8.5")
    ),
    "figure 8.6": Drawing(
        "multipliers over the damping",
        partial(_locus, _OVER_DAMPING, "C (N m s/rad)", "figure 8.6"),
    ),
    **chapter8_gust.DRAWINGS,
    **chapter8_inertia.DRAWINGS,
}
