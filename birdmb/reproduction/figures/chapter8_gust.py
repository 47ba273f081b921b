"""Figure 8.7: what a compliant shoulder takes off a gust."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from birdmb._typing import FloatArray
from birdmb.figures.page import legend_below, new_figure, panels
from birdmb.figures.style import LEVEL, SERIES
from birdmb.models import BirdModel, FlightCycle, GaussianGust, MultibodyModel
from birdmb.models.motion import heading_velocity
from birdmb.orbits import find_limit_cycle
from birdmb.reproduction.chapter8_birds import sprung_flight
from birdmb.reproduction.figures.drawing import Drawing, keep_figure
from birdmb.reproduction.quantities import bird
from birdmb.studies.gust import gust_response
from birdmb.topology import Bird

_GUST = GaussianGust(vertical=1.0)
_BEATS, _SAMPLES = 4, 100
_SPRINGS = ((20.0, 0.2), (10.0, 0.2))


def _firm(one: Bird) -> FlightCycle:
    prescribed = one.with_values({"shoulder.flap.mode": "prescribed"})
    return find_limit_cycle(MultibodyModel(prescribed))


def _figure_8_7(out: Path, coarse: bool) -> None:
    one = bird("ibis_compliant_shoulder")
    if coarse:
        one = one.with_values({"wing.discretisation": 8})
    cycles = {"prescribed flap": _firm(one)}
    for k, c in _SPRINGS:
        cycles[f"k = {k:g}, C = {c:g}"] = sprung_flight(one, k, c)
    figure = new_figure(7.5, 8, rows=4)
    rows = panels(figure, 4, 1, sharex=True, height_ratios=(0.6, 1, 1, 1))[:, 0]
    largest: dict[Axes, list[str]] = {axes: [] for axes in rows[1:]}
    for (label, cycle), style in zip(cycles.items(), SERIES, strict=False):
        time, increments = _increments(cycle)
        for axes, values in zip(rows[1:], increments, strict=True):
            known = bool(np.isfinite(values).any())
            if known:
                axes.plot(time, values, label=label, **style)
            largest[axes].append(f"{np.abs(values).max():.3g}" if known else "none")
    time = np.linspace(0.0, time[-1], 200)
    rows[0].plot(time, [_GUST(float(t))[1] for t in time], "k")
    for axes, label in zip(
        rows,
        ("gust, up\n(m/s)", "Δ lift / weight", "Δ angle of\nattack (°)", "Δ flap (°)"),
        strict=True,
    ):
        axes.set_ylabel(label)
        axes.axhline(0.0, **LEVEL)
        axes.spines[["top", "right"]].set_visible(False)
    for axes, numbers in largest.items():
        text = f"largest: {', '.join(numbers)}"
        axes.set_title(text, loc="right", fontsize="small", pad=2)
    legend_below(figure, about="k in N m/rad, C in N m s/rad")
    rows[-1].set(xlabel="time (s)", xlim=(0.0, time[-1]))
    figure.align_ylabels(rows)
    keep_figure(out, "figure 8.7", figure)


def _increments(cycle: FlightCycle) -> tuple[FloatArray, list[FloatArray]]:
    """Times (s), and what the gust adds: lift per weight, incidence and flap angle (degrees)."""
    flight = gust_response(cycle, _GUST, periods=_BEATS, samples=_SAMPLES)
    times = flight["time"].values
    models = (cycle.model, cycle.model.in_gust(_GUST))
    states = (flight["orbit"].values, flight["states"].values)
    weight = cycle.model.mass * cycle.model.bird.gravity
    found = [
        _lift_and_incidence(model, times, at) for model, at in zip(models, states, strict=True)
    ]
    lift, incidence = (np.subtract(*pair) for pair in zip(*reversed(found), strict=True))
    flap = np.full(times.size, np.nan)
    if "shoulder.flap" in cycle.state_names:
        flap = np.degrees(flight["deviation"].sel(state="shoulder.flap").values)
    return times, [lift / weight, np.degrees(incidence), flap]


def _lift_and_incidence(
    model: BirdModel, times: FloatArray, states: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Upward force of the air (K,) N, and angle of attack (K,) rad averaged over the wing."""
    stack = model.loads_along(times, states).stack
    space = np.array(model.body_in_space(states))
    space[:, :3] = stack.force
    wing = stack.right
    areas = wing.chord * wing.width
    mean = (areas * wing.angle_of_attack).sum(axis=1) / areas.sum(axis=1)
    return heading_velocity(space)[:, 2], np.asarray(mean)


DRAWINGS: Mapping[str, Drawing] = {
    "figure 8.7": Drawing("lift and incidence that a gust adds, firm and sprung", _figure_8_7)
}
