"""A sweep: lines over one parameter, maps over two."""

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

from birdmb.figures.style import LINE, STABLE_COLOUR, UNSTABLE_COLOUR
from birdmb.quantities import BY_NAME
from birdmb.studies.sweeps.errors import SweepError
from birdmb.studies.sweeps.verdicts import verdict_lines
from birdmb.text import in_figure

OVERVIEW = (
    "largest_modulus",
    "mean_speed",
    "mean_climb_rate",
    "time_constant",
    "power",
    "cost_of_transport",
)
_LABELS = {"largest_modulus": "|Λ|max", "time_constant": "time constant (s)"}
_UNITS = {
    "stiffness": "N m/rad",
    "damping": "N m s/rad",
    "mass": "kg",
    "frequency": "Hz",
} | dict.fromkeys(("x", "y", "z", "length"), "m")
# Where it turns (red is unstable, purple sinks), and the colours on both sides, above and below.
_TURNS = {
    "largest_modulus": (1.0, "RdBu_r", "Reds", "Blues_r"),
    "mean_climb_rate": (0.0, "PuOr_r", "Oranges", "Purples_r"),
}
_DECADE = 10.0  # a wider range of time constants is drawn on a logarithmic scale
_FAILED: dict[str, Any] = {"facecolor": "0.9", "edgecolor": "0.5", "hatch": "////", "linewidth": 0}
_BEYOND: dict[str, Any] = {"ls": "", "marker": ".", "color": "k", "markersize": 4}
_VERDICTS = {"stable": STABLE_COLOUR, "unstable": UNSTABLE_COLOUR, "undecided": "goldenrod"}
_UNDECIDED: dict[str, Any] = {
    "ls": "",
    "marker": "o",
    "color": _VERDICTS["undecided"],
    "markerfacecolor": "none",
}
_BACKWARDS: dict[str, Any] = {"ls": "", "marker": "$<$", "color": "k", "markersize": 7}
_JUMP: dict[str, Any] = {"color": "deeppink", "linewidth": 2.4}


def plot_sweep(study: xr.Dataset, quantity: str | None, at: Mapping[str, Any]) -> Figure:
    """Draw quantities of a study's dataset; see `Study.plot`."""
    title = in_figure(f"{study.attrs['bird']}, {study.attrs['model']}")
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
    (rows, columns), two = (1, 1) if quantity else (2, 3), len(plane["power"].dims) == 2
    figure = Figure(figsize=(5.4 * columns, 4.2 * rows), layout="constrained")
    panels = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=two)
    for axes, name in zip(panels.ravel(), quantities, strict=True):
        (_draw_map if two else _draw_lines)(axes, plane, name)
    for axes in panels[:-1].ravel():
        axes.set_xlabel("")
    for axes in panels[:, 1:].ravel() if two else ():
        axes.set_ylabel("")
    caption = [title, *fixed, *verdict_lines(plane)]
    figure.suptitle("\n".join(caption), fontsize="medium")
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
    texts = [f"{_label(str(name))[0]} = {in_figure(str(value))}" for name, value in fixed.items()]
    return plane, [", ".join(texts)] if texts else []


def parameter_label(name: str) -> str:
    """Name of a parameter with its unit, as an axis is labelled."""
    return _label(name)[1]


def _label(name: str) -> tuple[str, str]:
    """Name of a parameter without its unit, and with it."""
    plain = in_figure(name.removesuffix("_deg"))
    unit = "°" if name.endswith("_deg") else _UNITS.get(name.rpartition(".")[2])
    return plain, f"{plain} ({unit})" if unit else plain


def _places(axes: Axes, along: Literal["x", "y"], coordinate: xr.DataArray) -> np.ndarray:
    """Where the values of a parameter stand on an axis; texts and switches stand side by side."""
    getattr(axes, f"set_{along}label")(_label(str(coordinate.name))[1])
    if coordinate.dtype.kind in "if":
        axes.locator_params(axis=along, nbins=6)
        return np.asarray(coordinate.values, float)
    places = np.arange(coordinate.size, dtype=float)
    labels = [in_figure(str(value)) for value in coordinate.values]
    getattr(axes, f"set_{along}ticks")(places, labels)
    return places


