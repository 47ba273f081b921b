"""Chapter 8 along the inertia of the wings, from slender bones to the printed one.

The limit cycle of each of the five printed pairs of stiffness and damping is followed while the
same moment of inertia is added about every axis of every segment. At 16 elements a wing and 60
steps a beat, some minutes; branches are kept, and a run that was stopped goes on with them.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from birdmb._typing import FloatArray
from birdmb.figures.labels import LARGEST_MODULUS
from birdmb.figures.page import label_x, label_y, new_figure, panels, title
from birdmb.figures.style import LINE, VERMILION
from birdmb.models import MultibodyModel
from birdmb.orbits import Branch, Steps, continue_branch, load_branch
from birdmb.reproduction.chapter8_birds import TABLE_8_1
from birdmb.reproduction.figures.drawing import Drawing, keep_figure, keep_table
from birdmb.reproduction.quantities import bird
from birdmb.studies import flight_observables
from birdmb.studies.validity import LARGEST_ANGLE
from birdmb.topology import Bird

_QUANTITIES = (LARGEST_MODULUS, r"$P_\mathrm{act}$ (W)", r"$P_\mathrm{g}$ (W)")
_BONES = ("humerus", "forearm", "hand")
_PRINTED = 0.01  # kg m2
_STEPS_PER_BEAT = 60
_MOST_POINTS = 24  # by then most wings have swung through one another
_COARSE_POINTS = 3
_UPRIGHT = float(np.radians(90.0))  # there the two wings meet


def _with_added_inertia(one: Bird, moment: float) -> MultibodyModel:
    """The bird with this moment (kg m2) added about every axis of every segment."""
    heavier = {
        f"segments.{bone}.inertia": np.add(
            getattr(one.segments, bone).inertia, moment * np.eye(3)
        ).tolist()
        for bone in _BONES
    }
    return MultibodyModel(
        one.with_values(heavier), steps_per_beat=_STEPS_PER_BEAT, integrator="explicit"
    )


def _followed(k: float, c: float, out: Path, coarse: bool) -> Branch:
    """The branch of one pair of stiffness and damping, computed or as it was kept."""
    one = bird("ibis_compliant_shoulder", wing__discretisation=8 if coarse else 16)
    one = one.with_joint("shoulder.flap", stiffness=k, damping=c)
    store = out / f"inertia_{'coarse_' if coarse else ''}{k:g}_{c:g}.nc"
    kept = load_branch(store) if store.exists() else None
    if kept is not None and (kept.stopped is None or "interrupted" not in kept.stopped.reason):
        return kept
    return continue_branch(
        functools.partial(_with_added_inertia, one),
        (0.0, _PRINTED),
        parameter_name="added moment of inertia",
        steps=Steps(first=0.05, longest=0.25),
        max_points=_COARSE_POINTS if coarse else _MOST_POINTS,
        observables=flight_observables(one),
        resume=kept,
        store=store,
    )


def _quantities(branch: Branch) -> FloatArray:
    """|Lambda| max, P_act (W) and P_g (W) along a branch, (3, number of points)."""
    one = bird("ibis_compliant_shoulder")
    modulus = [abs(point.multipliers[0]) for point in branch.points]
    weight = one.total_mass * one.gravity
    return np.array([modulus, branch.values("power"), -weight * branch.values("mean_climb_rate")])


def _crossings(moments: FloatArray, values: FloatArray, wanted: float) -> list[float]:
    """Moments at which the values pass what is wanted, by linear interpolation."""
    apart = values - wanted
    at = np.flatnonzero(apart[:-1] * apart[1:] < 0)
    share = apart[at] / (apart[at] - apart[at + 1])
    return list(moments[at] + share * (moments[at + 1] - moments[at]))


def _widest(branch: Branch) -> FloatArray:
    """Largest modulus of the flap along a branch, rad."""
    return np.maximum(branch.values("highest_flap"), -branch.values("lowest_flap"))


def _row(spring: tuple[float, float], branch: Branch) -> list[object]:
    """What happens along a branch: where, in kg m2."""
    moments = branch.parameters
    row: list[object] = [*spring, float(abs(branch.points[0].multipliers[0]))]
    for values, wanted in zip(_quantities(branch), TABLE_8_1[spring], strict=True):
        found = _crossings(moments, values, wanted)
        row.append("; ".join(f"{moment:.4g}" for moment in found) or "nowhere")
    meeting = _crossings(moments, _widest(branch), _UPRIGHT)
    row.append(f"{meeting[0]:.4g}" if meeting else "not reached")
    folds = [f"{b.kind} {b.parameter:.4g}" for b in branch.bifurcations]
    return [*row, "; ".join(folds) or "none seen"]


def _inertia(out: Path, coarse: bool) -> None:
    springs = list(TABLE_8_1)[:1] if coarse else list(TABLE_8_1)
    branches = {spring: _followed(*spring, out, coarse) for spring in springs}
    keep_table(
        out,
        "figure 8.inertia",
        (
            "k N m/rad", "C N m s/rad", "|multiplier| at 0", "printed |multiplier| at",
            "printed P_act at", "printed P_g at", "wings meet at", "bifurcations",
        ),
        [_row(*one) for one in branches.items()],
    )  # fmt: skip
    figure = new_figure(13, 7.5, rows=3, columns=len(branches))
    grid = panels(figure, 3, len(branches), sharex=True, sharey="row")
    for column, (spring, branch) in zip(grid.T, branches.items(), strict=True):
        moments = branch.parameters
        valid = branch.values("largest_angle_of_attack") <= LARGEST_ANGLE
        for axes, values, wanted in zip(
            column, _quantities(branch), TABLE_8_1[spring], strict=True
        ):
            seen = np.where(_widest(branch) < _UPRIGHT, values, np.nan)
            axes.plot(1e3 * moments, seen, ":", color="0.45", lw=1.2)
            axes.plot(1e3 * moments, np.where(valid, seen, np.nan), "-", color=LINE, lw=2.5)
            axes.axhline(wanted, color=VERMILION, ls="--", lw=1.2)
            axes.spines[["top", "right"]].set_visible(False)
        title(column[0], f"k = {spring[0]:g}, C = {spring[1]:g}")
    for row, name, limits in zip(
        grid, _QUANTITIES, ((1.0, 1.6), (-40.0, 20.0), (-10.0, 60.0)), strict=True
    ):
        label_y(row, name)
        row[0].set_ylim(limits)
    label_x(grid, "added inertia (g m²)")
    title(
        figure,
        "inertia added to each segment about every axis; thick: within the model's validity, "
        "dotted: beyond it, dashed: printed (k in N m/rad, C in N m s/rad)",
    )
    keep_figure(out, "figure 8.inertia", figure)


DRAWINGS: Mapping[str, Drawing] = {
    "figure 8.inertia": Drawing(
        "multiplier and powers along the wings' inertia (no number in the thesis)", _inertia
    )
}
