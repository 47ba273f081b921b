"""All about a limit cycle on one page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from birdmb.figures.loads import draw_loads, draw_wing_power
from birdmb.figures.multipliers import draw_labelled_multipliers
from birdmb.figures.page import is_narrow, new_figure, parts, title
from birdmb.figures.states import draw_states
from birdmb.figures.style import beat_label, title_of
from birdmb.figures.wing import OBLIQUE, draw_wing_phases
from birdmb.quantities import quantities

if TYPE_CHECKING:
    from birdmb.models import FlightCycle

_SHOWN = ("mean_speed", "mean_climb_rate", "power", "potential_power", "corrected_power", "period")


def plot_overview(cycle: FlightCycle) -> Figure:
    """Draw the wings at four phases, states, loads, power and multipliers on one page (16:9)."""
    states = len(cycle.model.motion_state_names)
    if is_narrow():
        heights = (3.6, 0.95 * states, 3.8, 4.2)
        figure = new_figure(3.5, sum(heights), rows=int(sum(heights)))
        top, left, middle, right = parts(figure, heights, heights)
    else:
        figure = new_figure(16, 9)
        figure.set_layout_engine("constrained", w_pad=0.1, h_pad=0.06)
        top, bottom = figure.subfigures(2, 1, squeeze=False, height_ratios=(1, 2.1))[:, 0]
        left, middle, right = parts(bottom, (1.4, 1, 0.95), (1, 1, 1))
    draw_wing_phases(top, cycle, (OBLIQUE,))
    draw_states(left, cycle)
    *loads, power = middle.subplots(4, 1, sharex=True)
    draw_loads(loads, cycle)
    draw_wing_power(power, cycle)
    power.set_xlabel(beat_label(cycle))
    middle.align_ylabels()
    circle, numbers = right.subplots(2, 1, height_ratios=(1.7, 1))
    draw_labelled_multipliers(circle, cycle)
    _write_numbers(numbers, cycle)
    title(
        top, f"{title_of(cycle)}: {_verdict(cycle)}", fontsize="medium" if is_narrow() else "large"
    )
    return figure


def _verdict(cycle: FlightCycle) -> str:
    """The verdict for a title; what speaks against calling this a flight comes first."""
    if cycle.why_no_flight is not None:
        return f"not a flight, {_stability(cycle)}"
    return _stability(cycle)


def _stability(cycle: FlightCycle) -> str:
    if cycle.failed_checks:
        return "undecided, for the program's own checks fail"
    fastest = (
        f"{cycle.doubling_times[0]:.2g} s ({cycle.doubling_times[0] / cycle.period:.2g} beats)"
    )
    if cycle.stability == "unstable":
        return f"unstable, disturbances double in {fastest}"
    if cycle.stability == "stable":
        return f"stable, disturbances halve in {fastest} or less"
    return "undecided, a multiplier is on the unit circle within its error"


def _write_numbers(axes: Axes, cycle: FlightCycle) -> None:
    rows = {
        each.label: f"{each.text(each.of(cycle))} {each.shown_unit}" for each in quantities(_SHOWN)
    }
    axes.set_axis_off()
    for i, (name, value) in enumerate(rows.items()):
        y = 1 - (i + 0.5) / len(rows)
        axes.text(0.12, y, name, va="center", transform=axes.transAxes)
        axes.text(
            0.95, y, value.replace("-", "−"), va="center", ha="right", transform=axes.transAxes
        )
