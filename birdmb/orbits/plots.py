"""Figures of orbits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from birdmb._typing import ComplexArray, FloatArray
from birdmb.orbits.ode import Trajectory

STABLE_COLOUR, UNSTABLE_COLOUR = "tab:blue", "tab:red"


def plot_cycle(
    path: Trajectory,
    state_names: Sequence[str],
    units: Sequence[str] | None,
    multipliers: ComplexArray,
    errors: FloatArray,
) -> Figure:
    """Draw the states over time on the left, the multipliers in the unit circle on the right."""
    n = len(state_names)
    figure = Figure(figsize=(9, max(4.0, 1.3 * n)), layout="constrained")
    left, right = figure.subfigures(1, 2, squeeze=False)[0]
    rows = left.subplots(n, 1, sharex=True, squeeze=False)[:, 0]
    for i, axes in enumerate(rows):
        axes.plot(path.times, path.states[:, i])
        axes.set_ylabel(state_names[i] if units is None else f"{state_names[i]} ({units[i]})")
    rows[-1].set_xlabel("time (s)")
    draw_multipliers(right.subplots(), multipliers, errors)
    return figure


def draw_multipliers(axes: Axes, multipliers: ComplexArray, errors: FloatArray) -> None:
    """Draw multipliers (n,) in the complex plane, with their error bounds as discs."""
    axes.add_patch(Circle((0, 0), 1, fill=False, color="0.6"))
    inside = np.abs(multipliers) <= 1
    for keep, colour in ((inside, STABLE_COLOUR), (~inside, UNSTABLE_COLOUR)):
        axes.plot(multipliers[keep].real, multipliers[keep].imag, "o", color=colour)
    for value, error in zip(multipliers, errors, strict=True):
        if np.isfinite(error):
            axes.add_patch(Circle((value.real, value.imag), error, color="0.5", alpha=0.3))
    reach = 1.1 * max(1.0, float(np.abs(multipliers).max()))
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes.set(xlabel="Re Λ", ylabel="Im Λ", title="Floquet multipliers")


def plot_response(
    times: FloatArray, states: FloatArray, orbit: FloatArray, state_names: Sequence[str]
) -> Figure:
    """Draw disturbed states (k, n) and the orbit (k, n) over time."""
    n = len(state_names)
    figure = Figure(figsize=(8, max(4.0, 1.3 * n)), layout="constrained")
    rows = figure.subplots(n, 1, sharex=True, squeeze=False)[:, 0]
    for i, axes in enumerate(rows):
        axes.plot(times, orbit[:, i], color="0.6", label="orbit")
        axes.plot(times, states[:, i], color=STABLE_COLOUR, label="disturbed")
        axes.set_ylabel(state_names[i])
    rows[0].legend(loc="upper right")
    rows[-1].set_xlabel("time (s)")
    return figure
