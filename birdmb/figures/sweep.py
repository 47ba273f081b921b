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
from matplotlib.patheffects import withStroke

from birdmb.figures.labels import (
    LARGEST_MODULUS,
    as_shown,
    parameter_label,
    quantity_label,
    setting,
)
from birdmb.figures.page import legend_below, new_figure, panels, title
from birdmb.figures.style import LEVEL, LINE, VERDICT_MARKERS
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
# Where it turns (red is unstable, purple negative), and the colours of both sides, above and below.
_MODULUS_TURNS = (1.0, "RdBu_r", "Reds", "Blues_r")
_SIGN_TURNS = (0.0, "PuOr_r", "Oranges", "Purples_r")
_MOST_TICKS = 7
# Of time constants: fast is dark.
_GROWTH, _DECAY = "Reds_r", "Blues_r"
# Marks and lines that are seen on dark cells, too.
_HALO = [withStroke(linewidth=1.6, foreground="w")]
_MARK: dict[str, Any] = {"ls": "", "color": "k", "path_effects": _HALO}
_COMPUTED: dict[str, Any] = {**_MARK, "marker": ".", "markersize": 2.5}
_DECADE = 10.0  # a wider range of time constants is drawn on a logarithmic scale
_FAILED: dict[str, Any] = {"facecolor": "0.9", "edgecolor": "0.5", "hatch": "////", "linewidth": 0}
_BEYOND: dict[str, Any] = {**_MARK, "marker": "x", "markersize": 4.5}
_UNDECIDED: dict[str, Any] = {**_MARK, "marker": "s", "markerfacecolor": "none"}
_BACKWARDS: dict[str, Any] = {"ls": "", "marker": "$<$", "color": "k", "markersize": 7}
_JUMP: dict[str, Any] = {"color": "deeppink", "linewidth": 2.4, "ls": (0, (2, 0.6))}


def plot_sweep(study: xr.Dataset, quantity: str | None, at: Mapping[str, Any]) -> Figure:
    """Draw quantities of a study's dataset; see `Study.plot`."""
    about = in_figure(f"{study.attrs['bird']}, {study.attrs['model']}")
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
    figure = new_figure(5.4 * columns, 4.2 * rows, rows, columns)
    grid = panels(figure, rows, columns, sharex=True, sharey=two)
    for axes, name in zip(grid.ravel(), quantities, strict=True):
        (_draw_map if two else _draw_lines)(axes, plane, name)
        place = axes.get_subplotspec()
        if not place.is_last_row():
            axes.set_xlabel("")
        if two and not place.is_first_col():
            axes.set_ylabel("")
    title(figure, "\n".join([about, *fixed, *verdict_lines(plane)]))
    handles = _legend(plane)
    if handles:
        legend_below(figure, handles)
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
    texts = [setting(str(name), value) for name, value in fixed.items()]
    return plane, [", ".join(texts)] if texts else []


def _places(axes: Axes, along: Literal["x", "y"], coordinate: xr.DataArray) -> np.ndarray:
    """Where the values of a parameter stand on an axis; texts and switches stand side by side."""
    getattr(axes, f"set_{along}label")(parameter_label(str(coordinate.name)))
    axis = axes.xaxis if along == "x" else axes.yaxis
    if coordinate.dtype.kind in "if":
        places = np.asarray(coordinate.values, float)
        axis.set_ticks(_apart(places))
        axis.set_major_formatter("{x:.4g}")
        return places
    places = np.arange(coordinate.size, dtype=float)
    axis.set_ticks(places, [in_figure(str(value)) for value in coordinate.values])
    return places


def _apart(values: np.ndarray) -> list[float]:
    """Values that labels have room at: both ends, and those far enough from the ones before."""
    chosen = [float(values[0])]
    room = (values[-1] - values[0]) / _MOST_TICKS
    for value in values[1:-1]:
        if value - chosen[-1] >= room and values[-1] - value >= room:
            chosen.append(float(value))
    return chosen if values.size == 1 else [*chosen, float(values[-1])]


def _label(study: xr.Dataset, name: str) -> str:
    unit = "s" if name == "seconds" else "°" if name.endswith("_deg") else "1"
    return quantity_label(name, study[name].attrs.get("units", unit).replace("deg", "°"))


def _draw_lines(axes: Axes, study: xr.Dataset, name: str) -> None:
    (parameter,) = study["power"].dims
    x, y = _places(axes, "x", study[parameter]), as_shown(name, study[name].values)
    jump = study["sheet_jump"].sel(along=parameter).values
    ends = jump[: x.size - 1]
    if name == "time_constant":  # without bound where growth turns into decay
        grows = study["largest_modulus"].values > 1
        ends = ends | (grows[1:] != grows[:-1])
    # Where a sheet ends the line does.
    line_x, line_y = (np.insert(a, np.flatnonzero(ends) + 1, np.nan) for a in (x, y))
    axes.plot(line_x, line_y, "-", color=LINE if name != "largest_modulus" else "0.35", lw=1.2)
    for kind, style in VERDICT_MARKERS.items():
        shown = study["stability"].values == kind
        axes.plot(x[shown], y[shown], markersize=4.5, **style)
    backwards = study["flight"].values == "backwards"
    if backwards.any():
        axes.plot(x[backwards], y[backwards], **_BACKWARDS)
    for i in np.flatnonzero(jump):
        axes.axvline(0.5 * (x[i] + x[i + 1]), **_JUMP | {"linewidth": 1.4})
    turn = _turn(name)
    if turn is not None:
        axes.axhline(turn[0], **LEVEL)
    if name == "time_constant" and np.nanmax(y, initial=0.0) > _DECADE * np.nanmin(y, initial=1.0):
        axes.set_yscale("log")
    failed = x[study["status"].values == "failed"]
    axes.plot(
        failed, np.full(failed.size, 0.03), "x", color="0.3", transform=axes.get_xaxis_transform()
    )
    axes.set_ylabel(_label(study, name))
    axes.spines[["top", "right"]].set_visible(False)


