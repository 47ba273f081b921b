"""Flight after disturbances along the modes of a limit cycle."""

from __future__ import annotations

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from birdmb.figures.style import symbol
from birdmb.text import in_figure

_BODY = {"u": ("m/s", 1.0), "w": ("m/s", 1.0), "theta": ("°", np.degrees(1.0))} | {
    "q": ("°/s", np.degrees(1.0))
}


def plot_perturbed_flight(data: xr.Dataset) -> Figure:
    """Draw the body's states and the flight path of a `perturbed_flight`, and of the cycle."""
    figure = Figure(figsize=(10, 8), layout="constrained")
    top, bottom = figure.subfigures(2, 1, squeeze=False, height_ratios=(1.7, 1))[:, 0]
    panels = top.subplots(2, 2, sharex=True)
    beats = (data["time"].values - data["time"].values[0]) / data.attrs["period"]
    colours = matplotlib.colormaps["tab10"].colors  # type: ignore[attr-defined]
    for axes, (name, (unit, scale)) in zip(panels.ravel(), _BODY.items(), strict=True):
        axes.plot(beats, scale * data["orbit"].sel(state=name), color="0.6", lw=3)
        for i in range(data.sizes["mode"]):
            states = data["states"].isel(mode=i).sel(state=name)
            axes.plot(beats, scale * states, color=colours[i], lw=1.2)
        axes.set_ylabel(f"{symbol(name)} ({unit})")
        axes.set_xlim(0, beats[-1])
        axes.spines[["top", "right"]].set_visible(False)
    for axes in panels[-1]:
        axes.set_xlabel("time (beats)")
    top.align_ylabels()
    path = bottom.subplots()
    path.plot(data["orbit_X"], data["orbit_h"], color="0.6", lw=3, label="limit cycle")
    for i in range(data.sizes["mode"]):
        each = data.isel(mode=i)
        path.plot(each["X"], each["h"], color=colours[i], lw=1.2, label=_mode(each))
    path.set(xlabel="path X (m)", ylabel="height (m)")
    path.spines[["top", "right"]].set_visible(False)
    path.legend(frameon=False, fontsize="small", loc="best")
    figure.suptitle(
        f"{in_figure(data.attrs['bird'])}: flight after a disturbance along each mode "
        f"({data.attrs['amplitude']:.3g} of the state scale)",
        fontsize="medium",
    )
    return figure


def _mode(mode: xr.Dataset) -> str:
    real, imag = float(mode["multiplier_real"]), float(mode["multiplier_imag"])
    return f"Λ = {real:.3f}" + (f" ± {imag:.3f} i" if imag else "").replace("-", "−")
