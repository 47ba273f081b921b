"""Figures of a study: lines over one parameter, maps over two."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize, TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from birdmb.figures.style import LINE, literal
from birdmb.orbits.plots import STABLE_COLOUR, UNSTABLE_COLOUR
from birdmb.studies.sweeps.errors import SweepError

OVERVIEW = ("largest_modulus", "time_constant", "power", "climb_rate")
_LABELS = {
    "largest_modulus": "|Λ|max",
    "time_constant": "time constant (s)",
    "power": "wing power (W)",
    "climb_rate": "climb rate (m/s)",
    "mean_speed": "mean speed (m/s)",
}
_UNITS = {
    "stiffness": "N m/rad",
    "damping": "N m s/rad",
    "mass": "kg",
    "frequency": "Hz",
} | dict.fromkeys(("x", "y", "z", "length"), "m")
# Where it turns (red is unstable, purple sinks), and the colours on both sides, above and below.
_TURNS = {
    "largest_modulus": (1.0, "RdBu_r", "Reds", "Blues_r"),
    "climb_rate": (0.0, "PuOr_r", "Oranges", "Purples_r"),
}
_DECADE = 10.0  # a wider range of time constants is drawn on a logarithmic scale
_FAILED: dict[str, Any] = {"facecolor": "0.9", "edgecolor": "0.5", "hatch": "////", "linewidth": 0}
_BEYOND: dict[str, Any] = {"ls": "", "marker": ".", "color": "k", "markersize": 4}


def plot_study(study: xr.Dataset, quantity: str | None, at: Mapping[str, Any]) -> Figure:
    """Draw quantities of a study's dataset; see `Study.plot`."""
    title = f"{literal(study.attrs['bird'])}, {study.attrs['model']}"
    plane, fixed = _left(study, at)
    quantities = OVERVIEW if quantity is None else (quantity,)
    for name in quantities:
        if name not in study or study[name].dims != study["power"].dims:
            known = (
                n for n, v in study.items() if v.dims == study["power"].dims and v.dtype.kind == "f"
            )
            raise SweepError(
                f"No quantity is called {name}; there are {', '.join(map(str, known))}."
            )
    rows, two = (1 if len(quantities) == 1 else 2), len(plane["power"].dims) == 2
    figure = Figure(figsize=(5.4 * rows, 4.0 * rows), layout="constrained")
    panels = figure.subplots(rows, rows, squeeze=False, sharex=True, sharey=two)
    for axes, name in zip(panels.ravel(), quantities, strict=True):
        (_draw_map if two else _draw_lines)(axes, plane, name)
    for axes in panels[:-1].ravel():
        axes.set_xlabel("")
    for axes in panels[:, 1:].ravel() if two else ():
        axes.set_ylabel("")
    figure.suptitle("\n".join([title, *fixed]), fontsize="medium")
    handles = _legend(plane)
    if handles:
        figure.legend(
            handles=handles, loc="outside lower center", ncols=3, frameon=False, fontsize="small"
        )
    return figure


def _left(study: xr.Dataset, at: Mapping[str, Any]) -> tuple[xr.Dataset, list[str]]:
    """The study over the one or two parameters that are left, and the fixed ones as texts."""
    parameters = list(study["power"].dims)
    for name, value in at.items():
        if name not in parameters:
            raise SweepError(
                f"{name} is no parameter of the study: {', '.join(map(str, parameters))}."
            )
        values = study[name].values.tolist()
        if value not in values:
            raise SweepError(
                f"{name} does not take the value {value}: {', '.join(map(str, values))}."
            )
    one = {n: study[n].values[0] for n in parameters if study.sizes[n] == 1 and n not in at}
    fixed = dict(at) | (
        one if len(one) + len(at) < len(parameters) else dict(list(one.items())[1:])
    )
    left = [str(name) for name in parameters if name not in fixed]
    if len(left) > 2:
        raise SweepError(
            f"The study varies {', '.join(left)}; fix all but two of them for a picture, for "
            f"instance {left[-1]} = {study[left[-1]].values[0]}."
        )
    if not left:
        raise SweepError("All parameters are fixed; leave one or two for a picture.")
    plane = study.sel(fixed)
    for name in left:
        if plane[name].dtype.kind in "if":
            plane = plane.sortby(name)
    texts = [f"{_label(str(name))[0]} = {value}" for name, value in fixed.items()]
    return plane, [", ".join(texts)] if texts else []


def _label(name: str) -> tuple[str, str]:
    """Name of a parameter without its unit, and with it."""
    plain = name.removesuffix("_deg")
    unit = "°" if name.endswith("_deg") else _UNITS.get(name.rpartition(".")[2])
    return plain, f"{plain} ({unit})" if unit else plain


def _places(axes: Axes, along: Literal["x", "y"], coordinate: xr.DataArray) -> np.ndarray:
    """Where the values of a parameter stand on an axis; texts and switches stand side by side."""
    getattr(axes, f"set_{along}label")(_label(str(coordinate.name))[1])
    if coordinate.dtype.kind in "if":
        axes.locator_params(axis=along, nbins=6)
        return np.asarray(coordinate.values, float)
    places = np.arange(coordinate.size, dtype=float)
    getattr(axes, f"set_{along}ticks")(places, list(map(str, coordinate.values)))
    return places


