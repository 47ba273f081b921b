"""What the memory of the air does to stability: the same birds in air with a memory and without.

`python examples/air_with_memory.py [DIR] [--coarse] [--only PART ...]` prints the tables of
docs/memory.md and draws its pictures into DIR (default results/), where the tables go as CSV.
"""

import argparse
import csv
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from rich.console import Console
from rich.table import Table
from scipy.optimize import brentq

import birdmb
from birdmb._typing import FloatArray
from birdmb.models.wing_model import BirdModel
from birdmb.orbits import BranchPoint, Steps
from birdmb.studies.trim import TrimGuess

Model = type[birdmb.RigidModel] | type[birdmb.MultibodyModel]

RIGID, MULTIBODY = birdmb.RigidModel, birdmb.MultibodyModel
FLIGHTS: tuple[tuple[str, Model], ...] = (
    ("ibis", RIGID),
    ("ibis_compliant_shoulder", MULTIBODY),
    ("ibis_tail", RIGID),
    ("ibis_tail", MULTIBODY),
    ("pigeon", RIGID),
    ("pigeon", MULTIBODY),
    ("flapping_robot", MULTIBODY),
    ("gull_glider", RIGID),
    ("gull_glider", MULTIBODY),
)
IN_SPACE = ("ibis_tail", "pigeon")
REFINED = ("ibis", "ibis_tail", "gull_glider")
NUMBERS = ((16, 6), (32, 4), (32, 6), (32, 8), (64, 6), (64, 10))  # elements a wing, wake points
FREQUENCIES: dict[str, tuple[float, ...]] = {
    "ibis": (2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0),
    "ibis_tail": (2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0),
}
AMPLITUDES = (32.0, 36.0, 40.0, 42.0)  # deg
ROLL = {"forearm.roll.offset_deg": (-30.0, 30.0)}
OPENINGS = (5.0, 10.0, 15.0, 20.0, 25.0, 30.0)  # of the tail, deg
SOFTEST, STIFFNESSES = 4.0, (4.3, 4.5, 4.7)  # N m/rad, without damping
FEW: dict[str, object] = {"wing__discretisation": 16, "air__wake_points": 4}
TOLD = ("air", "m/s", "climb", "W as if level", "|Λ|max", "±", "verdict", "α, deg")
COARSE: dict[str, object] = {"wing.discretisation": 4, "air.wake_points": 4}


class Blend:
    """A bird in air of which a part, from 0 to 1, has a memory.

    The motion's rates are the weighted mean of those in both kinds of air; the lags always follow.
    """

    def __init__(self, model: BirdModel, part: float) -> None:
        self._with, self._without = model, model.in_air(wake="quasi-steady")
        self._part, self._motion = part, len(model.motion_state_names)
        self.state_names, self.period = model.state_names, model.period
        self.state_scale = model.state_scale

    def rates(self, times: FloatArray, states: FloatArray) -> FloatArray:
        """Rates (K, n) at `times` (K,) s of `states` (K, n)."""
        found, n = np.array(self._with.rates(times, states)), self._motion
        without = self._without.rates(times, states[:, :n])
        found[:, :n] = self._part * found[:, :n] + (1.0 - self._part) * without
        return found

    def rhs(self, t: float, x: FloatArray) -> FloatArray:
        """Rates (n,) at t (s) of x (n,)."""
        return np.asarray(self.rates(np.array([t]), x[None])[0])

    def flow(self, x0: FloatArray, t0: float, t1: float) -> FloatArray:
        """State (n,) at t1 (s) from x0 (n,) at t0."""
        ode = birdmb.OdeModel(self.rhs, self.state_names, self.period)
        return ode.flow(x0, t0, t1)


class WithoutLag:
    """A bird in air whose lags have always settled: apparent mass without a lag."""

    def __init__(self, model: BirdModel) -> None:
        self._model, self._motion = model, len(model.motion_state_names)
        self.state_names, self.period = model.motion_state_names, model.period
        self.state_scale = model.state_scale[: self._motion]

    def rates(self, times: FloatArray, states: FloatArray) -> FloatArray:
        """Rates (K, n) at `times` (K,) s of `states` (K, n)."""
        settled = self._model.with_lags(times, states)
        return self._model.rates(times, settled)[:, : self._motion]

    def rhs(self, t: float, x: FloatArray) -> FloatArray:
        """Rates (n,) at t (s) of x (n,)."""
        return np.asarray(self.rates(np.array([t]), x[None])[0])

    def flow(self, x0: FloatArray, t0: float, t1: float) -> FloatArray:
        """State (n,) at t1 (s) from x0 (n,) at t0."""
        ode = birdmb.OdeModel(self.rhs, self.state_names, self.period)
        return ode.flow(x0, t0, t1)


