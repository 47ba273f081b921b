"""Is a bird without a fin laterally stable? The modes of the ibis in space, and what moves them.

`python examples/studies/lateral.py [DIR] [--coarse]` prints the tables of docs/lateral.md and draws
its picture into DIR (default results/).
"""

import argparse
from collections.abc import Mapping, Sequence
from itertools import islice
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from rich.console import Console
from rich.table import Table

import birdmb
from birdmb.models import FlightMode
from birdmb.models.starts import steady_turns

TOPOLOGIES = Path(__file__).parents[2] / "topologies"
MODES = ("roll", "spiral", "Dutch roll")
# Each by itself, from the tailed ibis in flapping flight.
VARIATIONS: dict[str, Mapping[str, float]] = {
    "as it is": {},
    "flap offset + 5 deg (dihedral)": {"shoulder.flap.offset_deg": 5.0},
    "flap offset - 5 deg": {"shoulder.flap.offset_deg": -5.0},
    "flap amplitude 30 deg": {"shoulder.flap.amplitude_deg": 30.0},
    "sweep offset 5 deg further aft": {"shoulder.sweep.offset_deg": -19.5},
    "sweep offset 5 deg less": {"shoulder.sweep.offset_deg": -9.5},
    "tail furled": {"tail.opening_deg": 0.0},
    "tail opened to 60 deg": {"tail.opening_deg": 60.0},
    "hand 20 % longer": {"segments.hand.length": 1.2 * 0.084},
    "I_xx twice as large": {"body.inertia_xx": 0.04},
    "I_zz by a fifth smaller": {"body.inertia_zz": 0.088},
    "no drag of body and profile": {"drag.body": False, "drag.profile_coefficient": 0.0},
}


FLAP = "shoulder.flap"
STIFFNESSES = (100.0, 40.0, 20.0, 15.0, 10.0)  # N m/rad, of each shoulder
DAMPING = 0.2  # N m s/rad
STROKES = (0.0, 0.5, 1.0, 2.0)  # deg, by which the left wing's amplitude is larger

Model = type[birdmb.RigidModel] | type[birdmb.MultibodyModel]


def flown(
    bird: birdmb.Bird, model: Model = birdmb.RigidModel, near: birdmb.FlightCycle | None = None
) -> birdmb.FlightCycle | None:
    """The bird's limit cycle in space; `None` if there is none."""
    try:
        return birdmb.find_limit_cycle(model(bird, motion="free"), near)
    except birdmb.BirdmbError:
        return None


def beating(bird: birdmb.Bird, part: float) -> birdmb.Bird:
    """The bird with this part of all amplitudes; 0 holds its wings at the drivers' means."""
    return bird.with_values({f"{j.name}.amplitude": part * j.amplitude for j in bird.joints})


def described(mode: FlightMode, period: float) -> str:
    """Multiplier, and the time in which the mode doubles or halves."""
    size = abs(mode.multiplier)
    does = "doubles" if size > 1 else "halves"
    turn = abs(np.angle(mode.multiplier)) / (2 * np.pi * period)
    swings = f", {turn:.2f} Hz" if mode.multiplier.imag else ""
    return f"{size:.4f} ({does} in {mode.doubling_time:.3g} s{swings})"


def lateral(cycle: birdmb.FlightCycle) -> list[str]:
    """Cells of a table: roll, spiral, Dutch roll."""
    found = {mode.name: mode for mode in cycle.flight_modes if mode.plane == "lateral"}
    return [described(found[n], cycle.period) if n in found else "" for n in MODES]


def row(table: Table, name: str, bird: birdmb.Bird, model: Model = birdmb.RigidModel) -> None:
    """One flight."""
    cycle = flown(bird, model)
    if cycle is None:
        table.add_row(name, "no flight")
        return
    flight = f"{cycle.mean_speed:.2f}", f"{cycle.mean_climb_rate:+.2f}"
    table.add_row(name, *flight, *lateral(cycle))


def columns(title: str) -> Table:
    """An empty table."""
    return Table("flight", "m/s", "climb", *MODES, title=title)


def turning(bird: birdmb.Bird) -> Table:
    """The straight flight, the turn that a banked start leads to, and where the former ends."""
    model = birdmb.RigidModel(bird, motion="free")
    straight = birdmb.find_limit_cycle(model)
    right, _ = steady_turns(straight.x0[None], bird.gravity)
    table = Table(
        "flight", "m/s", "climb", "bank, deg", "turn, deg/s", "|Λ| max", "power, W",
        title="Straight flight and turn",
    )  # fmt: skip
    turn = birdmb.find_limit_cycle(model, right)
    for name, cycle in (("straight", straight), ("turn", turn)):
        degrees = np.degrees([cycle.mean_bank, cycle.turn_rate])
        table.add_row(
            name, f"{cycle.mean_speed:.2f}", f"{cycle.mean_climb_rate:+.2f}",
            f"{degrees[0]:.1f}", f"{degrees[1]:.1f}",
            f"{abs(cycle.multipliers[0]):.4f}", f"{cycle.power:.2f}",
        )  # fmt: skip
    x = straight.x0.copy()
    x[model.state_names.index("phi")] = 1e-3
    for beat in range(400):
        x = model.flow(x, beat * model.period, (beat + 1) * model.period)
    away = np.abs((x - turn.x0) / model.state_scale).max()
    table.add_row(f"100 s after a bank of 0.001 rad: {away:.1e} of typical sizes from the turn")
    return table


