"""Figures of the appendices: Roessler's cycles, the redox oscillator, integrators, exponents."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from birdmb._typing import FloatArray
from birdmb.figures.page import (
    axes_in_space,
    label_x,
    label_y,
    legend_below,
    new_figure,
    panels,
    title,
)
from birdmb.figures.style import BLUE, SERIES, VERMILION
from birdmb.models import RigidModel
from birdmb.orbits import largest_lyapunov_exponent
from birdmb.reproduction.appendices import ROESSLER, redox_cycle, roessler, roessler_cycle
from birdmb.reproduction.figures.drawing import Drawing, keep_figure
from birdmb.reproduction.quantities import bird, published_wing

Step = Callable[[RigidModel, float, FloatArray, float], FloatArray]


def roessler_portrait(number: int, out: Path, _coarse: bool) -> None:
    """Draw the cycle of a case in phase space, and a trajectory that begins beside it."""
    case = ROESSLER[number - 1]
    cycle = roessler_cycle(case)
    beside = cycle.x0 + np.array([0.0, 0.3, 0.0])
    times = np.linspace(0.0, 4 * cycle.period, 2001)
    start = roessler(case.a, case.b, case.c).trajectory(beside, 0.0, times[-1], times)
    orbit = cycle.trajectory(times[:501]).states
    figure = new_figure(6.5, 5.6)
    axes = axes_in_space(figure)
    axes.plot(
        *start.states.T,
        color=VERMILION,
        lw=0.6,
        ls=(0, (4, 1.5)),
        label="from beside it, four periods",
    )
    axes.plot(*orbit.T, color=BLUE, lw=2, label="limit cycle")
    axes.set(xlabel="x", ylabel="y", zlabel="z")
    axes.locator_params(nbins=4)
    legend_below(figure)
    others = np.delete(cycle.multipliers, cycle.trivial_index or 0)
    title(axes, f"{case.name}: T = {cycle.period:.6f} s, |Λ| = {np.abs(others).max():.6f}")
    keep_figure(out, f"figure A.{number}", figure)


def redox_portrait(out: Path, _coarse: bool) -> None:
    """Draw the states of the redox oscillator over its period, and its multipliers."""
    figure = redox_cycle().plot()
    for axes in figure.get_axes():
        if axes.get_xlabel() == "time (s)":
            axes.set_xlabel("time (h)")
    keep_figure(out, "figure B.1", figure)


def _euler(model: RigidModel, t: float, x: FloatArray, h: float) -> FloatArray:
    return h * model.rhs(t, x)


def _rk2(model: RigidModel, t: float, x: FloatArray, h: float) -> FloatArray:
    return h * model.rhs(t + h / 2, x + h / 2 * model.rhs(t, x))


def _rk3(model: RigidModel, t: float, x: FloatArray, h: float) -> FloatArray:
    k1 = model.rhs(t, x)
    k2 = model.rhs(t + h / 2, x + h / 2 * k1)
    k3 = model.rhs(t + h, x + h * (2 * k2 - k1))
    return h / 6 * (k1 + 4 * k2 + k3)


def _rk4(model: RigidModel, t: float, x: FloatArray, h: float) -> FloatArray:
    k1 = model.rhs(t, x)
    k2 = model.rhs(t + h / 2, x + h / 2 * k1)
    k3 = model.rhs(t + h / 2, x + h / 2 * k2)
    k4 = model.rhs(t + h, x + h * k3)
    return h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


_STEPPERS: Mapping[str, tuple[Step, int]] = {
    "Euler": (_euler, 1),
    "Runge-Kutta 2": (_rk2, 2),
    "Runge-Kutta 3": (_rk3, 3),
    "Runge-Kutta 4": (_rk4, 4),
}


def integrators(out: Path, coarse: bool) -> None:
    """Draw the error of a beat of the ibis over the evaluations of its right-hand side."""
    figure = new_figure(9.5, 4.4, columns=2)
    row = panels(figure, 1, 2, sharex=True, sharey=True)
    numbers = (15, 30) if coarse else (15, 30, 60, 120, 240)
    wings = {"published wing": published_wing("ibis"), "converged wing": bird("ibis")}
    for axes, (about, ibis) in zip(row[0], wings.items(), strict=True):
        _draw_errors(axes, RigidModel(ibis, steps_per_beat=960), numbers)
        title(axes, about)
    label_x(row, "evaluations of the right-hand side in a beat")
    label_y(row, "error of the state after a beat (state scale)")
    legend_below(figure, most=4)
    keep_figure(out, "figure C.1", figure)


def _draw_errors(axes: Axes, exact: RigidModel, numbers: Sequence[int]) -> None:
    x0, period = exact.initial_guess(), exact.bird.period
    axes.set_prop_cycle(SERIES)
    end = exact.flow(x0, 0.0, period)
    for (name, (step, stages)), marker in zip(_STEPPERS.items(), "o^sD", strict=True):
        errors = []
        for steps in numbers:
            x, h = x0, period / steps
            for k in range(steps):
                x = x + step(exact, k * h, x, h)
            errors.append(np.abs((x - end) / exact.state_scale).max())
        axes.loglog(np.multiply(numbers, stages), errors, marker=marker, label=name)


def lyapunov(out: Path, coarse: bool) -> None:
    """Draw the largest exponent of a chaotic and of a periodic Roessler system as it settles."""
    figure = new_figure(7, 4.4)
    axes = figure.subplots()
    intervals = 30 if coarse else 400
    for c, style in zip((5.7, 2.5), SERIES, strict=False):
        found = largest_lyapunov_exponent(
            roessler(0.2, 0.2, c), [1.0, 1.0, 0.0], 6.0, intervals, method="neighbours"
        )
        label = f"a = b = 0.2, c = {c:g}: {found.exponent:.4f} ± {found.error:.4f} 1/s"
        axes.plot(found.times, found.running, label=label.replace("-", "−"), **style)
    axes.axhline(0.0714, color="0.4", ls=":", lw=1, label="0.0714 (Sprott 2003)")
    axes.set(xlabel="time (s)", ylabel="largest Lyapunov exponent (1/s)", ylim=(-0.1, 0.15))
    legend_below(figure)
    keep_figure(out, "figure E.1", figure)


DRAWINGS: Mapping[str, Drawing] = {
    **{
        f"figure A.{n}": Drawing(
            f"Roessler system, case {n}, in phase space", partial(roessler_portrait, n)
        )
        for n in (1, 2, 3)
    },
    "figure B.1": Drawing("redox oscillator: states and multipliers", redox_portrait),
    "figure C.1": Drawing("integrators compared over a beat of the ibis", integrators),
    "figure E.1": Drawing("largest Lyapunov exponents as they settle", lyapunov),
}
