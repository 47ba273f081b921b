"""The program against measurements: `python examples/studies/validation.py [DIR] [--coarse]`.

Prints the numbers of docs/validation.md and saves its figures in DIR (default results/): of all
cases, or of the letters that follow, as in `python examples/studies/validation.py results A B`.
"""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import birdmb
from birdmb.studies.experiments import derivatives, jackdaw, scherer, section, sprung_plate, yeo
from birdmb.studies.experiments.cases import experiments
from birdmb.studies.experiments.comparison import (
    ATTACHED,
    CHOICES,
    MODELS,
    QUASI_STEADY,
    UNSTEADY,
    WITH_APPARENT_MASS,
    Comparison,
)
from birdmb.studies.experiments.thin_airfoil import OscillatingSection, wagner_function
from birdmb.studies.flight_regime import wake_deficiency

STYLES = {
    QUASI_STEADY: {"color": "0.45", "ls": "--"},
    WITH_APPARENT_MASS: {"color": "tab:orange", "ls": "-."},
    UNSTEADY: {"color": "tab:blue", "ls": "-"},
}
MEASURED = {"color": "black", "ls": "none", "marker": "o", "ms": 4}
EXACT = {"color": "black", "lw": 1.0}


def new_figure(width: float, columns: int) -> tuple[Figure, list[Axes]]:
    figure = Figure(figsize=(width, 3.6), layout="constrained")
    axes = list(np.atleast_1d(figure.subplots(1, columns)))
    for each in axes:
        each.spines[["top", "right"]].set_visible(False)
    return figure, axes


def scherers_wing(_: list[Comparison]) -> Figure:
    figure, panels = new_figure(9.0, 2)
    leads = np.arange(0.0, 121.0, 7.5)
    for axes, pitch in zip(panels, (15.0, 25.0), strict=True):
        for name, choice in CHOICES.items():
            thrust = scherer.thrust_coefficients(leads, choice, pitch)
            attached = {"label": ATTACHED, "ls": ":"} if name == UNSTEADY else {"label": name}
            axes.plot(leads, thrust, **{**STYLES[name], **attached})
        thrust = scherer.thrust_coefficients(leads, CHOICES[UNSTEADY], pitch, scherer.STALL)
        axes.plot(leads, thrust, label="unsteady, with stall", **STYLES[UNSTEADY])
        axes.set(title=f"pitch {pitch:g}°", xlabel="pitch ahead of heave (deg)", ylim=(0.0, 0.6))
    at, markers = np.transpose(scherer.MARKERS)
    panels[0].errorbar(at, markers, scherer.ERROR_BAR, label="measured", **MEASURED)
    panels[0].set_ylabel("mean thrust coefficient")
    entries = panels[0].get_legend_handles_labels()
    figure.legend(
        *entries, loc="outside lower center", frameon=False, fontsize="small", ncols=len(entries[0])
    )
    return figure


def yeos_wing(_: list[Comparison]) -> Figure:
    figure, (axes,) = new_figure(6.5, 1)
    phases = np.arange(len(yeo.LIFT)) / len(yeo.LIFT)
    axes.axhline(0.0, color="0.8", lw=0.8)
    axes.plot(phases, yeo.LIFT, label="measured", **MEASURED | {"ms": 2.5})
    for name, choice in CHOICES.items():
        attached = {"label": ATTACHED, "ls": ":"} if name == UNSTEADY else {"label": name}
        axes.plot(phases, 1e3 * yeo.computed_lift(choice), **{**STYLES[name], **attached})
    stalled = 1e3 * yeo.computed_lift(CHOICES[UNSTEADY], stall=yeo.STALL)
    axes.plot(phases, stalled, label="unsteady, with stall", **STYLES[UNSTEADY])
    axes.set(xlabel="t/T", ylabel="lift of both wings (mN)", xlim=(0.0, 1.0))
    axes.legend(frameon=False, fontsize="small")
    return figure