def _quantity_label(study: xr.Dataset, name: str) -> str:
    if name in _LABELS:
        return _LABELS[name]
    if name in BY_NAME:
        quantity = BY_NAME[name]
        # The values drawn are those of the dataset.
        return f"{quantity.label} ({quantity.unit})" if quantity.unit != "1" else quantity.label
    units = study[name].attrs.get("units", "s" if name == "seconds" else "1")
    plain = in_figure(name.replace("_", " "))
    return plain if units == "1" else f"{plain} ({units})"


def _draw_lines(axes: Axes, study: xr.Dataset, name: str) -> None:
    (parameter,) = study["power"].dims
    x, y = _places(axes, "x", study[parameter]), study[name].values
    jump = study["sheet_jump"].sel(along=parameter).values
    # Where a sheet ends the line does.
    line_x, line_y = (np.insert(a, np.flatnonzero(jump) + 1, np.nan) for a in (x, y))
    colour = LINE if name != "largest_modulus" else "0.6"
    axes.plot(line_x, line_y, "-", color=colour, lw=1.2, zorder=1)
    for kind, colour in _VERDICTS.items():
        shown = study["stability"].values == kind
        axes.plot(x[shown], y[shown], "o", color=colour, markersize=4.5)
    backwards = study["flight"].values == "backwards"
    if backwards.any():
        axes.plot(x[backwards], y[backwards], **_BACKWARDS)
    for i in np.flatnonzero(jump):
        axes.axvline(0.5 * (x[i] + x[i + 1]), **_JUMP | {"linewidth": 1.2})
    if name == "largest_modulus":
        axes.axhline(1, color="k", lw=1)
    if name == "mean_climb_rate":
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
    j, i = (study["stability"].transpose(up, across).values == "undecided").nonzero()
    if i.size:
        axes.plot(x[i], y[j], **_UNDECIDED)
    j, i = (study["flight"].transpose(up, across).values == "backwards").nonzero()
    if i.size:
        axes.plot(x[i], y[j], **_BACKWARDS)
    jumps = study["sheet_jump"].transpose(up, across, "along")
    _draw_jumps(axes, jumps, (left, right), (lower, upper))
    axes.set_xlim(left[0], right[-1])
    axes.set_ylim(lower[0], upper[-1])


def _draw_jumps(
    axes: Axes,
    jumps: xr.DataArray,
    across: tuple[np.ndarray, np.ndarray],
    up: tuple[np.ndarray, np.ndarray],
) -> None:
    """Draw a line between the cells of neighbours that lie on different sheets."""
    (left, right), (lower, upper) = across, up
    of_rows, of_columns, _ = map(str, jumps.dims)
    for j, i in np.argwhere(jumps.sel(along=of_columns).values):
        axes.plot([right[i], right[i]], [lower[j], upper[j]], **_JUMP)
    for j, i in np.argwhere(jumps.sel(along=of_rows).values):
        axes.plot([left[i], right[i]], [upper[j], upper[j]], **_JUMP)


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
    verdicts = study["stability"].values
    if len(study["power"].dims) == 2:
        if np.nanmin(modulus, initial=np.inf) < 1 < np.nanmax(modulus, initial=-np.inf):
            boundary = "stability boundary, |Λ|max = 1"
            handles.append(Line2D([], [], color="k", lw=1.6, label=boundary))
        if (verdicts == "undecided").any():
            handles.append(Line2D([], [], label="undecided", **_UNDECIDED))
        if (status == "failed").any():
            handles.append(Patch(label="no limit cycle found", **_FAILED))
        if (study["warning"].values != "").any():
            handles.append(Line2D([], [], label="beyond the model's validity", **_BEYOND))
    else:
        for kind, colour in _VERDICTS.items():
            if (verdicts == kind).any():
                handles.append(Line2D([], [], ls="", marker="o", color=colour, label=kind))
        if (status == "failed").any():
            failed = "no limit cycle found"
            handles.append(Line2D([], [], ls="", marker="x", color="0.3", label=failed))
    if (study["flight"].values == "backwards").any():
        handles.append(Line2D([], [], label="flies backwards", **_BACKWARDS))
    if study["sheet_jump"].values.any():
        handles.append(Line2D([], [], label="neighbours on different flights", **_JUMP))
    return handles
