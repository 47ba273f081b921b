"""Stable flights on soft, undamped shoulders, taken into air with a memory."""

from collections.abc import Iterator
from functools import partial

import numpy as np
from matplotlib.figure import Figure
from partial_memory import Blend
from report import FEW, MULTIBODY, Report, largest

import birdmb
from birdmb.orbits import BranchPoint, Steps

SOFTEST, STIFFNESSES = 4.0, (4.3, 4.5, 4.7)  # N m/rad, without damping
DASHES = ("-", "--", ":")


def shoulder(report: Report) -> None:
    """Flights on soft, undamped shoulders, followed into air with ever more memory."""
    rows = []
    figure = Figure(figsize=(8, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    for model, cycle in undamped(report):
        stiffness = model.bird.value("shoulder.flap.stiffness")
        times = model.bird.period * np.arange(len(cycle.points)) / len(cycle.points)
        branch = birdmb.continue_branch(
            partial(Blend, model),
            (0.0, 1.0),
            model.with_lags(times, cycle.points),
            method="collocation",
            steps=Steps(longest=0.25),
            max_points=2 if report.coarse else 30,
        )
        changes = [found.parameter for found in branch.bifurcations]
        first, last = branch.points[0], branch.points[-1]
        rows.append(
            [
                f"{stiffness:g}", f"{speed(first):.2f}", f"{largest(first.multipliers):.4f}",
                first.stability, ", ".join(f"{part:.3f}" for part in changes),
                f"{last.parameter:.2f}", f"{speed(last):.2f}", f"{largest(last.multipliers):.4f}",
                last.stability,
            ]
        )  # fmt: skip
        at = branch.parameters
        look = {"ls": DASHES[len(rows) - 1], "label": f"k = {stiffness:g} N m/rad"}
        left.plot(at, [largest(p.multipliers) for p in branch.points], **look)
        right.plot(at, [speed(point) for point in branch.points], **look)
    columns = (
        "k", "m/s", "|Λ|max", "verdict", "changes at", "followed to", "m/s", "|Λ|max", "verdict",
    )  # fmt: skip
    report.table("shoulder", "Undamped shoulders: from no memory to all of it", columns, rows)
    left.axhline(1.0, color="0.6", lw=0.8)
    left.set(xlabel="part of the memory", ylabel="|Λ|max")
    right.set(xlabel="part of the memory", ylabel="speed (m/s)")
    left.legend(frameon=False)
    report.picture("shoulder", figure)


def undamped(report: Report) -> Iterator[tuple[birdmb.MultibodyModel, birdmb.FlightCycle]]:
    """Models with a memory of undamped shoulders, each with its flight without one."""
    bird = report.bird(
        "ibis_compliant_shoulder",
        shoulder__flap__damping=0.0,
        air__wake="unsteady",
        **({} if report.coarse else FEW),
    )
    # The coarse wing has no second sheet; the search for it starts on the softest shoulder.
    cycle = None
    for stiffness in (12.0,) if report.coarse else (SOFTEST, *STIFFNESSES):
        model = MULTIBODY(bird.with_values({"shoulder.flap.stiffness": stiffness}))
        cycle = birdmb.find_limit_cycle(model.in_air(wake="quasi-steady"), cycle)
        if stiffness != SOFTEST:
            yield model, cycle


def speed(point: BranchPoint) -> float:
    """Modulus of the mean velocity, m/s, of a flight in the plane: states u, w, q, theta first."""
    u, w, _, theta = point.points[:, :4].T
    along, up = u * np.cos(theta) + w * np.sin(theta), u * np.sin(theta) - w * np.cos(theta)
    return float(np.hypot(along.mean(), up.mean()))
