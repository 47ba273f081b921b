"""Angles of attack over beat and span."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import CenteredNorm
from matplotlib.figure import Figure

from birdmb.figures.page import label_x, label_y, new_figure, panels, title
from birdmb.text import in_figure

_PANELS = {
    "angle_of_attack": "geometric",
    "effective_angle_of_attack": "effective (with downwash)",
}
_STEP = 2.5  # deg


def plot_validity(data: xr.Dataset) -> Figure:
    """Draw both angles of attack of `Validity.data` over beat and span.

    The limit is drawn as a black line; the tip that is not judged is hatched.
    """
    figure = new_figure(10, 4.2, columns=2)
    row = panels(figure, 1, 2, sharex=True, sharey=True)
    judged = data["judged"].values
    largest = max(float(np.degrees(np.abs(data[name].values[judged]).max())) for name in _PANELS)
    largest = _STEP * np.ceil(largest / _STEP)
    style = {
        "levels": np.arange(-largest, largest + _STEP, _STEP),
        "norm": CenteredNorm(0.0, largest),
        "cmap": "RdBu_r",
        "extend": "both",
    }
    for axes, (name, about) in zip(row[0], _PANELS.items(), strict=True):
        _draw(axes, data, np.degrees(data[name].values), style)
        title(axes, about)
    label_x(row, "phase of the beat")
    label_y(row, "span position (part of the half-span)")
    figure.colorbar(
        row[0, 1].collections[0], ax=row.ravel().tolist(), label="angle of attack (°)", pad=0.01
    )
    title(figure, f"{in_figure(data.attrs['bird'])}: angle of attack (limit drawn as a line)")
    return figure


def _draw(axes: Axes, data: xr.Dataset, angle: np.ndarray, style: dict[str, Any]) -> None:
    times = data["time"].values
    beats = data["phase"].values[0] + (times - times[0]) / np.ptp(times)
    phase = np.broadcast_to(beats[:, None], angle.shape)
    span = data["span_fraction"].values
    axes.contourf(phase, span, angle, **style)
    limit = np.degrees(data.attrs["largest_angle"])
    if np.abs(angle).max() > limit:
        axes.contour(phase, span, angle, levels=[-limit, limit], colors="k", linewidths=1.2)
    axes.fill_between(
        beats,
        _inner_edge_of_tip(data),
        1.0,
        facecolor="w",
        edgecolor="0.7",
        hatch="////",
        linewidth=0,
        zorder=3,
    )
    axes.set(xlim=(beats[0], beats[-1]), ylim=(float(span[:, 0].max()), 1))


def _inner_edge_of_tip(data: xr.Dataset) -> np.ndarray:
    """Part of the half-span (K,) beyond which lies the area that is not judged."""
    area = data["area"].values
    inside = (np.cumsum(area, axis=1) - 0.5 * area) / area.sum(axis=1, keepdims=True)
    span = data["span_fraction"].values
    judged = 1.0 - data.attrs["tip_area"]
    return np.array([np.interp(judged, *row) for row in zip(inside, span, strict=True)])