@dataclass(frozen=True)
class Report:
    """Where tables and pictures go.

    Attributes:
        out: the directory.
        coarse: whether all is to be quick.
        console: prints the tables.
    """

    out: Path
    coarse: bool
    console: Console

    def bird(self, name: str, **values: object) -> birdmb.Bird:
        """A bird of the package, with values by dotted names (`__` for the dot)."""
        given = {key.replace("__", "."): value for key, value in values.items()}
        return birdmb.load_bird(name).with_values({**(COARSE if self.coarse else {}), **given})

    def table(
        self, name: str, title: str, columns: Sequence[str], rows: Sequence[Sequence[str]]
    ) -> None:
        """Print a table, and keep it."""
        table = Table(*columns, title=title)
        for row in rows:
            table.add_row(*row)
        self.console.print(table)
        with (self.out / f"memory_{name}.csv").open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([columns, *rows])

    def picture(self, name: str, figure: Figure) -> None:
        """Keep a picture."""
        figure.savefig(self.out / f"memory_{name}.png", dpi=120)


def largest(multipliers: np.ndarray) -> float:
    """Largest modulus."""
    return float(np.abs(multipliers).max())


def in_both(
    bird: birdmb.Bird, model: Callable[[birdmb.Bird], BirdModel]
) -> birdmb.MemoryEffect | None:
    """A bird's flight without and with memory; `None` if one of them is not found."""
    try:
        cycle = birdmb.find_limit_cycle(model(bird))
        assert isinstance(cycle, birdmb.FlightCycle)
        return birdmb.memory_effect(cycle)
    except birdmb.BirdmbError:
        return None


def told(cycle: birdmb.FlightCycle) -> list[str]:
    """Speed, climb, power, largest multiplier, verdict and angle of attack."""
    angle = np.degrees(birdmb.assess_validity(cycle).largest_angle_of_attack)
    return [
        f"{cycle.mean_speed:.2f}", f"{cycle.mean_climb_rate:+.2f}", f"{cycle.corrected_power:.2f}",
        f"{largest(cycle.multipliers):.4f}", f"{cycle.verdict_errors[0]:.0e}",
        cycle.stability, f"{angle:.1f}",
    ]  # fmt: skip


def flights(report: Report) -> None:
    """All birds in the plane, with what memory consists of, and two in space."""
    rows, parts, labels, moduli = [], [], list[str](), list[list[float]]()
    for name, model in FLIGHTS[::4] if report.coarse else FLIGHTS:
        effect = in_both(report.bird(name), model)
        label = f"{name}, {model.__name__.removesuffix('Model').lower()}"
        if effect is None:
            rows.append([label, "no flight"])
            continue
        rows += [[label, "quasi-steady", *told(effect.quasi_steady)]]
        rows += [["", "unsteady", *told(effect.unsteady)]]
        values = [largest(effect.quasi_steady.multipliers), without_lag(effect)]
        values.append(largest(effect.unsteady.multipliers))
        steps = [f"{value:+.4f}" for value in np.diff(values)]
        parts.append([label, *(f"{value:.4f}" for value in values), *steps])
        labels.append(label)
        moduli.append(values)
    report.table("flights", "Flights without and with memory", ("flight", *TOLD), rows)
    columns = ("flight", "quasi-steady", "without lag", "unsteady", "at once", "by the lag")
    report.table("parts", "|Λ|max: what acts at once, and the lag", columns, parts)
    report.picture("flights", changes_picture(labels, np.array(moduli)))
    lateral(report)


def without_lag(effect: birdmb.MemoryEffect) -> float:
    """|Λ|max of the flight whose lags have settled at every instant; NaN if there is none."""
    cycle = effect.quasi_steady
    times = cycle.start_time + cycle.period * np.arange(64) / 64
    try:
        found = birdmb.find_limit_cycle(
            WithoutLag(effect.unsteady.model),
            cycle.trajectory(times).states,
            method="collocation",
            start_time=cycle.start_time,
        )
    except birdmb.BirdmbError:
        return np.nan
    return largest(found.multipliers)


