"""Flight after disturbances along the modes of a limit cycle."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from birdmb.figures.labels import state_symbol
from birdmb.figures.page import is_narrow, label_x, new_figure, panels, title
from birdmb.figures.style import SERIES
from birdmb.text import in_figure

_BODY = {"u": ("m/s", 1.0), "w": ("m/s", 1.0), "theta": ("°", np.degrees(1.0))} | {
    "q": ("°/s", np.degrees(1.0))
}


def plot_perturbed_flight(data: xr.Dataset) -> Figure:
    """Draw the body's states and the flight path of a `perturbed_flight`, and of the cycle."""
    figure = new_figure(10, 8, rows=3, columns=2)
    top, bottom = figure.subfigures(
        2, 1, squeeze=False, height_ratios=(3.2 if is_narrow() else 1.7, 1)
    )[:, 0]
    rows = panels(top, 2, 2, sharex=True)
    beats = (data["time"].values - data["time"].values[0]) / data.attrs["period"]
    styles = list(SERIES)
    for axes, (name, (unit, scale)) in zip(rows.ravel(), _BODY.items(), strict=True):
        axes.plot(beats, scale * data["orbit"].sel(state=name), color="0.65", lw=3)
        for i in range(data.sizes["mode"]):
            states = data["states"].isel(mode=i).sel(state=name)
            axes.plot(beats, scale * states, lw=1.2, **styles[i % len(styles)])
        axes.set_ylabel(f"{state_symbol(name)} ({unit})")
        axes.set_xlim(0, beats[-1])
        axes.spines[["top", "right"]].set_visible(False)
    label_x(rows, "time (beats)")
    top.align_ylabels()
    path = bottom.subplots()
    path.plot(data["orbit_X"], data["orbit_h"], color="0.65", lw=3, label="limit cycle")
    for i in range(data.sizes["mode"]):
        each = data.isel(mode=i)
        path.plot(each["X"], each["h"], lw=1.2, label=_mode(each), **styles[i % len(styles)])
    path.set(xlabel="path X (m)", ylabel="height (m)")
    path.spines[["top", "right"]].set_visible(False)
    path.legend(frameon=False, fontsize="small", loc="best")
    title(
        figure,
        f"{in_figure(data.attrs['bird'])}: flight after a disturbance along each mode "
        f"({data.attrs['amplitude']:.3g} of the state scale)",
    )
    return figure


def _mode(mode: xr.Dataset) -> str:
    real, imag = float(mode["multiplier_real"]), float(mode["multiplier_imag"])
    return (f"Λ = {real:.3f}" + (f" ± {imag:.3f} i" if imag else "")).replace("-", "−")
