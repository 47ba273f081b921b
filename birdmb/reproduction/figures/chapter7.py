"""Chapter 7: the multibody bird goes to the rigid one as its wings lose their mass."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from birdmb.figures.page import legend_below, new_figure
from birdmb.figures.style import SERIES
from birdmb.models import MultibodyModel, RigidModel
from birdmb.orbits import find_limit_cycle
from birdmb.reproduction.figures.drawing import Drawing, keep_figure, keep_table
from birdmb.reproduction.quantities import STATES, bird, published_wing
from birdmb.topology import Bird

_MASSES = 10.0 ** np.arange(-2, -14, -1)  # kg
_COARSE_MASSES = 10.0 ** np.arange(-2, -5, -1)
# Enough steps on either side for the models' own errors to stay below the smallest gap.
_RIGID_STEPS, _STEPS = 960, 120
_TOLERANCE = 1e-11


def with_segment_mass(one: Bird, mass: float) -> Bird:
    """The bird with segments of this mass in kg, their inertias in proportion."""
    values: dict[str, object] = {}
    for bone in ("humerus", "forearm", "hand"):
        segment = getattr(one.segments, bone)
        values[f"segments.{bone}.mass"] = mass
        inertia = np.array(segment.inertia) * (mass / segment.mass)
        values[f"segments.{bone}.inertia"] = inertia.tolist()
    return one.with_values(values)


def _states(out: Path, _coarse: bool) -> None:
    """Initial states of both birds in the published discretisation, beside the printed ones."""
    rigid = RigidModel(published_wing("ibis", shoulder__flap__amplitude_deg=43.47))
    multibody = MultibodyModel(published_wing("ibis_massless"))
    printed = {
        "rigid": (18.511, -2.110, -0.118, -0.1164),
        "multibody; 1e-5 kg": (18.516, -2.102, -0.120, -0.1161),
    }
    rows: list[list[object]] = []
    for (about, numbers), model in zip(printed.items(), (rigid, multibody), strict=True):
        x0 = find_limit_cycle(model).x0
        rows += [[about, *each] for each in zip(STATES, map(float, x0), numbers, strict=True)]
    keep_table(out, "table 7.states", ("bird", "state", "computed", "printed"), rows)


def _masses(out: Path, coarse: bool) -> None:
    one = bird("ibis_massless", **({"wing__discretisation": 8} if coarse else {}))
    rigid = find_limit_cycle(
        RigidModel(one, steps_per_beat=_RIGID_STEPS),
        method="shooting",
        tolerance=_TOLERANCE,
        jacobian="variational",
    )
    masses = _COARSE_MASSES if coarse else _MASSES
    rows: list[list[object]] = []
    gaps = []
    for mass in masses.tolist():
        model = MultibodyModel(with_segment_mass(one, mass), steps_per_beat=_STEPS)
        cycle = find_limit_cycle(model, rigid.x0, method="shooting", tolerance=_TOLERANCE)
        states = cycle.x0 - rigid.x0
        apart = np.sort_complex(cycle.multipliers) - np.sort_complex(rigid.multipliers)
        largest = float(np.abs(apart).max())
        gaps.append([np.abs(states / model.state_scale).max(), largest])
        rows.append([f"{mass:.0e}", *(f"{gap:+.2e}" for gap in states), f"{largest:.1e}"])
    columns = ("segment mass kg", *STATES, "largest gap of a multiplier")
    keep_table(out, "figure 7.masses", columns, rows)
    figure = new_figure(6, 4)
    axes = figure.subplots()
    axes.set_prop_cycle(SERIES)
    labels = ("of a state (state scale)", "of a multiplier")
    for values, label, marker in zip(np.transpose(gaps), labels, "os", strict=True):
        axes.loglog(masses, values, marker=marker, label=label)
    first = gaps[-1 if coarse else 3][0] / masses[-1 if coarse else 3]
    axes.loglog(masses, first * masses, color="0.7", zorder=0, ls=":", label="first order")
    axes.set(xlabel="mass of a wing segment (kg)", ylabel="largest gap of multibody\nand rigid")
    legend_below(figure)
    keep_figure(out, "figure 7.masses", figure)


DRAWINGS: Mapping[str, Drawing] = {
    "table 7.states": Drawing("initial states of the rigid and the multibody bird", _states),
    "figure 7.masses": Drawing(
        "gap of the two birds over the wings' mass (no number in the thesis)", _masses
    ),
}
