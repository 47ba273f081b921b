"""What stability costs, drawn from the store of a `tail_study`."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import Normalize, TwoSlopeNorm
from matplotlib.figure import Figure

from birdmb._typing import FloatArray
from birdmb.studies.tail import (
    AMPLITUDE,
    OPENING,
    SWEEP,
    StabilityOpening,
    pareto_front,
    within_rules,
)
from birdmb.text import in_figure

_PANELS = 4
_SPEED_BINS = 0.25  # m/s


def plot_manifold(data: xr.Dataset) -> Figure:
    """Draw cost of transport and |Lambda|max of level flights over opening and flap amplitude.

    For up to four offsets of the sweep; grey where there is no level flight, hatched where the
    rules of the thesis exclude it.
    """
    chosen = data[SWEEP].values[_spread(data.sizes[SWEEP], _PANELS)]
    figure = Figure(figsize=(3 + 2.6 * chosen.size, 6.2), layout="constrained")
    rows = figure.subplots(2, chosen.size, sharex=True, sharey=True, squeeze=False)
    allowed = within_rules(data)
    modulus = data["largest_modulus"]
    quantities = (
        ("cost of transport", data["cost_of_transport"], "viridis", _norm(data, allowed)),
        ("|Λ|max", modulus, "RdBu_r", TwoSlopeNorm(1.0, 0.9, 1.4)),
    )
    for row, (name, values, colours, norm) in zip(rows, quantities, strict=True):
        for axes, offset in zip(row, chosen, strict=True):
            at = {SWEEP: offset}
            mesh = axes.pcolormesh(
                data[OPENING],
                data[AMPLITUDE],
                values.sel(at).transpose(AMPLITUDE, OPENING),
                cmap=colours,
                norm=norm,
                shading="nearest",
            )
            _exclude(axes, data, ~allowed.sel(at) & np.isfinite(modulus.sel(at)))
            axes.set_facecolor("0.85")
            if name is quantities[0][0]:
                axes.set_title(f"sweep offset {offset:g}°".replace("-", "−"), fontsize="medium")
        row[0].set_ylabel("flap amplitude (°)")
        figure.colorbar(mesh, ax=row.tolist(), label=name, extend="both")
    for axes in rows[-1]:
        axes.set_xlabel("tail opening (°)")
    figure.suptitle(
        f"{in_figure(data.attrs['bird'])}: level flights (grey: none; hatched: excluded)",
        fontsize="medium",
    )
    return figure


def _norm(data: xr.Dataset, allowed: xr.DataArray) -> Normalize:
    cost = data["cost_of_transport"].where(allowed).values
    known = cost[np.isfinite(cost)]
    return Normalize(*np.percentile(known, [1, 99])) if known.size else Normalize(0, 1)


def _exclude(axes: Axes, data: xr.Dataset, excluded: xr.DataArray) -> None:
    if not excluded.values.any():
        return
    axes.contourf(
        data[OPENING],
        data[AMPLITUDE],
        excluded.transpose(AMPLITUDE, OPENING).values.astype(float),
        levels=[0.5, 1.5],
        colors="none",
        hatches=["////"],
    )


def plot_envelope(data: xr.Dataset, openings: Sequence[float] | None = None) -> Figure:
    """Draw the least cost of transport at each speed, for four openings of the tail."""
    figure = Figure(figsize=(6.5, 4.5), layout="constrained")
    axes = figure.subplots()
    everywhere = data[OPENING].values
    chosen = everywhere[_spread(everywhere.size, _PANELS)] if openings is None else openings
    kept = data.where(within_rules(data))
    colours = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.85, len(chosen)))
    for opening, colour in zip(chosen, colours, strict=True):
        at = kept.sel({OPENING: opening}, method="nearest")
        speed, cost = at["mean_speed"].values.ravel(), at["cost_of_transport"].values.ravel()
        axes.plot(speed, cost, ".", color=colour, ms=3, alpha=0.35)
        axes.plot(*_lower_envelope(speed, cost), color=colour, lw=1.8, label=f"{opening:g}°")
    axes.set(xlabel="speed of level flight (m/s)", ylabel="cost of transport")
    axes.legend(title="tail opening", frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_title(f"{in_figure(data.attrs['bird'])}: least cost at each speed", fontsize="medium")
    return figure


def _lower_envelope(speed: FloatArray, cost: FloatArray) -> tuple[FloatArray, FloatArray]:
    known = np.isfinite(speed) & np.isfinite(cost)
    speed, cost = speed[known], cost[known]
    places = np.floor(speed / _SPEED_BINS)
    lowest = [np.flatnonzero(places == p)[np.argmin(cost[places == p])] for p in np.unique(places)]
    return speed[lowest], cost[lowest]


def plot_pareto(data: xr.Dataset) -> Figure:
    """Draw |Lambda|max over cost of transport, and the flights that none beats in both."""
    figure = Figure(figsize=(6.5, 4.5), layout="constrained")
    axes = figure.subplots()
    allowed = within_rules(data)
    cost = data["cost_of_transport"].where(allowed)
    modulus = data["largest_modulus"].where(allowed)
    opening = data[OPENING].broadcast_like(cost).transpose(*cost.dims)
    points = axes.scatter(
        cost.values.ravel(),
        modulus.values.ravel(),
        c=opening.values.ravel(),
        s=6,
        cmap="viridis",
        linewidths=0,
    )
    front = pareto_front(cost.values.ravel(), modulus.values.ravel())
    axes.plot(
        cost.values.ravel()[front],
        modulus.values.ravel()[front],
        "-o",
        color="tab:red",
        ms=3,
        lw=1.2,
        label="Pareto front",
    )
    axes.axhline(1.0, color="0.4", lw=0.8, ls="--")
    figure.colorbar(points, ax=axes, label="tail opening (°)")
    axes.set(xlabel="cost of transport", ylabel="|Λ|max")
    axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_title(f"{in_figure(data.attrs['bird'])}: what stability costs", fontsize="medium")
    return figure


def plot_stability_openings(found: Sequence[StabilityOpening], name: str) -> Figure:
    """Draw the openings at which level flight becomes stable over the flap amplitude."""
    figure = Figure(figsize=(6.5, 4.5), layout="constrained")
    axes = figure.subplots()
    colours = matplotlib.colormaps["plasma"](np.linspace(0.0, 0.85, max(len(found), 1)))
    for each, colour in zip(found, colours, strict=True):
        label = f"{each.sweep:g}°".replace("-", "−")
        for curve in each.curves:
            axes.plot(*curve.points.T, color=colour, lw=1.6, label=label)
            label = ""
    axes.set(xlabel="flap amplitude (°)", ylabel="tail opening at |Λ|max = 1 (°)")
    axes.legend(title="sweep offset", frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_title(f"{in_figure(name)}: stable above the lines", fontsize="medium")
    return figure


def _spread(size: int, most: int) -> list[int]:
    """Positions of up to so many entries, from the first to the last, as evenly as can be."""
    return sorted({round(p) for p in np.linspace(0, size - 1, min(size, most))})