def sections_and_starts(_: list[Comparison]) -> Figure:
    figure, (deficiency, thrust, start) = new_figure(11.0, 3)
    k = np.linspace(0.02, 0.6, 30)
    exact = np.array([wake_deficiency(one) for one in k])
    deficiency.plot(exact.real, exact.imag, label="Theodorsen", **EXACT)
    found = []
    for one in k:
        section_of = OscillatingSection(one, 1.0, 0.0, section.AXIS)
        without = {"wake": "unsteady", "apparent_mass": False}
        lift = section.lift_amplitude(
            section.oscillating_loads(one, 1.0, 0.0, section.AXIS, without)
        )
        found.append(lift / (2.0 * np.pi * section_of.downwash))
    deficiency.plot(np.real(found), np.imag(found), label="here", **STYLES[UNSTEADY])
    deficiency.set(xlabel="Re C(k)", ylabel="Im C(k)", title="k = 0.02 (right) to 0.6")
    deficiency.legend(frameon=False, fontsize="small")
    for name, (heave, pitch) in section.MOTIONS.items():
        exact = [OscillatingSection(one, heave, pitch, section.AXIS).thrust for one in k]
        thrust.plot(k, exact, **EXACT)
        for model in (QUASI_STEADY, UNSTEADY):
            loads = [
                section.oscillating_loads(one, heave, pitch, section.AXIS, CHOICES[model])
                for one in k
            ]
            values = [one.mean_thrust_coefficient / section.SMALL**2 for one in loads]
            thrust.plot(k, values, **STYLES[model])
        thrust.annotate(name.split()[0], (k[-1], exact[-1]), xytext=(-60, 8),
                        textcoords="offset points", fontsize="small")  # fmt: skip
    thrust.set(xlabel="k", ylabel="mean thrust coefficient", title="black: Garrick")
    half_chords = np.linspace(0.1, 15.0, 60)
    wings = {"section": section.SECTION} | {
        f"aspect ratio {ratio:g}": birdmb.PlaneWing.elliptic(2.0, ratio) for ratio in (6.0, 3.0)
    }
    for name, wing in wings.items():
        lift = section.growing_lift(wing, half_chords, CHOICES[UNSTEADY])
        (line,) = start.plot(half_chords, lift, label=name)
        if name == "section":
            known = np.array([wagner_function(s) for s in half_chords])
        else:
            share, rate = section.ELLIPTIC[float(name.split()[-1])]
            known = 1.0 - share * np.exp(-rate * half_chords)
        start.plot(half_chords, known, color=line.get_color(), ls=":")
    start.set(xlabel="half chords after a start", ylabel="lift over final lift",
              title="dotted: Wagner, Jones")  # fmt: skip
    start.legend(frameon=False, fontsize="small", loc="lower right")
    return figure


def sprung_plates(_: list[Comparison]) -> Figure:
    figure, panels = new_figure(11.0, 3)
    k = np.linspace(0.05, 0.8, 26)
    looks = (("tab:blue", "o"), ("tab:orange", "^"), ("tab:green", "s"))
    for plate, (colour, mark) in zip(sprung_plate.PLATES, looks, strict=True):
        exact = [sprung_plate.exact_motion(plate, one) for one in k]
        lines = [(exact, "-")]
        for model, style in ((QUASI_STEADY, "--"), (UNSTEADY, mark)):
            every = k if model == QUASI_STEADY else k[::3]
            lines.append(
                ([sprung_plate.computed_motion(plate, one, CHOICES[model]) for one in every], style)
            )
        label = f"inertia {plate.inertia:g}, stiffness {plate.stiffness:g}"
        for motions, style in lines:
            at = k[:: 3 if len(motions) < len(k) else 1]
            pitch = np.array([one.pitch for one in motions])
            values = (abs(pitch), np.degrees(np.angle(pitch)), [one.thrust for one in motions])
            for axes, each in zip(panels, values, strict=True):
                axes.plot(at, each, style, color=colour, ms=4, lw=1.2,
                          label=label if style == mark else None)  # fmt: skip
    for axes, label in zip(
        panels, ("pitch per half chord of heave (rad)", "its phase (deg)", "thrust coefficient"),
        strict=True,
    ):  # fmt: skip
        axes.set(xlabel="k", ylabel=label)
    panels[0].legend(frameon=False, fontsize="small")
    figure.suptitle("lines: exact; points: unsteady; dashed: quasi-steady", fontsize="medium")
    return figure


