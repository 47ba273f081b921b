"""Figures and tables of chapter 6: three flights, their moments and costs, and gusts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from birdmb.figures.labels import state_symbol
from birdmb.figures.page import is_narrow, label_y, legend_below, new_figure, panels, title
from birdmb.figures.style import BLUE, LEVEL, ORANGE, SKY, VERMILION
from birdmb.models import FlightCycle, GaussianGust
from birdmb.quantities import DISSIPATORS
from birdmb.reproduction.chapter6_flights import (
    AS_PUBLISHED,
    SHIPPED,
    TABLE_6_2,
    Values,
    flight_of_table_6_2,
    tail_moment,
)
from birdmb.reproduction.figures import chapter6_study
from birdmb.reproduction.figures.drawing import Drawing, keep_figure, keep_table
from birdmb.reproduction.quantities import ROLL_OFFSET
from birdmb.studies.body_gust import GustAxes
from birdmb.studies.gust import gust_response

_SETUPS: Mapping[str, Values] = {
    "published wing, no downwash": AS_PUBLISHED,
    "as shipped": SHIPPED,
}
_GUSTS = {"a": (0.1, 24), "b": (1.0, 48), "c": (1.0, 48)}
"""Upward gusts (m/s), and for how many beats they are followed."""
_COARSE_BEATS = 6
_DIRECTIONS: tuple[tuple[GustAxes, str, str], ...] = (
    ("body", "gust along the body's z axis", BLUE),
    ("world", "gust along the vertical", VERMILION),
)
_IN_DEGREES = {"q", "theta"}
_UNITS = {"u": "m/s", "w": "m/s", "q": "°/s", "theta": "°"}


def _flights(coarse: bool) -> Iterator[tuple[str, str, FlightCycle, float]]:
    """Row of table 6.2, setup, cycle and roll offset (degrees)."""
    elements: Values = {"wing.discretisation": 8} if coarse else {}
    for about, values in _SETUPS.items():
        for row in TABLE_6_2:
            # The published wing is as coarse as it is.
            trim = flight_of_table_6_2(row, {**elements, **values})
            yield row, about, trim.cycle, trim.values[ROLL_OFFSET]


def _table_6_2(out: Path, coarse: bool) -> None:
    columns = (
        "case", "wing and tail", "opening deg", "sweep offset deg", "flap amplitude deg",
        "roll offset deg", "printed", "speed m/s", "printed", "|multiplier|", "printed",
        "power W", "printed", "mean moment of the tail N m",
        "smallest tail angle deg", "largest tail angle deg", "mean pitch deg",
    )  # fmt: skip
    rows = []
    for row, about, cycle, roll in _flights(coarse):
        gait, (printed_roll, modulus, power) = TABLE_6_2[row]
        angles = np.degrees(cycle.beat.tail_angle)
        rows.append(
            [
                row, about, *gait, roll, printed_roll, cycle.mean_speed, 14.0,
                float(np.abs(cycle.multipliers).max()), modulus, cycle.power, power,
                float(tail_moment(cycle)[:-1].mean()),
                float(angles.min()), float(angles.max()), float(np.degrees(cycle.mean_pitch)),
            ]
        )  # fmt: skip
    keep_table(out, "table 6.2", columns, rows)


def _figure_6_3(out: Path, coarse: bool) -> None:
    wide = len(TABLE_6_2) + 1
    figure = new_figure(14, 6.5, rows=2, columns=wide)
    grid = panels(figure, 2, wide, width_ratios=(*[1] * len(TABLE_6_2), 0.9))
    for row, about, cycle, _ in _flights(coarse):
        axes = grid[list(_SETUPS).index(about), list(TABLE_6_2).index(row)]
        means = _moments(axes, cycle)
        between, size = ("; ", "small") if is_narrow() else ("\n", "medium")
        title(axes, f"({row}) {about}{between}means {means}", fontsize=size)
        _cost(grid[list(_SETUPS).index(about), -1], row, cycle)
    label_y(grid[:, :-1], "moment (N m)")
    for axes in grid[:, :-1].ravel():
        axes.set_xlabel("time (beats)")
        axes.sharey(grid[0, 0])
    for axes in grid[:, -1]:
        axes.set_xlabel("flight")
        axes.set_ylabel("power (W)")
        axes.spines[["top", "right"]].set_visible(False)
        axes.set_ylim(0.0, 29.0)
        title(axes, "cost of transport, and its parts")
    legend_below(figure, most=7)
    keep_figure(out, "figure 6.3", figure)


def _moments(axes: Axes, cycle: FlightCycle) -> str:
    """Draw the moments of wing and tail, each with its mean; these as text."""
    beat, tail = cycle.beat, tail_moment(cycle)
    phase = beat.times / cycle.period
    wing = beat.moment[:, 1] - tail - beat.loads_along.stack.body_moment[:, 1]
    means = []
    for values, label, colour, dashes in (
        (wing, "wing", BLUE, "-"),
        (tail, "tail", VERMILION, "-."),
    ):
        mean = round(float(values[:-1].mean()), 3)
        means.append(f"{mean + 0.0:+.3f}".replace("-", "−"))
        axes.plot(phase, values, color=colour, ls=dashes, label=f"moment of the {label}")
        axes.axhline(mean, color=colour, ls=(0, (1, 1)), lw=0.8)
    axes.axhline(0.0, **LEVEL)
    axes.set_xlim(0.0, 1.0)
    axes.spines[["top", "right"]].set_visible(False)
    return ", ".join(means)


def _cost(axes: Axes, row: str, cycle: FlightCycle) -> None:
    """A bar of what the wings' power goes to, the cost of transport above it."""
    below = 0.0
    for name, colour in zip(DISSIPATORS, (BLUE, SKY, ORANGE, "0.6"), strict=True):
        power = cycle.dissipation[name]
        axes.bar(f"({row})", power, bottom=below, color=colour, label=name, width=0.6)
        below += power
    printed = TABLE_6_2[row][1][2]
    axes.plot(f"({row})", printed, "k_", ms=18, mew=1.5, label="printed power")
    axes.annotate(
        f"{cycle.cost_of_transport:.4f}", (f"({row})", max(below, printed)), (0, 2),
        textcoords="offset points", ha="center", fontsize="small",
    )  # fmt: skip


