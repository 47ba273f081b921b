"""A parameter study: the mean flights, and where the multipliers go."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from birdmb.figures.labels import IMAGINARY, MODULUS, REAL, parameter_label
from birdmb.figures.page import label_x, legend_below, new_figure, panels, title
from birdmb.figures.style import LEVEL, LINE, STABLE_COLOUR, UNSTABLE_COLOUR
from birdmb.quantities import quantities
from birdmb.text import in_figure

_ROWS = quantities(("mean_speed", "mean_climb_rate", "path_angle", "power"))


def plot_performance(study: xr.Dataset) -> Figure:
    """Draw mean speed, climb rate, path angle and power of a `parameter_study` over its parameter.

    The axis is the dimension of the study: another coordinate may be made it by `swap_dims`. Open
    markers are cycles outside the model's validity.
    """
    figure = new_figure(9, 5.6, rows=2, columns=2)
    rows = panels(figure, 2, 2, sharex=True)
    parameter, valid = _parameter(study), study["warning"].values == ""
    for axes, quantity in zip(rows.ravel(), _ROWS, strict=True):
        shown = np.array([quantity.shown(value) for value in study[quantity.name].values])
        axes.plot(study[parameter], shown, "-", color=LINE)
        for inside, face in ((valid, LINE), (~valid, "w")):
            axes.plot(study[parameter][inside], shown[inside], **_marker("o", LINE, face))
        if quantity.name in ("mean_climb_rate", "path_angle"):
            axes.axhline(0, **LEVEL)
        axes.set_ylabel(quantity.axis_label)
        axes.spines[["top", "right"]].set_visible(False)
    label_x(rows, _label(study))
    figure.align_ylabels()
    _title(figure, study, "mean flight of the limit cycles")
    return figure


def plot_multiplier_locus(study: xr.Dataset) -> Figure:
    """Draw the moduli of the multipliers over the parameter, and where they go in the plane.

    Axis and open markers as in `plot_performance`.
    """
    figure = new_figure(10, 4.6, columns=2)
    left, right = panels(figure, 1, 2)[0]
    values = study["multiplier_real"].values + 1j * study["multiplier_imag"].values
    moduli = np.abs(values)
    over = np.broadcast_to(study[_parameter(study)].values[:, None], moduli.shape)
    left.axhline(1, **LEVEL)
    valid = np.broadcast_to(study["warning"].values[:, None] == "", moduli.shape)
    for stable, marker, colour in ((True, "o", STABLE_COLOUR), (False, "^", UNSTABLE_COLOUR)):
        shown = (moduli <= 1) == stable
        label = f"{MODULUS} ≤ 1" if stable else f"{MODULUS} > 1"
        for where, face in ((valid & shown, colour), (~valid & shown, "w")):
            left.plot(over[where], moduli[where], **_marker(marker, colour, face))
        left.plot([], [], label=label, **_marker(marker, colour, colour))
    left.set(xlabel=_label(study), ylabel=MODULUS, ylim=(0, None))
    left.locator_params(axis="x", nbins=6)
    legend_below(figure)
    left.spines[["top", "right"]].set_visible(False)
    _draw_plane(right, values, over)
    figure.colorbar(right.collections[0], ax=right, label=_label(study), pad=0.02)
    _title(figure, study, "Floquet multipliers")
    return figure


def _draw_plane(axes: Axes, values: np.ndarray, over: np.ndarray) -> None:
    axes.axhline(0, **LEVEL)
    axes.axvline(0, **LEVEL)
    axes.add_patch(Circle((0, 0), 1, fill=False, color="0.6"))
    axes.scatter(values.real, values.imag, c=over, s=22, cmap="viridis", zorder=3)
    reach = 1.08 * max(1.0, float(np.nanmax(np.abs(values.imag))))
    furthest = max(1.0, float(np.nanmax(values.real)))
    nearest = min(-1.0, float(np.nanmin(values.real)))
    axes.set(xlim=(nearest - 0.08, furthest + 0.08), ylim=(-reach, reach), aspect="equal")
    axes.set(xlabel=REAL, ylabel=IMAGINARY)
    axes.spines[["top", "right"]].set_visible(False)


def _marker(marker: str, colour: str, face: str) -> dict[str, Any]:
    return {"ls": "", "marker": marker, "color": colour, "mfc": face, "ms": 4.5}


def _title(figure: Figure, study: xr.Dataset, what: str) -> None:
    outside = " (open: outside the model's validity)" if (study["warning"] != "").any() else ""
    title(figure, f"{in_figure(study.attrs['bird'])}: {what}{outside}")


def _parameter(study: xr.Dataset) -> str:
    return str(study["mean_speed"].dims[0])


def _label(study: xr.Dataset) -> str:
    return parameter_label(_parameter(study))
