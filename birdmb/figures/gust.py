"""Flight through a gust."""

from __future__ import annotations

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.figures.style import symbol
from birdmb.text import in_figure

_PANELS = {"u": ("m/s", 1.0), "w": ("m/s", 1.0)} | {
    "q": ("°/s", np.degrees(1.0)),
    "theta": ("°", np.degrees(1.0)),
}


@checked
def plot_gust_response(data: xr.Dataset) -> Figure:
    """Draw a `gust_response`: the gust, the deviations from the limit cycle, and the height."""
    figure = Figure(figsize=(10, 7.5), layout="constrained")
    rows = figure.subplots(3, 2, sharex=True, height_ratios=(0.8, 1, 1))
    time = data["time"].values
    for name, colour in (("forward", "0.6"), ("up", "0.2"), ("right", "tab:blue")):
        wind = data["gust"].sel(direction=name)
        if wind.values.any():
            rows[0, 0].plot(time, wind, color=colour, label=name)
    along = ", body axes" if data.attrs["axes"] == "body" else ""
    rows[0, 0].set_ylabel(f"gust{along} (m/s)")
    rows[0, 0].legend(frameon=False, fontsize="small")
    rows[0, 1].plot(time, data["h"] - data["orbit_h"], color="tab:blue")
    rows[0, 1].set_ylabel("height gained (m)")
    for axes, (name, (unit, scale)) in zip(rows[1:].ravel(), _PANELS.items(), strict=True):
        _deviation(axes, data.sel(state=name), scale)
        axes.set_ylabel(f"Δ{symbol(name)} ({unit})")
    rows[1, 0].legend(frameon=False, fontsize="small", loc="best")
    for axes in rows.ravel():
        axes.axhline(0, color="0.8", lw=0.8, zorder=0)
        axes.spines[["top", "right"]].set_visible(False)
        axes.set_xlim(time[0], time[-1])
    for axes in rows[-1]:
        axes.set_xlabel("time (s)")
    figure.align_ylabels(rows)
    figure.suptitle(f"{in_figure(data.attrs['bird'])}: flight through a gust", fontsize="medium")
    return figure


def plot_gust_states(data: xr.Dataset) -> Figure:
    """Draw the body's states in a `gust_response`, and those of the limit cycle without the gust.

    Thin where they are over a beat, thick their running mean over one.
    """
    figure = Figure(figsize=(10, 6), layout="constrained")
    panels = figure.subplots(2, 2, sharex=True)
    time = data["time"].values
    beat = int(np.searchsorted(time, time[0] + data.attrs["period"] * (1 - 1e-9)))
    for axes, (name, (unit, scale)) in zip(panels.ravel(), _PANELS.items(), strict=True):
        for variable, colour, label in (
            ("orbit", "0.6", "without the gust"),
            ("states", "tab:blue", "in the gust"),
        ):
            values = scale * data[variable].sel(state=name).values
            axes.plot(time, values, color=colour, lw=0.6, alpha=0.7)
            axes.plot(*_running_mean(time, values, beat), color=colour, lw=2, label=label)
        axes.set_ylabel(f"{symbol(name)} ({unit})")
        axes.spines[["top", "right"]].set_visible(False)
        axes.set_xlim(time[0], time[-1])
    for axes in panels[-1]:
        axes.set_xlabel("time (s)")
    panels[0, 0].legend(frameon=False, fontsize="small")
    figure.align_ylabels(panels)
    figure.suptitle(
        f"{in_figure(data.attrs['bird'])}: states in a gust (thick: mean over a beat)",
        fontsize="medium",
    )
    return figure


def _running_mean(
    times: FloatArray, values: FloatArray, width: int
) -> tuple[FloatArray, FloatArray]:
    """Means over `width` intervals of values (K,) at even times, at the middles of these."""
    ends = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]))])
    middles = 0.5 * (times[width:] + times[:-width])
    return middles, (ends[width:] - ends[:-width]) / width


def _deviation(axes: Axes, data: xr.Dataset, scale: float) -> None:
    axes.plot(data["time"], scale * data["deviation"], color="tab:blue", lw=2, label="full model")
    axes.plot(data["time"], scale * data["linear"], color="k", ls="--", lw=1, label="linear")
    colours = matplotlib.colormaps["tab10"].colors  # type: ignore[attr-defined]
    largest = float(np.abs(data["linear"]).max())
    for i in range(data.sizes["mode"]):
        mode = data.isel(mode=i)
        if float(np.abs(mode["mode_deviation"]).max()) < 0.02 * largest:
            continue
        real, imag = float(mode["multiplier_real"]), float(mode["multiplier_imag"])
        label = f"mode Λ = {real:.3g}" + (f" ± {imag:.3g} i" if imag else "")
        colour = colours[(i + 1) % len(colours)]
        axes.plot(
            mode["time"],
            scale * mode["mode_deviation"],
            color=colour,
            lw=0.8,
            label=label.replace("-", "−"),
        )
