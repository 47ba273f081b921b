"""The tail of chapter 6 of the thesis: what each correction of the published program changes.

Run `python examples/chapter6.py`; it takes some minutes. It levels the flight by the offset of the
forearm's roll with the tail 40 degrees open, and finds the opening at which the flight becomes
stable, for the tail as it is here and for the ways in which the published program had it.
"""

from collections.abc import Mapping
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import brentq

import birdmb
from birdmb.aerodynamics.prescribed import at_phase, symmetric_loads
from birdmb.aerodynamics.tail import tail_force, tail_influence, tail_surface
from birdmb.aerodynamics.twist_loads import wing_flow

IBIS = Path(__file__).parent.parent / "topologies" / "ibis_tail.toml"
ROLL, OPENING = "forearm.roll.offset_deg", "tail.opening_deg"
ALONG = {"tail.incidence_deg": 0.0}
FILAMENTS = 3  # of the 17 that leave 16 elements


class ProgramTail(birdmb.RigidModel):
    """The rigid bird with the published program's errors in the tail.

    Its pitch rate has the wrong sign in the tail's wind; of the wake only the three vortices at one
    wing tip act on it, beside the bound vortices. One may be mended by itself.
    """

    wrong_rate = True
    wrong_wake = True

    def __init__(self, bird: birdmb.Bird, **options: Any) -> None:
        """Take the tail off the bird, for the tail's loads are added here."""
        super().__init__(bird.model_copy(update={"tail": None}), **options)
        tail = bird.tail
        if self.wrong_wake and tail is not None:
            tail = tail.model_copy(update={"downwash": "wake and bound"})
        self._surface = tail_surface(bird.model_copy(update={"tail": tail}))

    def _influence(self, node: np.ndarray) -> np.ndarray:
        surface = self._surface
        if not self.wrong_wake:
            return tail_influence(surface, node)
        found = tail_influence(surface._replace(in_wake=False), node)
        for k in range(len(node) - FILAMENTS, len(node)):
            dx, dz = surface.x - node[k, 0], surface.z - node[k, 2]
            across = node[k, 1] ** 2 + dz**2
            down = node[k, 1] * (1 - dx / np.hypot(dx, np.sqrt(across))) / (4 * np.pi * across)
            found[1, k - 1] += down
            if k < len(node) - 1:
                found[1, k] -= down
        return found

    def _rates(self, table: Any, k: int, x: np.ndarray, *, influence: np.ndarray) -> np.ndarray:
        u, w, q, theta = x
        aero, body = self._constants
        twist, no_derivatives = np.array([u, 0.0, w, 0.0, q, 0.0]), np.empty(0, int)
        elements = at_phase(table.elements, k)
        flow = wing_flow(elements, elements.velocity, twist, no_derivatives)
        induced = influence @ table.inverse[k] @ flow.bound[:, 0]
        surface, turning = self._surface, -q if self.wrong_rate else q
        wind = np.array(
            [-u - turning * surface.z + induced[0], 0.0, -w + turning * surface.x + induced[1]]
        )
        fx, _, fz = tail_force(surface, aero.density, wind)[:, 0]
        of_tail = np.array([fx, fz, surface.z * fx - surface.x * fz])
        forces = symmetric_loads(table, k, aero, twist, no_derivatives)[::2, 0] + of_tail
        s, c = np.sin(theta), np.cos(theta)
        return np.array(
            [
                -q * w - body.gravity * s + forces[0] / body.mass,
                q * u + body.gravity * c + forces[1] / body.mass,
                forces[2] / body.inertia[1, 1],
                q,
            ]
        )

    def _along(
        self, table: Any, phase: Any, _times: Any, states: Any, *, slopes_wanted: bool
    ) -> tuple[np.ndarray, np.ndarray]:
        wing = table.right
        influences = {k: self._influence(wing.elements.node[k]) for k in set(phase.tolist())}
        steps = np.diag(1e-5 * self.state_scale)
        rates, slopes = [], []
        for k, x in zip(phase.tolist(), states, strict=True):
            at = partial(self._rates, wing, k, influence=influences[k])
            rates.append(at(x))
            if slopes_wanted:
                columns = [(at(x + d) - at(x - d)) / (2 * d.sum()) for d in steps]
                slopes.append(np.column_stack(columns))
        return np.array(rates), np.array(slopes)

    def _integrate(self, x0: Any, t0: float, t1: float) -> tuple[Any, Any, Any]:
        steps = self._steps(t0, t1)
        table = self._table(t0 % self.bird.period, t1 - t0, steps).right
        influences = [self._influence(node) for node in table.elements.node]
        h, start = (t1 - t0) / steps, np.asarray(x0, dtype=float)

        def flown(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            states, rates = [x], []
            for i in range(steps):
                k1 = self._rates(table, 2 * i, x, influence=influences[2 * i])
                k2 = self._rates(table, 2 * i + 1, x + h / 2 * k1, influence=influences[2 * i + 1])
                k3 = self._rates(table, 2 * i + 1, x + h / 2 * k2, influence=influences[2 * i + 1])
                k4 = self._rates(table, 2 * i + 2, x + h * k3, influence=influences[2 * i + 2])
                x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
                states.append(x)
                rates.append(k1)
            rates.append(self._rates(table, 2 * steps, x, influence=influences[2 * steps]))
            return np.array(states), np.array(rates)

        states, rates = flown(start)
        sizes = 1e-5 * self.state_scale
        columns = [
            (flown(start + d)[0][-1] - flown(start - d)[0][-1]) / (2 * d.sum())
            for d in np.diag(sizes)
        ]
        return states, rates, np.column_stack(columns)


class ProgramRate(ProgramTail):
    """The wrong sign of the pitch rate alone."""

    wrong_wake = False


class ProgramWake(ProgramTail):
    """The lost vortices alone."""

    wrong_rate = False


CASES: Mapping[str, tuple[dict[str, Any], type[birdmb.RigidModel]]] = {
    "as here": ({}, birdmb.RigidModel),
    "chord 0.25 m": ({"tail.chord": 0.25}, birdmb.RigidModel),
    "tail along the body": (ALONG, birdmb.RigidModel),
    "... bound vortices too": ({**ALONG, "tail.downwash": "wake and bound"}, birdmb.RigidModel),
    "... no downwash": ({**ALONG, "tail.downwash": "none"}, birdmb.RigidModel),
    "... chord 0.25 m": ({**ALONG, "tail.chord": 0.25}, birdmb.RigidModel),
    "... pitch rate of wrong sign": (ALONG, ProgramRate),
    "... three vortices, bound ones": (ALONG, ProgramWake),
    "... both: the program's tail": (ALONG, ProgramTail),
    "... and its lifting line": ({**ALONG, "wing.discretisation": "published"}, ProgramTail),
}


def level(bird: birdmb.Bird, model: Any, guess: Any = None) -> birdmb.Trim:
    """Level flight by the roll offset."""
    return birdmb.trim_flight(bird, {ROLL: (-30.0, 30.0)}, model=model, guess=guess)


def stable_opening(bird: birdmb.Bird, model: Any) -> float:
    """Opening (degrees) at which |Lambda|max of level flight first falls through 1."""

    def growth(opening: float) -> float:
        cycle = level(bird.with_values({OPENING: opening}), model).cycle
        return float(np.log(np.abs(cycle.multipliers).max()))

    openings = np.arange(0.0, 46.0, 5.0)
    for before, after in pairwise(openings):
        if growth(after) < 0:
            return float(brentq(growth, before, after, xtol=1e-5))
    return np.nan


def main() -> None:
    bird = birdmb.load_bird(IBIS)
    print("Tail 40 deg open, flap amplitude 42 deg, sweep offset -14.5 deg, level:")
    print(
        "case                             roll, deg  speed, m/s  |Lambda|max  power, W  "
        "tail, deg      stable from"
    )
    for name, (values, kind) in CASES.items():
        changed = bird.with_values(values)
        trim = level(changed, kind)
        cycle = trim.cycle
        angles = np.degrees(cycle.beat.tail_angle)
        tail = f"{angles.min():5.1f}..{angles.max():4.1f}" if np.isfinite(angles).all() else "-"
        print(
            f"{name:32} {trim.values[ROLL]:9.2f} {cycle.mean_speed:11.3f} "
            f"{np.abs(cycle.multipliers).max():12.4f} {cycle.power:9.3f}  {tail:12} "
            f"{stable_opening(changed, kind):10.3f} deg",
            flush=True,
        )
    print(
        "\nThe opening from which level flight is stable, by sweep offset and flap amplitude, deg:"
    )
    amplitudes = (32.0, 36.0, 40.0, 42.0)
    print("sweep offset   " + "".join(f"{a:10.0f}" for a in amplitudes))
    for offset in (-14.5, -13.0, -12.0, -11.0):
        row = []
        for amplitude in amplitudes:
            gait = {"shoulder.sweep.offset_deg": offset, "shoulder.flap.amplitude_deg": amplitude}
            try:
                row.append(f"{stable_opening(bird.with_values(gait), birdmb.RigidModel):10.2f}")
            except birdmb.BirdmbError:
                row.append("         -")
        print(f"{offset:12.1f}   " + "".join(row), flush=True)
    print("\nIts error at -14.5 and 42 deg, by elements a wing and steps a beat:")
    for elements, steps in ((16, 60), (32, 60), (32, 120), (64, 60)):
        finer = bird.with_values({"wing.discretisation.elements": elements})

        def model(b: birdmb.Bird, steps: int = steps) -> birdmb.RigidModel:
            return birdmb.RigidModel(b, steps_per_beat=steps)

        print(f"{elements:4} {steps:4}  {stable_opening(finer, model):.4f} deg", flush=True)


if __name__ == "__main__":
    main()
