"""Flight through a gust."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.figures.labels import state_symbol
from birdmb.figures.multipliers import rounded_up
from birdmb.figures.page import label_x, legend_below, new_figure, panels, title
from birdmb.figures.style import BLACK, BLUE, DRIVER, GREEN, LEVEL, LINE, SERIES, VERMILION
from birdmb.text import in_figure

_TINY = 1e-3  # of a multiplier, whose digits are its error's
_PANELS = {"u": ("m/s", 1.0), "w": ("m/s", 1.0)} | {
    "q": ("°/s", np.degrees(1.0)),
    "theta": ("°", np.degrees(1.0)),
}
_DIRECTIONS: dict[str, dict[str, Any]] = {
    "forward": {"color": GREEN, "ls": "--"},
    "up": {"color": BLUE, "ls": "-"},
    "right": {"color": VERMILION, "ls": "-."},
}


@checked
def plot_gust_response(data: xr.Dataset) -> Figure:
    """Draw a `gust_response`: the gust, the deviations from the limit cycle, and the height."""
    figure = new_figure(10, 7.5, rows=3, columns=2)
    rows = panels(figure, 3, 2, sharex=True, height_ratios=(0.8, 1, 1))
    time = data["time"].values
    for name, style in _DIRECTIONS.items():
        wind = data["gust"].sel(direction=name)
        if wind.values.any():
            rows[0, 0].plot(time, wind, label=name, **style)
    along = ", body axes" if data.attrs["axes"] == "body" else ""
    rows[0, 0].set_ylabel(f"gust{along} (m/s)")
    rows[0, 0].legend(frameon=False, fontsize="small")
    rows[0, 1].plot(time, data["h"] - data["orbit_h"], color=LINE)
    rows[0, 1].set_ylabel("height gained (m)")
    for axes, (name, (unit, scale)) in zip(rows[1:].ravel(), _PANELS.items(), strict=True):
        _deviation(axes, data.sel(state=name), scale)
        axes.set_ylabel(f"Δ{state_symbol(name)} ({unit})")
    legend_below(figure, rows[1, 0].get_legend_handles_labels()[0], most=4)
    for axes in rows.ravel():
        axes.axhline(0, **LEVEL)
        axes.spines[["top", "right"]].set_visible(False)
        axes.set_xlim(time[0], time[-1])
    label_x(rows, "time (s)")
    figure.align_ylabels(rows)
    title(figure, f"{in_figure(data.attrs['bird'])}: flight through a gust")
    return figure


def plot_gust_states(data: xr.Dataset) -> Figure:
    """Draw the body's states in a `gust_response`, and those of the limit cycle without the gust.

    Thin where they are over a beat, thick their running mean over one.
    """
    figure = new_figure(10, 6, rows=2, columns=2)
    rows = panels(figure, 2, 2, sharex=True)
    time = data["time"].values
    beat = int(np.searchsorted(time, time[0] + data.attrs["period"] * (1 - 1e-9)))
    for axes, (name, (unit, scale)) in zip(rows.ravel(), _PANELS.items(), strict=True):
        for variable, style, label in (
            ("orbit", {"color": DRIVER, "ls": "--"}, "without the gust"),
            ("states", {"color": LINE, "ls": "-"}, "in the gust"),
        ):
            values = scale * data[variable].sel(state=name).values
            axes.plot(time, values, lw=0.6, alpha=0.7, **style)
            axes.plot(*_running_mean(time, values, beat), lw=2, label=label, **style)
        axes.set_ylabel(f"{state_symbol(name)} ({unit})")
        axes.spines[["top", "right"]].set_visible(False)
        axes.set_xlim(time[0], time[-1])
    label_x(rows, "time (s)")
    legend_below(figure)
    figure.align_ylabels(rows)
    bird = in_figure(data.attrs["bird"])
    title(figure, f"{bird}: states in a gust (thin: within a beat; thick: mean over one)")
    return figure


def _running_mean(
    times: FloatArray, values: FloatArray, width: int
) -> tuple[FloatArray, FloatArray]:
    """Means over `width` intervals of values (K,) at even times, at the middles of these."""
    ends = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]))])
    middles = 0.5 * (times[width:] + times[:-width])
    return middles, (ends[width:] - ends[:-width]) / width


def _deviation(axes: Axes, data: xr.Dataset, scale: float) -> None:
    axes.plot(data["time"], scale * data["deviation"], color=LINE, lw=2, label="full model")
    axes.plot(data["time"], scale * data["linear"], color=BLACK, ls="--", lw=1, label="linear")
    styles = [style for style in SERIES if style["color"] not in (LINE, BLACK)]
    largest = float(np.abs(data["linear"]).max())
    for i in range(data.sizes["mode"]):
        mode = data.isel(mode=i)
        if float(np.abs(mode["mode_deviation"]).max()) < 0.02 * largest:
            continue
        real, imag = float(mode["multiplier_real"]), float(mode["multiplier_imag"])
        if (modulus := abs(complex(real, imag))) < _TINY:
            label = f"mode |Λ| < {rounded_up(modulus)}"
        else:
            label = f"mode Λ = {real:.3g}" + (f" ± {imag:.3g} i" if imag else "")
        axes.plot(
            mode["time"],
            scale * mode["mode_deviation"],
            lw=0.9,
            label=label if "$" in label else label.replace("-", "−"),
            **styles[i % len(styles)],
        )
