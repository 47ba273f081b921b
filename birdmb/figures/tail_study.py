"""What stability costs, drawn from the store of a `tail_study`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import Normalize, TwoSlopeNorm
from matplotlib.figure import Figure

from birdmb._typing import FloatArray
from birdmb.figures.labels import LARGEST_MODULUS, parameter_label, setting
from birdmb.figures.page import is_narrow, label_x, label_y, legend_below, new_figure, panels, title
from birdmb.figures.style import LEVEL, VERMILION, families
from birdmb.studies.stability_opening import StabilityOpening
from birdmb.studies.tail import OPENING, VALID, gait_parameters, pareto_front, within_limits
from birdmb.studies.tail_price import least_costs
from birdmb.text import in_figure

_PANELS = 4
_SPEED_STEP = 0.1  # m/s
_MARGIN = 0.08  # of the Pareto front's extent, around it


def plot_manifold(data: xr.Dataset, limits: Mapping[str, float] = VALID) -> Figure:
    """Draw cost of transport and |Lambda|max of level flights over the tail's opening and a gait.

    For up to four values of the parameter of the gait that was named first, where there are two;
    grey where there is no level flight, hatched beyond the limits (as of `within_limits`).
    """
    *others, gait = gait_parameters(data)
    chosen: list[dict[str, Any]] = [{}]
    for name in others:
        offered = np.sort(data[name].values)
        chosen = [{name: float(offered[i])} for i in _spread(offered.size, _PANELS)]
    figure = new_figure(3 + 2.6 * len(chosen), 6.2, rows=2, columns=len(chosen))
    rows = panels(figure, 2, len(chosen), sharex=True, sharey=True)
    allowed = within_limits(data, limits)
    modulus = data["largest_modulus"]
    quantities = (
        ("cost of transport", data["cost_of_transport"], "viridis", _norm(data, allowed)),
        (LARGEST_MODULUS, modulus, "RdBu_r", TwoSlopeNorm(1.0, 0.9, 1.4)),
    )
    for row, (name, values, colours, norm) in zip(rows, quantities, strict=True):
        for axes, at in zip(row, chosen, strict=True):
            mesh = axes.pcolormesh(
                data[OPENING],
                data[gait],
                values.sel(at).transpose(gait, OPENING),
                cmap=colours,
                norm=norm,
                shading="nearest",
            )
            _exclude(axes, data, gait, ~allowed.sel(at) & np.isfinite(modulus.sel(at)))
            axes.set_facecolor("0.85")
            _mark(axes, data, gait, modulus.sel(at))
            if name is quantities[0][0] or is_narrow():
                title(axes, _settings(at))
        figure.colorbar(mesh, ax=row.tolist(), label=name, extend="both")
    label_x(rows, parameter_label(OPENING))
    label_y(rows, parameter_label(gait))
    title(
        figure,
        f"{in_figure(data.attrs['bird'])}: level flights (dots; grey: none; hatched: excluded; "
        f"line: {LARGEST_MODULUS} = 1)",
    )
    return figure


def _settings(at: Mapping[str, float]) -> str:
    """Values of parameters, for a title."""
    return ", ".join(setting(name, value) for name, value in at.items())


def _mark(axes: Axes, data: xr.Dataset, gait: str, modulus: xr.DataArray) -> None:
    """Mark the computed flights, and draw the boundary of stability."""
    at = modulus.transpose(gait, OPENING).values
    j, i = np.isfinite(at).nonzero()
    axes.plot(data[OPENING].values[i], data[gait].values[j], ls="", marker=".", color="k", ms=1)
    if np.nanmin(at, initial=np.inf) < 1 < np.nanmax(at, initial=-np.inf):
        axes.contour(data[OPENING], data[gait], at, levels=[1.0], colors="k", linewidths=1.4)


def _norm(data: xr.Dataset, allowed: xr.DataArray) -> Normalize:
    cost = data["cost_of_transport"].where(allowed).values
    known = cost[np.isfinite(cost)]
    return Normalize(*np.percentile(known, [1, 99])) if known.size else Normalize(0, 1)


def _exclude(axes: Axes, data: xr.Dataset, gait: str, excluded: xr.DataArray) -> None:
    if not excluded.values.any():
        return
    axes.contourf(
        data[OPENING],
        data[gait],
        excluded.transpose(gait, OPENING).values.astype(float),
        levels=[0.5, 1.5],
        colors="none",
        hatches=["////"],
    )


def plot_envelope(
    data: xr.Dataset,
    openings: Sequence[float] | None = None,
    limits: Mapping[str, float] = VALID,
) -> Figure:
    """Draw the least cost of transport at each speed, for four openings of the tail."""
    figure = new_figure(6.5, 4.5)
    axes = figure.subplots()
    everywhere = data[OPENING].values
    chosen = everywhere[_spread(everywhere.size, _PANELS)] if openings is None else openings
    kept = data.where(within_limits(data, limits))
    for opening, style in zip(chosen, families(len(chosen)), strict=True):
        at = kept.sel({OPENING: opening}, method="nearest")
        speed, cost = at["mean_speed"].values.ravel(), at["cost_of_transport"].values.ravel()
        axes.plot(speed, cost, ".", color=style["color"], ms=3, alpha=0.35)
        if np.isfinite(speed).any():
            speeds = np.arange(np.nanmin(speed), np.nanmax(speed), _SPEED_STEP)
            least = least_costs(data.sel({OPENING: [at[OPENING]]}), speeds.tolist(), limits=limits)
            axes.plot(speeds, least, lw=1.8, label=f"{opening:g}°", **style)
    axes.set(xlabel="speed of level flight (m/s)", ylabel="cost of transport")
    legend_below(figure, about="tail opening", most=4)
    axes.spines[["top", "right"]].set_visible(False)
    title(axes, f"{in_figure(data.attrs['bird'])}: least cost at each speed (dots: all flights)")
    return figure


def plot_pareto(data: xr.Dataset, limits: Mapping[str, float] = VALID) -> Figure:
    """Draw |Lambda|max over cost of transport, and the flights that none beats in both.

    All flights within the limits on the left, on the right the front alone.
    """
    figure = new_figure(11, 4.5, columns=2)
    whole, near = panels(figure, 1, 2)[0]
    allowed = within_limits(data, limits)
    of_all = data["cost_of_transport"]
    cost = of_all.where(allowed).values.ravel()
    modulus = data["largest_modulus"].where(allowed).values.ravel()
    opening = data[OPENING].broadcast_like(of_all).transpose(*of_all.dims).values.ravel()
    front = pareto_front(cost, modulus)
    for axes, size in ((whole, 6), (near, 14)):
        points = axes.scatter(cost, modulus, c=opening, s=size, cmap="viridis", linewidths=0)
        axes.plot(
            cost[front], modulus[front], "-o", color=VERMILION, ms=3, lw=1.2, label="Pareto front"
        )
        axes.axhline(1.0, **LEVEL)
        axes.set(xlabel="cost of transport", ylabel=LARGEST_MODULUS)
        axes.locator_params(axis="x", nbins=5)
        axes.spines[["top", "right"]].set_visible(False)
    if front.size > 1:
        near.set_xlim(*_around(cost[front]))
        near.set_ylim(*_around(modulus[front]))
    figure.colorbar(points, ax=near, label=parameter_label(OPENING))
    legend_below(figure)
    title(near, "near the front")
    title(figure, f"{in_figure(data.attrs['bird'])}: what stability costs")
    return figure


def _around(values: FloatArray) -> tuple[float, float]:
    low, high = float(values.min()), float(values.max())
    margin = _MARGIN * (high - low)
    return low - margin, high + margin


def plot_stability_openings(found: Sequence[StabilityOpening], name: str) -> Figure:
    """Draw the openings at which level flight becomes stable over a parameter of the gait."""
    figure = new_figure(6.5, 4.5)
    axes = figure.subplots()
    for each, style in zip(found, families(len(found)), strict=False):
        label = _settings({each.at: each.value}) if each.at else ""
        for curve in each.curves:
            axes.plot(*curve.points.T, lw=1.6, label=label, **style)
            label = ""
    if found:
        axes.set_xlabel(parameter_label(found[0].across))
    axes.set_ylabel(f"tail opening at {LARGEST_MODULUS} = 1 (°)")
    if axes.get_legend_handles_labels()[0]:
        legend_below(figure)
    axes.spines[["top", "right"]].set_visible(False)
    title(axes, f"{in_figure(name)}: stable above the lines")
    return figure


def _spread(size: int, most: int) -> list[int]:
    """Positions of up to so many entries, from the first to the last, as evenly as can be."""
    return sorted({round(p) for p in np.linspace(0, size - 1, min(size, most))})
