"""All about a limit cycle on one page."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from birdmb.figures.loads import draw_loads, draw_wing_power
from birdmb.figures.multipliers import draw_labelled_multipliers
from birdmb.figures.page import is_narrow, label_x, new_figure, parts, title, wrapped
from birdmb.figures.states import draw_states
from birdmb.figures.style import beat_label, title_of
from birdmb.figures.wing import OBLIQUE, draw_wing_phases
from birdmb.quantities import quantities

if TYPE_CHECKING:
    from birdmb.models import FlightCycle

_SHOWN = ("mean_speed", "mean_climb_rate", "power", "potential_power", "corrected_power", "period")


def plot_overview(cycle: FlightCycle) -> Figure:
    """Draw the wings at four phases, states, loads, power and multipliers on one page (16:9)."""
    return _in_a_column(cycle) if is_narrow() else _on_a_screen(cycle)


def _on_a_screen(cycle: FlightCycle) -> Figure:
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
    _write_numbers(numbers, cycle, 1)
    title(top, f"{title_of(cycle)}: {_verdict(cycle)}", fontsize="large")
    return figure


def _in_a_column(cycle: FlightCycle) -> Figure:
    """As much below one another as a page is tall, for four states of the body and two joints."""
    heights = (2.2, 0.38 * len(cycle.model.motion_state_names), 1.95, 2.5, 0.6)
    figure = new_figure(3.5, sum(heights), rows=int(sum(heights)))
    wings, states, loads, circle, numbers = parts(figure, heights, heights)
    draw_wing_phases(wings, cycle, (OBLIQUE,))
    draw_states(states, cycle, dense=True)
    axes = loads.subplots(2, 2, sharex=True)
    draw_loads(axes.ravel()[:3], cycle, dense=True)
    draw_wing_power(axes[1, 1], cycle)
    for each in axes.ravel():
        each.set_ylabel(each.get_ylabel().replace(" ", "\n", 1))
    label_x(axes, wrapped(beat_label(cycle), 0.28))
    loads.align_ylabels()
    draw_labelled_multipliers(circle.subplots(), cycle)
    _write_numbers(numbers.subplots(), cycle, 2)
    title(wings, f"{title_of(cycle)}: {_verdict(cycle)}")
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


def _write_numbers(axes: Axes, cycle: FlightCycle, columns: int) -> None:
    shown = {
        each.label: f"{each.text(each.of(cycle))} {each.shown_unit}" for each in quantities(_SHOWN)
    }
    axes.set_axis_off()
    rows = -(-len(shown) // columns)
    for i, (name, value) in enumerate(shown.items()):
        column, row = divmod(i, rows)
        place: dict[str, Any] = {
            "y": 1 - (row + 0.5) / rows,
            "va": "center",
            "transform": axes.transAxes,
        }
        axes.text(x=(column + 0.12 / columns) / columns, s=name, **place)
        right = (column + 1 - 0.05) / columns
        axes.text(x=right, s=value.replace("-", "−"), ha="right", **place)