def _quantity_label(study: xr.Dataset, name: str) -> str:
    units = study[name].attrs.get("units", "s" if name == "seconds" else "1")
    plain = name.replace("_", " ")
    return _LABELS.get(name, plain if units == "1" else f"{plain} ({units})")


def _draw_lines(axes: Axes, study: xr.Dataset, name: str) -> None:
    (parameter,) = study["power"].dims
    x, y = _places(axes, "x", study[parameter]), study[name].values
    unstable = study["largest_modulus"].values > 1
    axes.plot(x, y, "-", color=LINE if name != "largest_modulus" else "0.6", lw=1.2, zorder=1)
    for shown, colour in ((unstable, UNSTABLE_COLOUR), (~unstable, STABLE_COLOUR)):
        axes.plot(x[shown], y[shown], "o", color=colour, markersize=4.5)
    if name == "largest_modulus":
        axes.axhline(1, color="k", lw=1)
    if name == "climb_rate":
        axes.axhline(0, color="0.7", lw=0.8, zorder=0)
    if name == "time_constant" and np.nanmax(y, initial=0.0) > _DECADE * np.nanmin(y, initial=1.0):
        axes.set_yscale("log")
    failed = x[study["status"].values == "failed"]
    axes.plot(
        failed, np.full(failed.size, 0.03), "x", color="0.3", transform=axes.get_xaxis_transform()
    )
    axes.set_ylabel(_quantity_label(study, name))
    axes.spines[["top", "right"]].set_visible(False)


def _draw_map(axes: Axes, study: xr.Dataset, name: str) -> None:
    across, up = study["power"].dims
    x, y = _places(axes, "x", study[across]), _places(axes, "y", study[up])
    values = study[name].transpose(up, across).values
    norm, colours = _colours(name, values)
    mesh = axes.pcolormesh(x, y, values, shading="nearest", norm=norm, cmap=colours)
    axes.figure.colorbar(mesh, ax=axes, label=_quantity_label(study, name), pad=0.02)
    modulus = study["largest_modulus"].transpose(up, across).values
    if np.nanmin(modulus, initial=np.inf) < 1 < np.nanmax(modulus, initial=-np.inf):
        axes.contour(x, y, modulus, levels=[1.0], colors="k", linewidths=1.6)
    failed = (study["status"].transpose(up, across).values == "failed").nonzero()
    left, right = _edges(x)
    lower, upper = _edges(y)
    for j, i in zip(*failed, strict=True):
        corner = (left[i], lower[j])
        axes.add_patch(Rectangle(corner, right[i] - left[i], upper[j] - lower[j], **_FAILED))
    j, i = (study["warning"].transpose(up, across).values != "").nonzero()
    axes.plot(x[i], y[j], **_BEYOND)
    axes.set_xlim(left[0], right[-1])
    axes.set_ylim(lower[0], upper[-1])


def _edges(centres: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Both ends of the cells about ascending centres, as `shading="nearest"` draws them."""
    if centres.size == 1:
        return centres - 0.5, centres + 0.5
    middles = 0.5 * (centres[1:] + centres[:-1])
    first, last = 2 * centres[0] - middles[0], 2 * centres[-1] - middles[-1]
    return np.append(first, middles), np.append(middles, last)


def _colours(name: str, values: np.ndarray) -> tuple[Normalize, str]:
    """Scale and colours; two of them meet where the quantity changes its meaning."""
    low, high = np.nanmin(values, initial=np.inf), np.nanmax(values, initial=-np.inf)
    if name in _TURNS:
        at, both, above, below = _TURNS[name]
        if low < at < high:
            return TwoSlopeNorm(at), both
        return Normalize(), above if low >= at else below
    wide = name == "time_constant" and high > _DECADE * low
    return (LogNorm() if wide else Normalize()), "viridis"


def _legend(study: xr.Dataset) -> list[Any]:
    handles: list[Any] = []
    modulus, status = study["largest_modulus"].values, study["status"].values
    if len(study["power"].dims) == 2:
        if np.nanmin(modulus, initial=np.inf) < 1 < np.nanmax(modulus, initial=-np.inf):
            handles.append(
                Line2D([], [], color="k", lw=1.6, label="stability boundary, |Λ|max = 1")
            )
        if (status == "failed").any():
            handles.append(Patch(label="no limit cycle found", **_FAILED))
        if (study["warning"].values != "").any():
            handles.append(Line2D([], [], label="beyond the model's validity", **_BEYOND))
        return handles
    for colour, shown, label in (
        (STABLE_COLOUR, modulus <= 1, "stable"),
        (UNSTABLE_COLOUR, modulus > 1, "unstable"),
        ("0.3", status == "failed", "no limit cycle found"),
    ):
        if shown.any():
            marker = "x" if colour == "0.3" else "o"
            handles.append(Line2D([], [], ls="", marker=marker, color=colour, label=label))
    return handles