def plane_wing(_: list[Comparison]) -> Figure:
    figure, (loading, bars) = new_figure(9.0, 2)
    strips = (np.arange(len(derivatives.AVL_SECTION_LIFT)) + 0.5) / len(
        derivatives.AVL_SECTION_LIFT
    )
    loading.plot(strips, derivatives.AVL_SECTION_LIFT, label="AVL", **MEASURED)
    loading.plot(strips, derivatives.section_lift(), label="lifting line", **STYLES[UNSTEADY])
    loading.set(
        xlabel="part of the half span", ylabel="lift coefficient of sections", ylim=(0, None)
    )
    loading.legend(frameon=False, fontsize="small")
    places = np.arange(len(derivatives.AVL))
    wrenches = {
        QUASI_STEADY: derivatives.quasi_steady_wrench(derivatives.LINE),
        UNSTEADY: derivatives.settled_wrench(derivatives.LINE),
    }
    for shift, (model, wrench) in zip((-0.2, 0.2), wrenches.items(), strict=True):
        found = derivatives.derivatives(wrench)
        ratios = [found[name] / value for name, value in derivatives.AVL.items()]
        bars.bar(places + shift, ratios, 0.38, color=STYLES[model]["color"], label=model)
    bars.axhline(1.0, **EXACT)
    bars.set_xticks(places, list(derivatives.AVL), rotation=60, fontsize="small")
    bars.set(ylabel="here over AVL")
    bars.legend(frameon=False, fontsize="small")
    return figure


def jackdaws(compared: list[Comparison]) -> Figure:
    figure, (axes,) = new_figure(6.5, 1)
    speeds = list(jackdaw.POWERS)
    axes.plot(speeds, [one.measured for one in compared], label="afpt", **MEASURED)
    for name in jackdaw.WAKES:
        powers = [one.computed.get(name, np.nan) for one in compared]
        axes.plot(speeds, powers, label=name, marker=".", **STYLES[name])
    axes.set(xlabel="speed (m/s)", ylabel="aerodynamic power (W)", ylim=(0.0, None))
    axes.legend(frameon=False, fontsize="small")
    return figure


FIGURES: dict[str, Callable[[list[Comparison]], Figure]] = {
    "A": scherers_wing,
    "B": yeos_wing,
    "C": sections_and_starts,
    "D": sprung_plates,
    "E": plane_wing,
    "G": jackdaws,
}


def table(compared: list[Comparison]) -> str:
    """The numbers of a case as Markdown."""
    lines = [
        "| | measured | quasi-steady | with apparent mass | unsteady | attached |",
        "|---|---|---|---|---|---|",
    ]
    for one in compared:
        values = (one.computed.get(name) for name in MODELS)
        cells = ("" if value is None else f"{value:.4g}" for value in values)
        unit = f", {one.unit}" if one.unit else ""
        lines.append(f"| {one.quantity}{unit} | {one.measured:.4g} | {' | '.join(cells)} |")
    return "\n".join(lines)


# With --coarse, the cases that take seconds.
QUICK = ("B", "E")


def main(directory: Path, letters: list[str]) -> None:
    """Print the tables and save the figures."""
    directory.mkdir(parents=True, exist_ok=True)
    chosen = [one for letter in letters for one in experiments(letter)] or experiments()
    for experiment in chosen:
        print(f"\n{experiment.case}: {experiment.title} ({experiment.source})\n")
        compared = list(experiment.compare())
        print(table(compared))
        figure = FIGURES[experiment.case](compared)
        figure.savefig(directory / f"validation_{experiment.case}.png", dpi=120)


if __name__ == "__main__":
    given = [word for word in sys.argv[1:] if word != "--coarse"]
    quick = list(QUICK) if "--coarse" in sys.argv else []
    main(Path(given[0] if given else "results"), given[1:] or quick)
