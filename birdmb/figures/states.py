"""The states of a bird over a beat."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure, SubFigure

from birdmb._typing import FloatArray
from birdmb.figures.labels import state_symbol
from birdmb.figures.page import label_x, legend_below, new_figure, panels, title
from birdmb.figures.style import (
    DRIVER,
    LINE,
    beat_axis,
    beat_label,
    show_no_round_off,
    title_of,
)
from birdmb.quantities import IN_DEGREES
from birdmb.text import in_figure
from birdmb.topology.joints import split_side

if TYPE_CHECKING:
    from birdmb.models import FlightCycle

_RATE = ".rate"
# Angles beside their rates, u beside w.
_ORDER_OF_BODY = ("u", "w", "theta", "q")


def plot_states(cycle: FlightCycle) -> Figure:
    """Draw the states over a beat, angles in degrees; compliant joints with their drivers.

    Those of the air's memory are left out.
    """
    rows = len(cycle.model.motion_state_names) // 2
    figure = new_figure(8.5, 0.7 + 1.75 * rows, rows=rows, columns=2)
    draw_states(figure, cycle)
    title(figure, f"{title_of(cycle)}: states over a beat")
    return figure


def draw_states(figure: Figure | SubFigure, cycle: FlightCycle, *, dense: bool = False) -> None:
    """Draw the states into a figure, in two columns.

    Args:
        figure: to draw into.
        cycle: of the bird.
        dense: keep the two columns on narrow paper, too; what the shade means is said elsewhere.
    """
    units = cycle.model.state_units
    moving = cycle.model.motion_state_names
    names = [*_ORDER_OF_BODY, *(name for name in moving if name not in _ORDER_OF_BODY)]
    shape = len(names) // 2, 2
    axes = figure.subplots(*shape, sharex=True) if dense else panels(figure, *shape, sharex=True)
    driven = False
    for name, ax in zip(names, axes.ravel(), strict=True):
        at = cycle.state_names.index(name)
        unit = units[at]
        scale = np.degrees(1.0) if unit in IN_DEGREES else 1.0
        beat_axis(ax, cycle)
        driver = _driver(cycle, name)
        if driver is not None:
            ax.plot(cycle.beat.times, scale * driver, "--", color=DRIVER, lw=1.2, label="driver")
        ax.plot(cycle.beat.times, scale * cycle.beat.states[:, at], color=LINE, label="state")
        show_no_round_off(ax, scale * float(cycle.model.state_scale[at]))
        label = _label(name)
        between = "\n" if dense and "\n" in label else " "
        ax.set_ylabel(f"{label}{between}({IN_DEGREES.get(unit, unit)})")
        driven = driven or driver is not None
    label_x(axes, "time (s)" if dense else beat_label(cycle))
    if driven:
        legend_below(figure)
    figure.align_ylabels()


def _label(name: str) -> str:
    """Name of a state; the place and the motion of a joint on lines of their own."""
    if not name.endswith(_RATE):
        return state_symbol(name).replace(".", "\n")
    joint, side = split_side(name.removesuffix(_RATE))
    place, _, motion = joint.partition(".")
    lines = [place, f"{motion} rate", side]
    return "\n".join(in_figure(line) for line in lines if line)


def _driver(cycle: FlightCycle, state: str) -> FloatArray | None:
    """Angle or rate (K,) that a compliant joint's driver has, `None` for states without one."""
    model = cycle.model
    joint, side = split_side(state.removesuffix(_RATE))
    if joint not in model.bird.joint_names:
        return None
    angles, rates, _ = model.drivers_of_both(cycle.beat.times)
    drivers = rates if state.endswith(_RATE) else angles
    return drivers[:, 1 if side == "left" else 0, model.bird.joint_names.index(joint)]