def shoulders(bird: birdmb.Bird, stiffnesses: Sequence[float] = STIFFNESSES) -> Table:
    """Flights with wings of some mass, whose shoulders are sprung, each by itself."""
    table = columns(f"Shoulders free of each other, {DAMPING:g} N m s/rad")
    row(table, "wings without mass, prescribed", bird)
    row(table, "with mass, prescribed", bird, birdmb.MultibodyModel)
    for stiffness in stiffnesses:
        sprung = bird.with_joint(FLAP, stiffness=stiffness, damping=DAMPING)
        row(table, f"{stiffness:g} N m/rad", sprung, birdmb.MultibodyModel)
    return table


def uneven(bird: birdmb.Bird) -> Table:
    """Flights with a larger stroke of the left wing, each from the one before."""
    table = Table(
        "left amplitude", "m/s", "bank, deg", "turn, deg/s", "|Λ| max",
        title="One larger stroke",
    )  # fmt: skip
    cycle = None
    for more in STROKES:
        larger = bird.value(f"{FLAP}.amplitude_deg") + more
        cycle = flown(bird.with_values({f"{FLAP}.left.amplitude_deg": larger}), near=cycle)
        if cycle is None:
            table.add_row(f"+ {more:g} deg", "no flight")
            return table
        degrees = np.degrees([cycle.mean_bank, cycle.turn_rate])
        table.add_row(
            f"+ {more:g} deg", f"{cycle.mean_speed:.2f}", f"{degrees[0]:.2f}",
            f"{degrees[1]:.2f}", f"{abs(cycle.multipliers[0]):.4f}",
        )  # fmt: skip
    return table


def moduli(bird: birdmb.Bird, parts: np.ndarray) -> dict[str, np.ndarray]:
    """Moduli (P,) of the slow lateral multipliers at parts (P,) of the amplitudes, by mode."""
    found = {name: np.full(parts.size, np.nan) for name in MODES[1:]}
    for i, part in enumerate(parts):
        cycle = flown(beating(bird, part))
        for mode in () if cycle is None else cycle.flight_modes:
            if mode.name in found:
                found[mode.name][i] = abs(mode.multiplier)
    return found


def picture(parts: np.ndarray, by_mode: Mapping[str, np.ndarray]) -> Figure:
    """Moduli of the slow lateral multipliers from gliding to flapping."""
    figure = Figure(figsize=(7, 4), layout="constrained")
    axes = figure.subplots()
    for (name, values), style in zip(by_mode.items(), ("C3-", "C0--"), strict=True):
        axes.plot(parts, values, style, label=name)
    axes.axhline(1.0, color="0.6", lw=0.8)
    axes.set_xlabel("part of the wingbeat's amplitudes (0: gliding)")
    axes.set_ylabel("|Λ| per beat of 0.25 s")
    axes.legend()
    return figure


def main(out: Path, *, coarse: bool) -> None:
    """Print the tables, and draw the picture."""
    out.mkdir(parents=True, exist_ok=True)
    console = Console(width=180)
    tailless, tailed = (
        birdmb.load_bird(TOPOLOGIES / f"{name}.toml").with_values(
            {"wing.discretisation": 4} if coarse else {}
        )
        for name in ("ibis", "ibis_tail")
    )
    furled = tailed.with_values({"tail.opening_deg": 0.0})
    table = columns("Flapping and gliding, |multiplier| per beat of 0.25 s")
    for name, bird in (
        ("thesis's bird, chapter 5: no tail, no drag", tailless),
        ("chapter 6, tail furled", furled),
        ("chapter 6, tail spread to 40 deg", tailed),
        ("the same, gliding, furled", beating(furled, 0.0)),
        ("the same, gliding, spread", beating(tailed, 0.0)),
    ):
        row(table, name, bird)
    console.print(table)
    table = columns("Chapter 6's bird, flapping, tail spread: one value changed")
    for name, values in islice(VARIATIONS.items(), 2 if coarse else None):
        row(table, name, tailed.with_values(values))
    console.print(table)
    table = columns("The same, by the number of elements a wing")
    for elements in (4, 8) if coarse else (16, 32, 64):
        row(table, str(elements), tailed.with_values({"wing.discretisation": elements}))
    console.print(table)
    sprung = shoulders(tailed, STIFFNESSES[:1] if coarse else STIFFNESSES)
    for table in (sprung, uneven(tailed), turning(tailed)):
        console.print(table)
    parts = np.linspace(0.0, 1.0, 3 if coarse else 21)
    slow = moduli(tailed, parts)
    first = int(np.argmax(slow["spiral"] > 1.0))
    part = np.interp(1.0, slow["spiral"][first - 1 : first + 1], parts[first - 1 : first + 1])
    console.print(f"The spiral is unstable beyond {part:.2f} of the amplitudes (tail spread).")
    picture(parts, slow).savefig(out / "lateral_modes.png", dpi=120)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", nargs="?", type=Path, default=Path("results"))
    parser.add_argument("--coarse", action="store_true", help="few flights, coarse wings: quick")
    options = parser.parse_args()
    main(options.directory, coarse=options.coarse)
