"""Figures of chapter 5 on what changes the limit cycle, and on its Jacobian and validity."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from birdmb._typing import FloatArray
from birdmb.figures.labels import IMAGINARY, LARGEST_MODULUS, MODULUS, REAL, parameter_label
from birdmb.figures.page import (
    is_narrow,
    label_x,
    label_y,
    legend_below,
    new_figure,
    panels,
    parts,
    title,
)
from birdmb.figures.style import LEVEL, LINE, SERIES, families
from birdmb.models import RigidModel
from birdmb.reproduction.chapter5 import margin_study
from birdmb.reproduction.figures.drawing import Drawing, keep_figure
from birdmb.reproduction.quantities import (
    FLAP_AMPLITUDE,
    bird,
    multiplier_moduli,
    published_wing,
    reference_cycle,
)
from birdmb.studies.parameter_study import parameter_study
from birdmb.studies.validity import assess_validity

_LEAST_MARGIN = 0.175  # below which the thesis finds no cycle


def _over_amplitude(coarse: bool) -> xr.Dataset:
    amplitudes = np.linspace(40.0, 46.0, 3 if coarse else 13)
    return parameter_study(published_wing("ibis"), FLAP_AMPLITUDE, amplitudes.tolist())


def amplitude(out: Path, coarse: bool) -> None:
    """Draw forward speed U_ff, climb rate and largest |multiplier| over the flap's amplitude."""
    study = _over_amplitude(coarse)
    over = study[FLAP_AMPLITUDE]
    curves = {
        "$U_{ff}$ (m/s)": study["mean_speed"] * np.cos(study["path_angle"]),
        "climb rate (m/s)": study["mean_climb_rate"],
        LARGEST_MODULUS: multiplier_moduli(study).max(axis=1),
    }
    figure = new_figure(6.5, 6.6, rows=3)
    rows = panels(figure, 3, 1, sharex=True)[:, 0]
    for axes, (label, values) in zip(rows, curves.items(), strict=True):
        axes.plot(over, values, "o-", color=LINE, ms=4)
        axes.set_ylabel(label)
    rows[1].axhline(0.0, **LEVEL)
    rows[-1].set(xlabel=parameter_label(FLAP_AMPLITUDE), ylim=(1.0, 1.5))
    figure.align_ylabels()
    keep_figure(out, "figure 5.10", figure)


def amplitude_locus(out: Path, coarse: bool) -> None:
    """Draw the locus of the multipliers over the flap's amplitude, whole and each by itself."""
    study = _over_amplitude(coarse)
    over = study[FLAP_AMPLITUDE].values
    values = study["multiplier_real"].values + 1j * study["multiplier_imag"].values
    figure = new_figure(11, 4.4, columns=3)
    whole, near = parts(figure, (1, 1.5), (1, 2))
    plane = whole.subplots()
    phase = np.linspace(0.0, 2 * np.pi, 181)
    plane.plot(np.cos(phase), np.sin(phase), color="0.6", lw=1)
    colours = np.broadcast_to(over[:, None], values.shape)
    plane.scatter(values.real, values.imag, c=colours, s=16)
    plane.set(xlabel=REAL, ylabel=IMAGINARY, aspect="equal", xlim=(-1.1, 1.6))
    row = panels(near, 1, 3)[0]
    upper = np.where(values.imag > 0, values, 0.0).sum(axis=1)
    real = values[:, [0, -1]]
    for axes, each, name in zip(row, (real[:, 0], upper, real[:, 1]), "124", strict=True):
        shown = axes.scatter(each.real, each.imag, c=over, s=22)
        axes.set(xlabel=REAL, ylabel=IMAGINARY, title=f"Λ{name}")
        axes.locator_params(nbins=3)
    near.colorbar(
        shown, ax=row, label=parameter_label(FLAP_AMPLITUDE),
        location="bottom" if is_narrow() else "right",
    )  # fmt: skip
    keep_figure(out, "figure 5.11", figure)


def margin(out: Path, coarse: bool) -> None:
    """Draw moduli of the multipliers and speed over the longitudinal margin, on both wings."""
    figure = new_figure(7.5, 6.4, rows=2)
    top, bottom = panels(figure, 2, 1, sharex=True, height_ratios=(1.6, 1))[:, 0]
    for (discretisation, marker), look in zip(
        (("published", "o"), ("converged", "s")), SERIES, strict=False
    ):
        colour = look["color"]
        ibis = published_wing("ibis") if discretisation == "published" else bird("ibis")
        study = margin_study(ibis, 5 if coarse else 41)
        moduli = multiplier_moduli(study)
        valid = study["warning"].values == ""
        over = study["margin"].values
        top.plot(over, moduli, lw=1, **look)
        for where, face in ((valid, colour), (~valid, "w")):
            for axes, values in ((top, moduli), (bottom, study["mean_speed"].values)):
                style = {"color": colour, "markerfacecolor": face, "ms": 4}
                axes.plot(over[where], values[where], marker, **style)
        bottom.plot(over, study["mean_speed"], lw=1, label=f"{discretisation} wing", **look)
        least = int(moduli.max(axis=1).argmin())
        top.plot(over[least], moduli[least].max(), "*", color=colour, ms=12)
    for axes in (top, bottom):
        axes.axvspan(15.0, 100 * _LEAST_MARGIN, color="0.93", zorder=0)
        axes.axvline(33.0, color="0.45", ls=":", lw=1)
    top.axhline(1.0, **LEVEL)
    top.set_ylabel(MODULUS)
    title(
        top,
        "filled: within the model's validity; star: least |Λ₁|; grey: no cycle in the thesis; "
        "dotted: the shipped bird",
        fontsize="small",
    )
    bottom.set(xlabel="longitudinal margin (%)", ylabel="speed (m/s)", ylim=(0, None))
    legend_below(figure)
    figure.align_ylabels()
    keep_figure(out, "figure 5.12", figure)