def _draw_map(axes: Axes, study: xr.Dataset, name: str) -> None:
    across, up = study["power"].dims
    x, y = _places(axes, "x", study[across]), _places(axes, "y", study[up])
    values = as_shown(name, study[name].transpose(up, across).values)
    modulus = study["largest_modulus"].transpose(up, across).values
    if name == "time_constant":
        _draw_time_constants(axes, x, y, values, modulus)
    else:
        norm, colours = _colours(name, values)
        mesh = axes.pcolormesh(x, y, values, shading="nearest", norm=norm, cmap=colours)
        axes.figure.colorbar(mesh, ax=axes, label=_label(study, name), pad=0.02)
    j, i = np.isfinite(values).nonzero()
    axes.plot(x[i], y[j], **_COMPUTED)
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


def _draw_time_constants(
    axes: Axes, x: np.ndarray, y: np.ndarray, values: np.ndarray, modulus: np.ndarray
) -> None:
    """Draw how fast disturbances grow in other colours than how fast they decay."""
    finite = np.isfinite(values)
    axes.set_title("time constant", fontsize="small")
    every = (
        (finite & (modulus > 1), _GROWTH, "growth", 0.53),
        (finite & (modulus <= 1), _DECAY, "decay", 0.0),
    )
    met = [each for each in every if each[0].any()]
    for part, colours, label, foot in met:
        shown = np.where(part, values, np.nan)
        low, high = np.nanmin(shown), np.nanmax(shown)
        norm = LogNorm(low, high) if high > _DECADE * low else Normalize(low, high)
        mesh = axes.pcolormesh(x, y, shown, shading="nearest", norm=norm, cmap=colours)
        if len(met) == 1:
            axes.figure.colorbar(mesh, ax=axes, label=f"{label} (s)", pad=0.02)
        else:
            beside = axes.inset_axes((1.03, foot, 0.06, 0.47))
            axes.figure.colorbar(mesh, cax=beside).set_label(f"{label} (s)", fontsize="small")


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


def _turn(name: str) -> tuple[float, str, str, str] | None:
    """Where a quantity changes its meaning, with its colours there, above and below."""
    if name == "largest_modulus":
        return _MODULUS_TURNS
    signed = name in BY_NAME and BY_NAME[name].form.startswith("+")
    return _SIGN_TURNS if signed else None


def _colours(name: str, values: np.ndarray) -> tuple[Normalize, str]:
    """Scale and colours; two of them meet where the quantity changes its meaning."""
    turn = _turn(name)
    if turn is None:
        return Normalize(), "viridis"
    low, high = np.nanmin(values, initial=np.inf), np.nanmax(values, initial=-np.inf)
    at, both, above, below = turn
    if low < at < high:
        return TwoSlopeNorm(at), both
    return Normalize(), above if low >= at else below


def _legend(study: xr.Dataset) -> list[Any]:
    handles: list[Any] = []
    modulus, status = study["largest_modulus"].values, study["status"].values
    verdicts = study["stability"].values
    if len(study["power"].dims) == 2:
        handles.append(Line2D([], [], label="computed flight", **_COMPUTED))
        if np.nanmin(modulus, initial=np.inf) < 1 < np.nanmax(modulus, initial=-np.inf):
            boundary = f"stability boundary, {LARGEST_MODULUS} = 1"
            handles.append(Line2D([], [], color="k", lw=1.6, label=boundary))
        if (verdicts == "undecided").any():
            handles.append(Line2D([], [], label="undecided", **_UNDECIDED))
        if (status == "failed").any():
            handles.append(Patch(label="no limit cycle found", **_FAILED))
        if (study["warning"].values != "").any():
            handles.append(Line2D([], [], label="beyond the model's validity", **_BEYOND))
    else:
        for kind, style in VERDICT_MARKERS.items():
            if (verdicts == kind).any():
                handles.append(Line2D([], [], label=kind, **style))
        if (status == "failed").any():
            failed = "no limit cycle found"
            handles.append(Line2D([], [], ls="", marker="x", color="0.3", label=failed))
    if (study["flight"].values == "backwards").any():
        handles.append(Line2D([], [], label="flies backwards", **_BACKWARDS))
    if study["sheet_jump"].values.any():
        handles.append(Line2D([], [], label="neighbours on different flights", **_JUMP))
    return handles