def _figure_6_4(out: Path, coarse: bool) -> None:
    figure = new_figure(14, 9, rows=len(_UNITS), columns=len(_GUSTS))
    grid = panels(figure, len(_UNITS), len(_GUSTS))
    values: Values = {"wing.discretisation": 8} if coarse else {}
    for column, (row, (strength, beats)) in zip(grid.T, _GUSTS.items(), strict=True):
        cycle = flight_of_table_6_2(row, values).cycle
        followed = min(beats, _COARSE_BEATS) if coarse else beats
        gust = GaussianGust(vertical=strength)
        for along, label, colour in _DIRECTIONS:
            flight = gust_response(cycle, gust, axes=along, periods=followed)
            _states(column, flight, label, colour)
        for axes in column if is_narrow() else column[:1]:
            title(axes, f"({row}), gust of {strength:g} m/s", pad=2 if is_narrow() else None)
    for axes in grid.ravel() if is_narrow() else grid[-1]:  # each flight has a time of its own
        axes.set_xlabel("time (s)")
    legend_below(figure)
    for row_of_axes, name in zip(grid, _UNITS, strict=True):
        label_y(row_of_axes, f"{state_symbol(name)} ({_UNITS[name]})")
    keep_figure(out, "figure 6.4", figure)


def _states(column: np.ndarray, flight: xr.Dataset, label: str, colour: str) -> None:
    time = flight["time"].values
    for axes, name in zip(column, _UNITS, strict=True):
        scale = np.degrees(1.0) if name in _IN_DEGREES else 1.0
        if not axes.lines:
            orbit = scale * flight["orbit"].sel(state=name)
            axes.plot(time, orbit, color="0.7", lw=2, label="limit cycle")
        style = "-" if flight.attrs["axes"] == "body" else "--"
        states = scale * flight["states"].sel(state=name)
        axes.plot(time, states, style, color=colour, lw=0.9, label=label)
        axes.set_xlim(0.0, time[-1])
        axes.spines[["top", "right"]].set_visible(False)


DRAWINGS: Mapping[str, Drawing] = {
    "table 6.2": Drawing("three level flights: tail furled (a) and spread (b, c)", _table_6_2),
    "figure 6.3": Drawing("pitching moments of wing and tail, and what power goes to", _figure_6_3),
    "figure 6.4": Drawing("the three flights through an upward gust", _figure_6_4),
    **chapter6_study.DRAWINGS,
}