def lateral(report: Report) -> None:
    """Lateral modes of flights in space."""
    rows = []
    for name in IN_SPACE[:1] if report.coarse else IN_SPACE:
        effect = in_both(report.bird(name), partial(RIGID, motion="free"))
        if effect is None:
            rows.append([name, "no flight"])
            continue
        for air, cycle in (("quasi-steady", effect.quasi_steady), ("unsteady", effect.unsteady)):
            # Roll may fade together with the wake, and be a mode of neither alone.
            slow, *_ = (
                abs(mode.multiplier)
                for mode in cycle.flight_modes
                if mode.plane == "lateral" and mode.multiplier.imag == 0.0
            )
            dutch, *_ = (
                abs(mode.multiplier) for mode in cycle.flight_modes if mode.name == "Dutch roll"
            )
            rows.append([name, air, f"{slow:.4f}", f"{dutch:.4f}", cycle.stability])
    columns = ("flight in space", "air", "spiral", "Dutch roll", "verdict")
    report.table("lateral", "Slow lateral modes, |Λ|", columns, rows)


def changes_picture(labels: Sequence[str], moduli: FloatArray) -> Figure:
    """What memory adds to |Λ|max of each flight: at once, and with the lag."""
    figure = Figure(figsize=(8, 4), layout="constrained")
    axes = figure.subplots()
    places = np.arange(len(labels))
    axes.plot(moduli[:, 1] - moduli[:, 0], places, "o", mfc="none", ms=8, label="without the lag")
    axes.plot(moduli[:, 2] - moduli[:, 0], places, "D", ms=5, label="all of it")
    axes.axvline(0.0, color="0.6", lw=0.8)
    named = zip(labels, moduli[:, 0], strict=True)
    axes.set_yticks(places, [f"{label} ({modulus:.3f})" for label, modulus in named])
    axes.invert_yaxis()
    axes.set_xlabel("what memory adds to |Λ|max (that of quasi-steady air in brackets)")
    axes.legend(frameon=False)
    return figure


def refinement(report: Report) -> None:
    """|Λ|max over the numbers of elements and of points with lags."""
    rows = []
    for name in REFINED[:1] if report.coarse else REFINED:
        for elements, points in ((6, 4), (6, 6)) if report.coarse else NUMBERS:
            bird = report.bird(name, wing__discretisation=elements, air__wake_points=points)
            effect = in_both(bird, RIGID)
            cells = ["no flight"]
            if effect is not None:
                pair = effect.quasi_steady, effect.unsteady
                cells = [f"{largest(cycle.multipliers):.5f}" for cycle in pair]
                cells.append(f"{effect.multiplier_change:+.5f}")
            rows.append([name, str(elements), str(points), *cells])
    columns = ("flight", "elements", "wake points", "quasi-steady", "unsteady", "change")
    report.table("refinement", "|Λ|max by the numbers of elements and points", columns, rows)


