"""Figures of chapter 5 on the limit cycle of the reference gait: search, portraits, loads."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from birdmb.figures.page import axes_in_space, legend_below, new_figure, panels, title
from birdmb.figures.style import BLUE, LEVEL, SERIES, VERMILION
from birdmb.models import FlightCycle, RigidModel
from birdmb.orbits import find_limit_cycle
from birdmb.reproduction.figures.drawing import Drawing, keep_figure
from birdmb.reproduction.quantities import (
    STATES,
    multiplier_moduli,
    published_wing,
    reference_cycle,
)
from birdmb.studies.perturbed import perturbed_flight
from birdmb.studies.tunnel import tunnel_and_free_flight

_LABELS = {"u": "u (m/s)", "w": "w (m/s)", "q": "q (°/s)", "theta": "θ (°)"}
_SCALES = np.array([1.0, 1.0, np.degrees(1.0), np.degrees(1.0)])
_SHOOTING_POINTS = 10


def convergence(out: Path, coarse: bool) -> None:
    """Draw the closure error over the iterations of shooting with some numbers of segments."""
    figure = new_figure(6.5, 4.4)
    axes = figure.subplots()
    axes.set_prop_cycle(SERIES)
    for segments, marker in zip((1, 4) if coarse else (1, 2, 5, 10), "o^sD", strict=False):
        cycle = find_limit_cycle(
            RigidModel(published_wing("ibis")),
            [14.0, 0.0, 0.0, 0.0],
            method="shooting",
            segments=segments,
            damping="levenberg-marquardt",
            tolerance=1e-9,
        )
        errors = [step.residual for step in cycle.iterations]
        label = "1 segment" if segments == 1 else f"{segments} segments"
        axes.semilogy(range(len(errors)), errors, marker=marker, ms=4, label=label)
    axes.set(xlabel="iteration", ylabel="closure error (state scale)")
    legend_below(figure)
    title(axes, "from u = 14 m/s, w = q = θ = 0")
    keep_figure(out, "figure 5.3", figure)


def _portrait(axes: Axes, cycle: FlightCycle, pair: tuple[str, str]) -> None:
    """Draw the cycle in the plane of two states, its shooting points and its direction."""
    at = [STATES.index(name) for name in pair]
    path = (_SCALES * cycle.trajectory().states)[:, at]
    times = cycle.start_time + cycle.period * np.arange(_SHOOTING_POINTS) / _SHOOTING_POINTS
    points = (_SCALES * cycle.trajectory(times).states)[:, at]
    axes.plot(*path.T, color=BLUE)
    axes.plot(*points.T, "o", color=VERMILION, ms=4, label="shooting points")
    axes.plot(*points[0], "s", color="k", ms=5, label="t = 0, mid-downstroke")
    axes.annotate("", path[3], path[0], arrowprops={"arrowstyle": "->", "color": BLUE})
    axes.set(xlabel=_LABELS[pair[0]], ylabel=_LABELS[pair[1]])


def portrait(pair: tuple[str, str], name: str, out: Path, _coarse: bool) -> None:
    """Draw the limit cycle in the plane of two states."""
    figure = new_figure(5.4, 4.4)
    axes = figure.subplots()
    _portrait(axes, reference_cycle(), pair)
    legend_below(figure)
    keep_figure(out, name, figure)


def portrait_in_space(out: Path, _coarse: bool) -> None:
    """Draw the limit cycle in the space of u, w and θ."""
    cycle = reference_cycle()
    figure = new_figure(6.2, 5.4)
    axes = axes_in_space(figure)
    path = _SCALES * cycle.trajectory().states
    axes.plot(path[:, 0], path[:, 1], path[:, 3], color=BLUE)
    axes.plot(*(_SCALES * cycle.x0)[[0, 1, 3]], "ks", ms=5, label="t = 0, mid-downstroke")
    axes.set(xlabel=_LABELS["u"], ylabel=_LABELS["w"], zlabel=_LABELS["theta"])
    axes.locator_params(nbins=4)
    legend_below(figure)
    keep_figure(out, "figure 5.6", figure)


def loads_over_weight(out: Path, _coarse: bool) -> None:
    """Draw the force of the air along the limit cycle in world axes, over the weight."""
    data = tunnel_and_free_flight(reference_cycle()).sel(mount="free")
    beats = data["time"] / data["time"].values[-1]
    figure = new_figure(6.5, 4.4)
    axes = figure.subplots()
    for (name, label), style in zip(
        (("lift", "vertical, upwards"), ("thrust", "horizontal, forwards")), SERIES, strict=False
    ):
        values = data[name] / data.attrs["weight"]
        mean = round(float(values[:-1].mean()), 3) + 0.0
        axes.plot(beats, values, label=f"{label}, mean {mean:.3f}", **style)
    axes.axhline(1.0, **LEVEL)
    axes.axhline(0.0, **LEVEL)
    axes.set(xlabel="time (beats)", ylabel="force / weight", xlim=(0, 1))
    legend_below(figure)
    keep_figure(out, "figure 5.7", figure)


def _scaled(states: xr.DataArray, name: str) -> xr.DataArray:
    """A state in the unit of its label."""
    return float(_SCALES[STATES.index(name)]) * states.sel(state=name)


def _after_a_disturbance(axes: Axes, flight: xr.Dataset, pair: tuple[str, str]) -> None:
    first, second = (_scaled(flight["states"], name) for name in pair)
    axes.plot(first, second, color=VERMILION, lw=1, ls=(0, (4, 1.5)), label="disturbed")
    axes.plot(first[0], second[0], "o", color=VERMILION, ms=4)
    cycle = [_scaled(flight["orbit"], name) for name in pair]
    axes.plot(*cycle, color=BLUE, lw=2, label="limit cycle")
    axes.set(xlabel=_LABELS[pair[0]], ylabel=_LABELS[pair[1]])


def disturbed(stable: bool, name: str, out: Path, coarse: bool) -> None:
    """Draw the flight after a disturbance along the unstable mode, or along the slowest stable."""
    cycle = reference_cycle()
    periods = 2 if coarse else 10 if stable else 4
    flights = perturbed_flight(cycle, amplitude=0.05, periods=periods, samples=60)
    moduli = multiplier_moduli(flights)
    flight = flights.isel(mode=int((moduli < 1).argmax() if stable else moduli.argmax()))
    figure = new_figure(9.5, 4.4, columns=2)
    left, right = panels(figure, 1, 2)[0]
    _after_a_disturbance(left, flight, ("u", "w"))
    _after_a_disturbance(right, flight, ("theta", "q"))
    legend_below(figure)
    real, imag = float(flight["multiplier_real"]), float(flight["multiplier_imag"])
    value = f"{real:.3f}" + (f" ± {imag:.3f} i" if imag else "")
    title(figure, f"{periods} beats after a disturbance along Λ = {value}")
    keep_figure(out, name, figure)


DRAWINGS: Mapping[str, Drawing] = {
    "figure 5.3": Drawing("convergence of shooting on the limit cycle", convergence),
    "figure 5.4": Drawing(
        "limit cycle in the plane of u and w", partial(portrait, ("u", "w"), "figure 5.4")
    ),
    "figure 5.5": Drawing(
        "limit cycle in the plane of θ and q", partial(portrait, ("theta", "q"), "figure 5.5")
    ),
    "figure 5.6": Drawing("limit cycle in the space of u, w and θ", portrait_in_space),
    "figure 5.7": Drawing("force over weight along the limit cycle, world axes", loads_over_weight),
    "figure 5.8": Drawing(
        "flight after a disturbance along the unstable mode",
        partial(disturbed, False, "figure 5.8"),
    ),
    "figure 5.9": Drawing(
        "flight after a disturbance along a stable mode", partial(disturbed, True, "figure 5.9")
    ),
}
