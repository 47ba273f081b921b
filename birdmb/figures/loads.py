"""Loads and power over a beat."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from birdmb._typing import FloatArray
from birdmb.figures.style import LINE, MEAN, beat_axis, label_beat, show_no_round_off, title_of
from birdmb.text import in_figure

if TYPE_CHECKING:
    from birdmb.models import FlightCycle

_LEVER = 0.1  # m, of the weight: a typical moment
_NOTHING = 1e-6  # of a typical size


def plot_loads_and_power(cycle: FlightCycle) -> Figure:
    """Draw thrust, lift and pitching moment, and the power of the wings and of the joints."""
    figure = Figure(figsize=(10, 6.2), layout="constrained")
    left, right = figure.subfigures(1, 2, squeeze=False, width_ratios=(1, 1.15))[0]
    loads = left.subplots(3, 1, sharex=True)
    draw_loads(loads, cycle)
    label_beat(loads[-1], cycle)
    top, bottom = right.subplots(2, 1, sharex=True, height_ratios=(1, 1.5))
    draw_wing_power(top, cycle)
    draw_joint_powers(bottom, cycle)
    label_beat(bottom, cycle)
    figure.suptitle(f"{title_of(cycle)}: loads and power over a beat", fontsize="medium")
    return figure


def draw_loads(rows: Sequence[Axes], cycle: FlightCycle) -> None:
    """Draw F_x, -F_z and M_y (body axes, about G) into three axes."""
    beat = cycle.beat
    curves: Mapping[str, FloatArray] = {
        "$F_x$ (N)": beat.force[:, 0],
        "lift $-F_z$ (N)": -beat.force[:, 2],
        "$M_y$ (N m)": beat.moment[:, 1],
    }
    model = cycle.model
    weight = model.mass * model.bird.gravity
    rows[1].axhline(weight, color="0.35", ls=":", lw=1.2, label=f"weight {weight:.3g} N")
    for axes, (name, values) in zip(rows, curves.items(), strict=True):
        beat_axis(axes, cycle)
        size = weight * _LEVER if "M_y" in name else weight
        _with_mean(axes, beat.times, values, name.partition("(")[2].rstrip(")"), size)
        axes.set_ylabel(name)


def draw_wing_power(axes: Axes, cycle: FlightCycle) -> None:
    """Draw the power that moving the wings against the air takes."""
    beat_axis(axes, cycle)
    model = cycle.model
    lifting = model.mass * model.bird.gravity * cycle.mean_speed
    _with_mean(axes, cycle.beat.times, cycle.beat.wing_power, "W", lifting)
    axes.set_ylabel("wing power (W)")


def draw_joint_powers(axes: Axes, cycle: FlightCycle) -> None:
    """Draw joint torque times joint rate, both wings together, with the means in the legend."""
    beat_axis(axes, cycle)
    colours = matplotlib.colormaps["tab10"].colors  # type: ignore[attr-defined]
    axes.axhline(0, color="0.7", lw=0.8)
    for i, (name, mean) in enumerate(cycle.joint_powers.items()):
        axes.plot(
            cycle.beat.times,
            cycle.beat.joint_power[:, i],
            color=colours[i % len(colours)],
            lw=1.3,
            label=f"{in_figure(name)}  {mean:+.2f} W".replace("-", "−"),
        )
    axes.set_ylabel("joint power (W)")
    axes.legend(
        frameon=False,
        fontsize="small",
        loc="upper center",
        bbox_to_anchor=(0.5, -0.18),
        ncols=2,
        title="mean over the beat",
        title_fontsize="small",
    )


def _with_mean(axes: Axes, times: FloatArray, values: FloatArray, unit: str, size: float) -> None:
    """Draw values (K,) of a typical size and their mean."""
    mean = float(values[:-1].mean())
    # A balance that holds to the orbit's residual.
    if abs(mean) < 1e-4 * max(float(np.ptp(values)), _NOTHING * size):
        mean = 0.0
    axes.axhline(0, color="0.7", lw=0.8)
    axes.plot(times, values, color=LINE)
    label = f"mean {mean:.3g} {unit}".replace("-", "−").strip()
    axes.axhline(mean, color=MEAN, ls="--", lw=1.2, label=label)
    show_no_round_off(axes, size)
    axes.legend(frameon=False, fontsize="small", loc="best", handlelength=1.8, borderaxespad=0.2)
