"""Loads and power over a beat."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from birdmb._typing import FloatArray
from birdmb.figures.labels import in_words
from birdmb.figures.page import legend_below, new_figure, parts, title
from birdmb.figures.style import (
    LEVEL,
    LINE,
    MEAN,
    SERIES,
    beat_axis,
    beat_label,
    show_no_round_off,
    title_of,
)

if TYPE_CHECKING:
    from birdmb.models import FlightCycle

_LEVER = 0.1  # m, of the weight: a typical moment
_NOTHING = 1e-6  # of a typical size
_NOTE: dict[str, Any] = {"fontsize": "small", "pad": 2}


def plot_loads_and_power(cycle: FlightCycle) -> Figure:
    """Draw thrust, lift and pitching moment, and the power of the wings and of the joints."""
    figure = new_figure(10, 6.2, rows=3, columns=2)
    left, right = parts(figure, (1, 1.15), (1, 1.1))
    loads = left.subplots(3, 1, sharex=True)
    draw_loads(loads, cycle)
    loads[-1].set_xlabel(beat_label(cycle))
    top, bottom = right.subplots(2, 1, sharex=True, height_ratios=(1, 1.5))
    draw_wing_power(top, cycle)
    draw_joint_powers(bottom, cycle)
    legend_below(right, most=2, about="mean over the beat")
    bottom.set_xlabel(beat_label(cycle))
    title(figure, f"{title_of(cycle)}: loads and power over a beat")
    return figure


def draw_loads(rows: Sequence[Axes], cycle: FlightCycle, *, dense: bool = False) -> None:
    """Draw F_x, -F_z and M_y (body axes, about G) into three axes, `dense` ones half as wide."""
    beat = cycle.beat
    curves: Mapping[str, FloatArray] = {
        "$F_x$ (N)": beat.force[:, 0],
        "lift $-F_z$ (N)": -beat.force[:, 2],
        "$M_y$ (N m)": beat.moment[:, 1],
    }
    model = cycle.model
    weight = model.mass * model.bird.gravity
    rows[1].axhline(weight, color="0.35", ls=":", lw=1.2)
    for axes, (name, values) in zip(rows, curves.items(), strict=True):
        beat_axis(axes, cycle)
        size = weight * _LEVER if "M_y" in name else weight
        _with_mean(axes, beat.times, values, name.partition("(")[2].rstrip(")"), size)
        axes.set_ylabel(name)
    about_weight = f"weight (dotted) {weight:.3g} N"
    if dense:  # no room beside the mean: a line above it
        about_weight += "\n "
    rows[1].set_title(about_weight, loc="left", **_NOTE)


def draw_wing_power(axes: Axes, cycle: FlightCycle) -> None:
    """Draw the power that moving the wings against the air takes."""
    beat_axis(axes, cycle)
    model = cycle.model
    lifting = model.mass * model.bird.gravity * cycle.mean_speed
    _with_mean(axes, cycle.beat.times, cycle.beat.wing_power, "W", lifting)
    axes.set_ylabel("wing power (W)")


def draw_joint_powers(axes: Axes, cycle: FlightCycle) -> None:
    """Draw joint torque times joint rate, both wings together, with the means as labels."""
    beat_axis(axes, cycle)
    axes.set_prop_cycle(SERIES)
    axes.axhline(0, **LEVEL)
    for i, (name, mean) in enumerate(cycle.joint_powers.items()):
        axes.plot(
            cycle.beat.times,
            cycle.beat.joint_power[:, i],
            lw=1.3,
            label=f"{in_words(name)}  {mean:+.2f} W".replace("-", "−"),
        )
    axes.set_ylabel("joint power (W)")


def _with_mean(axes: Axes, times: FloatArray, values: FloatArray, unit: str, size: float) -> None:
    """Draw values (K,) of a typical size and their mean."""
    mean = float(values[:-1].mean())
    # A balance that holds to the orbit's residual.
    if abs(mean) < 1e-4 * max(float(np.ptp(values)), _NOTHING * size):
        mean = 0.0
    axes.axhline(0, **LEVEL)
    axes.plot(times, values, color=LINE)
    axes.axhline(mean, color=MEAN, ls="--", lw=1.2)
    axes.set_title(f"mean {mean:.3g} {unit}".replace("-", "−"), loc="right", color=MEAN, **_NOTE)
    show_no_round_off(axes, size)
