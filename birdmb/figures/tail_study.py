"""What stability costs, drawn from the store of a `tail_study`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import Normalize, TwoSlopeNorm
from matplotlib.figure import Figure

from birdmb._typing import FloatArray
from birdmb.figures.sweep import parameter_label
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
    figure = Figure(figsize=(3 + 2.6 * len(chosen), 6.2), layout="constrained")
    rows = figure.subplots(2, len(chosen), sharex=True, sharey=True, squeeze=False)
    allowed = within_limits(data, limits)
    modulus = data["largest_modulus"]
    quantities = (
        ("cost of transport", data["cost_of_transport"], "viridis", _norm(data, allowed)),
        ("|Λ|max", modulus, "RdBu_r", TwoSlopeNorm(1.0, 0.9, 1.4)),
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
            if name is quantities[0][0]:
                axes.set_title(_settings(at), fontsize="medium")
        row[0].set_ylabel(parameter_label(gait))
        figure.colorbar(mesh, ax=row.tolist(), label=name, extend="both")
    for axes in rows[-1]:
        axes.set_xlabel("tail opening (°)")
    figure.suptitle(
        f"{in_figure(data.attrs['bird'])}: level flights (grey: none; hatched: excluded)",
        fontsize="medium",
    )
    return figure


def _settings(at: Mapping[str, float]) -> str:
    """Values of parameters, for a title."""
    texts = [
        f"{in_figure(name.removesuffix('_deg'))} {value:.4g}{'°' if name.endswith('_deg') else ''}"
        for name, value in at.items()
    ]
    return ", ".join(texts).replace("-", "−")


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
    figure = Figure(figsize=(6.5, 4.5), layout="constrained")
    axes = figure.subplots()
    everywhere = data[OPENING].values
    chosen = everywhere[_spread(everywhere.size, _PANELS)] if openings is None else openings
    kept = data.where(within_limits(data, limits))
    colours = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.85, len(chosen)))
    for opening, colour in zip(chosen, colours, strict=True):
        at = kept.sel({OPENING: opening}, method="nearest")
        speed, cost = at["mean_speed"].values.ravel(), at["cost_of_transport"].values.ravel()
        axes.plot(speed, cost, ".", color=colour, ms=3, alpha=0.35)
        if np.isfinite(speed).any():
            speeds = np.arange(np.nanmin(speed), np.nanmax(speed), _SPEED_STEP)
            least = least_costs(data.sel({OPENING: [at[OPENING]]}), speeds.tolist(), limits=limits)
            axes.plot(speeds, least, color=colour, lw=1.8, label=f"{opening:g}°")
    axes.set(xlabel="speed of level flight (m/s)", ylabel="cost of transport")
    axes.legend(title="tail opening", frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_title(f"{in_figure(data.attrs['bird'])}: least cost at each speed", fontsize="medium")
    return figure


def plot_pareto(data: xr.Dataset, limits: Mapping[str, float] = VALID) -> Figure:
    """Draw |Lambda|max over cost of transport, and the flights that none beats in both.

    All flights within the limits on the left, on the right the front alone.
    """
    figure = Figure(figsize=(11, 4.5), layout="constrained")
    whole, near = figure.subplots(1, 2)
    allowed = within_limits(data, limits)
    of_all = data["cost_of_transport"]
    cost = of_all.where(allowed).values.ravel()
    modulus = data["largest_modulus"].where(allowed).values.ravel()
    opening = data[OPENING].broadcast_like(of_all).transpose(*of_all.dims).values.ravel()
    front = pareto_front(cost, modulus)
    for axes, size in ((whole, 6), (near, 14)):
        points = axes.scatter(cost, modulus, c=opening, s=size, cmap="viridis", linewidths=0)
        axes.plot(
            cost[front], modulus[front], "-o", color="tab:red", ms=3, lw=1.2, label="Pareto front"
        )
        axes.axhline(1.0, color="0.4", lw=0.8, ls="--")
        axes.set(xlabel="cost of transport", ylabel="|Λ|max")
        axes.spines[["top", "right"]].set_visible(False)
    if front.size > 1:
        near.set_xlim(*_around(cost[front]))
        near.set_ylim(*_around(modulus[front]))
    figure.colorbar(points, ax=near, label="tail opening (°)")
    whole.legend(frameon=False)
    near.set_title("near the front", fontsize="medium")
    figure.suptitle(f"{in_figure(data.attrs['bird'])}: what stability costs", fontsize="medium")
    return figure


def _around(values: FloatArray) -> tuple[float, float]:
    low, high = float(values.min()), float(values.max())
    margin = _MARGIN * (high - low)
    return low - margin, high + margin


def plot_stability_openings(found: Sequence[StabilityOpening], name: str) -> Figure:
    """Draw the openings at which level flight becomes stable over a parameter of the gait."""
    figure = Figure(figsize=(6.5, 4.5), layout="constrained")
    axes = figure.subplots()
    colours = matplotlib.colormaps["plasma"](np.linspace(0.0, 0.85, max(len(found), 1)))
    for each, colour in zip(found, colours, strict=True):
        label = _settings({each.at: each.value}) if each.at else ""
        for curve in each.curves:
            axes.plot(*curve.points.T, color=colour, lw=1.6, label=label)
            label = ""
    if found:
        axes.set_xlabel(parameter_label(found[0].across))
    axes.set_ylabel("tail opening at |Λ|max = 1 (°)")
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_title(f"{in_figure(name)}: stable above the lines", fontsize="medium")
    return figure


def _spread(size: int, most: int) -> list[int]:
    """Positions of up to so many entries, from the first to the last, as evenly as can be."""
    return sorted({round(p) for p in np.linspace(0, size - 1, min(size, most))})
