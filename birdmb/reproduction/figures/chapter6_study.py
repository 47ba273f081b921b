"""Figures and tables of chapter 6: the study of gait and tail, and what its tail rests on."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from birdmb._typing import FloatArray
from birdmb.errors import BirdmbError
from birdmb.figures import plot_manifold, plot_pareto
from birdmb.figures.labels import LARGEST_MODULUS
from birdmb.figures.page import legend_below, new_figure, panels
from birdmb.figures.style import LEVEL, families
from birdmb.models import RigidModel
from birdmb.reproduction.chapter6_flights import (
    SHIPPED,
    TABLE_6_2,
    Values,
    stable_opening,
    with_gait,
)
from birdmb.reproduction.figures.drawing import Drawing, keep_figure, keep_table
from birdmb.reproduction.program_tail import ProgramTail
from birdmb.reproduction.quantities import PUBLISHED_WING, ROLL_OFFSET
from birdmb.reproduction.tail_study import RULES, TRIM, VALID_RULES, chapter_6_study
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.tail import OPENING, pareto_front, within_limits
from birdmb.studies.tail_price import least_costs, price_of_stability
from birdmb.studies.trim import trim_flight

_FRONTS = (0.0, 15.0, 30.0, 45.0)  # degrees of opening
_COARSE, _SPEED_STEP = 15, 0.1
Style = Mapping[str, Any]
"""Of a line."""
_ALONG: Values = {"tail.incidence_deg": 0.0}
_NO_DOWNWASH: Values = {**_ALONG, "tail.downwash": "none"}
_SHORT: Values = {"tail.chord": 0.25}
_CORRECTIONS: Mapping[str, tuple[Values, ModelFactory]] = {
    "as shipped": (SHIPPED, RigidModel),
    "chord 0.25 m": (_SHORT, RigidModel),
    "along the body": (_ALONG, RigidModel),
    "along the body; bound vortices too": (
        {**_ALONG, "tail.downwash": "wake and bound"},
        RigidModel,
    ),
    "along the body; no downwash": (_NO_DOWNWASH, RigidModel),
    "along the body; chord 0.25 m": ({**_ALONG, **_SHORT}, RigidModel),
    "along the body; pitch rate of the wrong sign": (
        _ALONG,
        partial(ProgramTail, wrong_wake=False),
    ),
    "along the body; three vortices and the bound ones": (
        _ALONG,
        partial(ProgramTail, wrong_rate=False),
    ),
    "both: the program's tail": (_ALONG, ProgramTail),
    "and its lifting line": ({**_ALONG, **PUBLISHED_WING}, ProgramTail),
}
_SWEEPS, _AMPLITUDES = (-14.5, -13.0, -12.0, -11.0), (32.0, 36.0, 40.0, 42.0)


def _figure_6_5(out: Path, coarse: bool) -> None:
    """Study, its pictures and what stability costs; the store stays, and is filled up later."""
    study = chapter_6_study(
        out / f"chapter_6_study{'_coarse' if coarse else ''}.db", every=_COARSE if coarse else 1
    )
    data = study.to_xarray()
    figure = new_figure(12, 5, columns=2)
    by_speed, by_modulus = panels(figure, 1, 2)[0]
    openings = data[OPENING].values
    chosen = [float(openings[np.abs(openings - wanted).argmin()]) for wanted in _FRONTS]
    for opening, style in zip(chosen, families(len(chosen)), strict=True):
        at = data.sel({OPENING: opening})
        kept = at.where(within_limits(at, RULES))
        cost = kept["cost_of_transport"].values.ravel()
        label = f"{opening:g}°"
        _least(by_speed, data, opening, style, label)
        _front(by_modulus, kept["largest_modulus"].values.ravel(), cost, style, label)
    by_speed.set(xlabel="speed of level flight (m/s)", ylabel="cost of transport", title="(a)")
    by_modulus.axvline(1.0, **LEVEL)
    by_modulus.set(xlabel=LARGEST_MODULUS, ylabel="cost of transport", title="(b)")
    for axes in (by_speed, by_modulus):
        axes.spines[["top", "right"]].set_visible(False)
    legend_below(figure, about="tail opening", most=4)
    keep_figure(out, "figure 6.5", figure)
    keep_figure(out, "figure 6.5 pareto", plot_pareto(data, RULES))
    keep_figure(out, "figure 6.5 manifold", plot_manifold(data, RULES))
    keep_table(out, "figure 6.5 price of stability", *_price(data))


def _least(axes: Axes, data: xr.Dataset, opening: float, style: Style, label: str) -> None:
    """The flights with the tail at an opening, and the least cost at each speed among them."""
    at = data.sel({OPENING: [opening]})
    kept = at.where(within_limits(at, RULES))
    speed = kept["mean_speed"].values.ravel()
    axes.plot(
        speed,
        kept["cost_of_transport"].values.ravel(),
        ".",
        color=style["color"],
        ms=2.5,
        alpha=0.3,
    )
    if np.isfinite(speed).any():
        speeds = np.arange(np.nanmin(speed), np.nanmax(speed), _SPEED_STEP)
        axes.plot(speeds, least_costs(at, speeds.tolist(), limits=RULES), label=label, **style)


def _front(axes: Axes, modulus: FloatArray, cost: FloatArray, style: Style, label: str) -> None:
    """The flights, and those that no other of this opening beats in both."""
    axes.plot(modulus, cost, ".", color=style["color"], ms=2.5, alpha=0.3)
    front = pareto_front(cost, modulus)
    axes.plot(modulus[front], cost[front], marker="o", ms=3, lw=1.6, label=label, **style)


def _price(data: xr.Dataset) -> tuple[list[str], list[list[object]]]:
    columns = ["speed m/s"]
    rules = {"within the rules": RULES, "and with the tail valid": VALID_RULES}
    for about in rules:
        columns += [
            f"{what} {about}"
            for what in ("least cost", "least cost if stable", "more %", "tail opening deg")
        ]
    prices = [
        {row.speed: row for row in price_of_stability(data, limits=limits)}
        for limits in rules.values()
    ]
    rows: list[list[object]] = []
    for speed in sorted(set().union(*prices)):
        line: list[object] = [speed]
        for by_speed in prices:
            row = by_speed.get(speed)
            line += (
                [np.nan] * 4
                if row is None
                else [row.cheapest, row.cheapest_stable, 100.0 * row.price, row.opening]
            )
        rows.append(line)
    return columns, rows


def _corrections(out: Path, coarse: bool) -> None:
    columns = (
        "tail", "roll offset deg", "speed m/s", "|multiplier|", "power W",
        "smallest tail angle deg", "largest tail angle deg", "stable from deg",
    )  # fmt: skip
    rows: list[list[object]] = []
    elements: Values = {"wing.discretisation": 8} if coarse else {}
    cases = dict(list(_CORRECTIONS.items())[:2]) if coarse else _CORRECTIONS
    for about, (values, model) in cases.items():
        one = with_gait(*TABLE_6_2["b"][0], {**elements, **values})
        trim = trim_flight(one, TRIM, model=model)
        cycle = trim.cycle
        angles = np.degrees(cycle.beat.tail_angle)
        rows.append(
            [
                about, trim.values[ROLL_OFFSET], cycle.mean_speed,
                float(np.abs(cycle.multipliers).max()), cycle.power,
                float(angles.min()), float(angles.max()), stable_opening(one, model),
            ]
        )  # fmt: skip
    keep_table(out, "table 6.corrections", columns, rows)


def _openings(out: Path, coarse: bool) -> None:
    elements: Values = {"wing.discretisation": 8} if coarse else {}
    sweeps, amplitudes = (_SWEEPS[:1], _AMPLITUDES[:2]) if coarse else (_SWEEPS, _AMPLITUDES)
    rows: list[list[object]] = []
    for sweep in sweeps:
        row: list[object] = [sweep]
        for amplitude in amplitudes:
            try:
                row.append(stable_opening(with_gait(0.0, sweep, amplitude, elements)))
            except BirdmbError:  # level flight ends before it becomes stable
                row.append(np.nan)
        rows.append(row)
    columns = ["sweep offset deg", *(f"amplitude {a:g} deg" for a in amplitudes)]
    keep_table(out, "table 6.openings", columns, rows)


DRAWINGS: Mapping[str, Drawing] = {
    "figure 6.5": Drawing(
        "least cost at each speed (a), fronts of cost and stability (b), the study behind them",
        _figure_6_5,
    ),
    "table 6.openings": Drawing(
        "opening from which level flight is stable, over gaits (no number in the thesis)", _openings
    ),
    "table 6.corrections": Drawing(
        "what each correction of the program's tail changes (no number in the thesis)", _corrections
    ),
}
