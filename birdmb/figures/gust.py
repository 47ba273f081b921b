"""Flight through a gust."""

from __future__ import annotations

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from birdmb.figures.style import symbol
from birdmb.text import in_figure

_PANELS = {"u": ("m/s", 1.0), "w": ("m/s", 1.0)} | {
    "q": ("°/s", np.degrees(1.0)),
    "theta": ("°", np.degrees(1.0)),
}


def plot_gust_response(data: xr.Dataset) -> Figure:
    """Draw a `gust_response`: the gust, the deviations from the limit cycle, and the height."""
    figure = Figure(figsize=(10, 7.5), layout="constrained")
    rows = figure.subplots(3, 2, sharex=True, height_ratios=(0.8, 1, 1))
    time = data["time"].values
    for name, colour in (("forward", "0.6"), ("up", "0.2"), ("right", "tab:blue")):
        wind = data["gust"].sel(direction=name)
        if wind.values.any():
            rows[0, 0].plot(time, wind, color=colour, label=name)
    rows[0, 0].set_ylabel("gust (m/s)")
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