def jacobians(out: Path, coarse: bool) -> None:
    """Draw the gap of Jacobians by differences from the variational one, and their times."""
    cycle = reference_cycle()
    model = RigidModel(published_wing("ibis"))
    scale, period = model.state_scale, cycle.period
    _, exact = model.flow_jacobian(cycle.x0, 0.0, period)

    def flow(shift: FloatArray) -> FloatArray:
        return model.flow(cycle.x0 + shift, 0.0, period)

    def by_differences(step: float, central: bool) -> FloatArray:
        shifts = np.diag(step * scale)
        before = [flow(-shift) for shift in shifts] if central else 4 * [flow(np.zeros(4))]
        changes = [flow(shift) - other for shift, other in zip(shifts, before, strict=True)]
        return np.column_stack(changes) / (step * scale * (1 + central))

    steps = np.logspace(-10, -1, 4 if coarse else 19)
    figure = new_figure(9.5, 4.2, columns=2)
    gaps, times = panels(figure, 1, 2, width_ratios=(1.6, 1))[0]
    weights = scale / scale[:, None]
    gaps.set_prop_cycle(SERIES)
    for label, central in (("forward differences", False), ("central differences", True)):
        found = [np.abs((by_differences(h, central) - exact) * weights).max() for h in steps]
        gaps.loglog(steps, found, marker="s" if central else "o", ms=4, label=label)
    gaps.set(
        xlabel="step (state scale)",
        ylabel="largest gap from the\nvariational Jacobian (state scale)",
    )
    legend_below(figure)
    ways: Mapping[str, Callable[[], object]] = {
        "variational": lambda: model.flow_jacobian(cycle.x0, 0.0, period),
        "forward": lambda: by_differences(1e-6, False),
        "central": lambda: by_differences(1e-6, True),
    }
    times.bar(list(ways), [1e3 * _seconds(way) for way in ways.values()], color=LINE)
    times.set_xlabel("way of differentiation")
    times.set_ylabel("processor time of a Jacobian (ms)")
    keep_figure(out, "figure 5.13", figure)


def _seconds(work: Callable[[], object]) -> float:
    """Least processor time of some runs, s."""
    best = np.inf
    for _ in range(5):
        began = time.process_time()
        work()
        best = min(best, time.process_time() - began)
    return best


def angles_of_attack(out: Path, _coarse: bool) -> None:
    """Draw the angle of attack of some sections over the beat, geometric and effective."""
    data = assess_validity(reference_cycle()).data
    figure = new_figure(9.5, 4.2, columns=2)
    row = panels(figure, 1, 2, sharex=True, sharey=True)
    for axes, name, about in zip(
        row[0],
        ("angle_of_attack", "effective_angle_of_attack"),
        ("geometric", "effective, with the downwash"),
        strict=True,
    ):
        _draw_sections(axes, data, name)
        axes.set(title=about, xlim=(0, 1))
    label_x(row, "time (beats)")
    label_y(row, "angle of attack (°)")
    legend_below(figure, about="part of the half-span", most=5)
    keep_figure(out, "figure 5.14", figure)


def _draw_sections(axes: Axes, data: xr.Dataset, name: str) -> None:
    beats = data["time"].values / data["time"].values[-1]
    mean_span = data["span_fraction"].mean("time").values
    sections = (0.1, 0.3, 0.5, 0.7, 0.9)
    for part, style in zip(sections, families(len(sections)), strict=True):
        element = int(np.abs(mean_span - part).argmin())
        angle = np.degrees(data[name].isel(element=element))
        axes.plot(beats, angle, label=f"{mean_span[element]:.2f}", **style)
    for limit in (-15, 15):
        axes.axhline(limit, **LEVEL)


DRAWINGS: Mapping[str, Drawing] = {
    "figure 5.10": Drawing("flap amplitude: U_ff, climb rate, largest multiplier", amplitude),
    "figure 5.11": Drawing("locus of the multipliers over the flap amplitude", amplitude_locus),
    "figure 5.12": Drawing("multipliers over the longitudinal margin, both wings", margin),
    "figure 5.13": Drawing("Jacobian by variation and by differences, with times", jacobians),
    "figure 5.14": Drawing("angle of attack of sections over the beat", angles_of_attack),
}
