"""Any orbit, and what follows a disturbance of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from birdmb.figures.multipliers import draw_multipliers
from birdmb.figures.page import legend_below, new_figure, panels, parts
from birdmb.figures.style import DRIVER, LINE
from birdmb.orbits.problem import HasStateUnits
from birdmb.text import in_figure

if TYPE_CHECKING:
    from birdmb.orbits import FloquetResult, PerturbedResponse


def plot_orbit(orbit: FloquetResult) -> Figure:
    """Draw the states over time on the left, the multipliers in the unit circle on the right."""
    path, n = orbit.trajectory(), len(orbit.state_names)
    units = orbit.model.state_units if isinstance(orbit.model, HasStateUnits) else None
    figure = new_figure(9, max(4.0, 1.3 * n), rows=n, columns=2)
    left, right = parts(figure, (1, 1), (max(1.0, 0.3 * n), 1.0))
    rows = panels(left, n, 1, sharex=True)[:, 0]
    for i, axes in enumerate(rows):
        axes.plot(path.times, path.states[:, i], color=LINE)
        unit = "" if units is None else f" ({units[i]})"
        axes.set_ylabel(in_figure(f"{orbit.state_names[i]}{unit}"))
    rows[-1].set_xlabel("time (s)")
    draw_multipliers(right.subplots(), orbit.multipliers, orbit.multiplier_errors)
    return figure


def plot_response(response: PerturbedResponse) -> Figure:
    """Draw the disturbed states and the orbit over time."""
    n = len(response.state_names)
    figure = new_figure(8, max(4.0, 1.3 * n), rows=n)
    rows = panels(figure, n, 1, sharex=True)[:, 0]
    for i, axes in enumerate(rows):
        axes.plot(response.times, response.orbit[:, i], color=DRIVER, ls="--", label="orbit")
        axes.plot(response.times, response.states[:, i], color=LINE, label="disturbed")
        axes.set_ylabel(in_figure(response.state_names[i]))
    rows[-1].set_xlabel("time (s)")
    legend_below(figure)
    return figure