def frequency(report: Report) -> None:
    """Growth without and with memory over the frequency of the beat, other values as they are."""
    rows, found = [], dict[str, FloatArray]()
    for name, values in FREQUENCIES.items():
        lines = []
        for hertz in values[3:5] if report.coarse else values:
            effect = in_both(report.bird(name, gait__frequency=hertz), RIGID)
            if effect is None:
                rows.append([name, f"{hertz:g}", "no flight"])
                continue
            pair = effect.quasi_steady, effect.unsteady
            k = birdmb.assess_validity(pair[0]).reduced_frequency
            moduli = [largest(cycle.multipliers) for cycle in pair]
            growth = hertz * np.log(moduli)
            rows.append(
                [
                    name, f"{hertz:g}", f"{k:.3f}", *(f"{cycle.mean_speed:.2f}" for cycle in pair),
                    *(f"{modulus:.4f}" for modulus in moduli), *(f"{g:+.3f}" for g in growth),
                    f"{growth[1] - growth[0]:+.4f}",
                ]
            )  # fmt: skip
            lines.append([hertz, k, *moduli, *growth])
        found[name] = np.array(lines)
    columns = (
        "flight", "Hz", "k", "m/s", "with", "|Λ|max", "with", "growth, 1/s", "with", "change",
    )  # fmt: skip
    report.table("frequency", "Over the frequency of the beat", columns, rows)
    figure = Figure(figsize=(8, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    for (name, lines), colour in zip(found.items(), ("C0", "C1"), strict=True):
        hertz, k, *_, without, remembered = lines.T
        left.plot(hertz, without, "o-", color=colour, mfc="none", label=name)
        left.plot(hertz, remembered, "D--", color=colour, ms=4, label=f"{name}, with memory")
        right.plot(k, remembered - without, "o-", color=colour, label=name)
    left.axhline(0.0, color="0.6", lw=0.8)
    left.set(xlabel="frequency of the beat, Hz", ylabel="growth of the least damped mode, 1/s")
    right.set(xlabel="reduced frequency k = π f c/U", ylabel="change of it by memory, 1/s")
    left.legend(frameon=False)
    report.picture("frequency", figure)


def openings(report: Report) -> None:
    """The opening of the tail at which level flight becomes stable, over the flap's amplitude."""
    rows, found = [], []
    for amplitude in AMPLITUDES[-1:] if report.coarse else AMPLITUDES:
        values = {} if report.coarse else FEW
        bird = report.bird("ibis_tail", shoulder__flap__amplitude_deg=amplitude, **values)
        pair = [
            stable_opening(bird.with_values({"air.wake": wake}))
            for wake in ("quasi-steady", "unsteady")
        ]
        rows.append([f"{amplitude:g}", *(f"{opening:.2f}" for opening in pair)])
        found.append(pair)
    columns = ("flap amplitude, deg", "quasi-steady", "unsteady")
    report.table("openings", "Stable from this opening of the tail on, deg", columns, rows)
    figure = Figure(figsize=(5, 3.6), layout="constrained")
    axes = figure.subplots()
    amplitudes = AMPLITUDES[-len(found) :]
    axes.plot(amplitudes, np.array(found)[:, 0], "o-", mfc="none", label="quasi-steady")
    axes.plot(amplitudes, np.array(found)[:, 1], "D--", ms=4, label="with memory")
    axes.set(xlabel="amplitude of the flap, deg", ylabel="opening of the tail, deg")
    axes.set_title("Level flight is stable above the lines", fontsize=10)
    axes.legend(frameon=False)
    report.picture("openings", figure)


def stable_opening(bird: birdmb.Bird) -> float:
    """Opening (deg) of the tail from which level flight is stable; NaN if none is met."""
    before = None
    for opening in OPENINGS:
        try:
            after = growth_when_level(bird, opening)
            if before is not None and before > 0.0 > after:
                growth = partial(growth_when_level, bird)
                return float(brentq(growth, opening - OPENINGS[0], opening, xtol=1e-3))
            before = after
        except birdmb.BirdmbError:
            before = None
    return np.nan


def growth_when_level(bird: birdmb.Bird, opening: float) -> float:
    """ln |Λ|max of level flight with the tail open so far (deg)."""
    spread = bird.with_values({"tail.opening_deg": opening})
    # With a guess the trim does without its slow ways where there is no level flight.
    guess = TrimGuess({name: bird.value(name) for name in ROLL})
    trim = birdmb.trim_flight(spread, ROLL, tolerance=1e-6, guess=guess)
    return float(np.log(largest(trim.cycle.multipliers)))


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
        left.plot(at, [largest(p.multipliers) for p in branch.points], label=f"k = {stiffness:g}")
        right.plot(at, [speed(point) for point in branch.points])
    columns = (
        "k", "m/s", "|Λ|max", "verdict", "changes at", "followed to", "m/s", "|Λ|max", "verdict",
    )  # fmt: skip
    report.table("shoulder", "Undamped shoulders: from no memory to all of it", columns, rows)
    left.axhline(1.0, color="0.6", lw=0.8)
    left.set(xlabel="part of the memory", ylabel="|Λ|max")
    right.set(xlabel="part of the memory", ylabel="speed, m/s")
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


PARTS = {each.__name__: each for each in (flights, refinement, frequency, openings, shoulder)}


def main(out: Path, parts: Sequence[str], *, coarse: bool) -> None:
    """Print the tables, and draw the pictures."""
    out.mkdir(parents=True, exist_ok=True)
    report = Report(out, coarse, Console(width=150))
    for part in parts:
        PARTS[part](report)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", nargs="?", type=Path, default=Path("results"))
    parser.add_argument("--coarse", action="store_true", help="few flights, coarse wings: quick")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS), help="these parts")
    options = parser.parse_args()
    main(options.directory, options.only, coarse=options.coarse)
