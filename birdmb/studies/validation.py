"""What the thesis published against what is computed here.

Each case is flown by the command that it names, so that a reader can take it from there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from birdmb.errors import BirdmbError
from birdmb.models import MultibodyModel, RigidModel
from birdmb.orbits import OdeModel, find_limit_cycle
from birdmb.studies.trim import trim_flight
from birdmb.topology import Bird, load_bird

Quantities = Mapping[str, float]
_STATES = ("u, m/s", "w, m/s", "q, rad/s", "theta, rad")


@dataclass(frozen=True)
class Case:
    """A published case: where from, the command behind it, its numbers, and how to compute them."""

    source: str
    command: str
    published: Quantities
    compute: Callable[[], Quantities]


@dataclass(frozen=True)
class Comparison:
    """A case with what was computed; `failure` says why nothing was."""

    case: Case
    computed: Quantities
    failure: str = ""

    def difference(self, quantity: str) -> float:
        """Computed minus published."""
        return self.computed[quantity] - self.case.published[quantity]


def published_cases() -> list[Case]:
    """The cases of chapters 5 to 8 and appendix A, flown by the birds of the package."""

    def bird(name: str, **values: object) -> Bird:
        changes = {key.replace("__", "."): value for key, value in values.items()}
        return load_bird(name).with_values(changes)

    thesis = dict(zip(_STATES, (18.24, -1.93, -0.10, -0.115), strict=True)) | {
        "multiplier 1": 1.40,
        "multiplier 2, Re": 0.829,
        "multiplier 2, Im": 0.260,
        "multiplier 4": 0.212,
    }
    at_4347 = dict(zip(_STATES, (18.511, -2.110, -0.118, -0.1164), strict=True))
    multibody = dict(zip(_STATES, (18.516, -2.102, -0.120, -0.1161), strict=True))
    rigid = "birdmb cycle ibis --model rigid"
    published = {"wing__discretisation": "published"}
    amplitude = {"shoulder__flap__amplitude_deg": 43.47}
    return [
        Case(
            "chapter 5, reference gait, published discretisation",
            f"{rigid} --set wing.discretisation=published",
            thesis,
            lambda: _orbit(RigidModel(bird("ibis", **published))),
        ),
        Case(
            "chapter 5, reference gait, converged",
            rigid,
            thesis,
            lambda: _orbit(RigidModel(bird("ibis"))),
        ),
        Case(
            "chapter 5, level flight, published discretisation",
            "python examples/bird_level_flight.py",
            {"flap amplitude, deg": 43.47},
            lambda: _level(bird("ibis", **published)),
        ),
        Case(
            "chapter 6, tail 40 deg open, level, tail at 2 deg to the body",
            "birdmb trim ibis_tail --model rigid",
            _CHAPTER_6,
            lambda: _with_tail(bird("ibis_tail")),
        ),
        Case(
            "chapter 6, tail along the body, without downwash, published discretisation",
            "birdmb trim ibis_tail --model rigid --set tail.incidence_deg=0 "
            "--set tail.downwash=none --set wing.discretisation=published",
            _CHAPTER_6,
            lambda: _with_tail(
                bird("ibis_tail", **published, tail__incidence_deg=0.0, tail__downwash="none")
            ),
        ),
        Case(
            "chapter 7, rigid bird, published discretisation",
            f"{rigid} --set shoulder.flap.amplitude_deg=43.47 --set wing.discretisation=published",
            at_4347,
            lambda: _orbit(RigidModel(bird("ibis", **published, **amplitude))),
        ),
        Case(
            "chapter 7, multibody bird with wings of 1e-5 kg, published discretisation",
            "birdmb cycle ibis_massless --set wing.discretisation=published",
            multibody,
            lambda: _orbit(MultibodyModel(bird("ibis_massless", **published))),
        ),
        *_chapter_8(),
        *_appendix_a(),
    ]


def compare(cases: list[Case]) -> Iterator[Comparison]:
    """Compute the cases one after the other; a case without an orbit says so."""
    for case in cases:
        try:
            yield Comparison(case, case.compute())
        except BirdmbError as error:
            yield Comparison(case, {}, str(error))


def _orbit(model: RigidModel | MultibodyModel) -> Quantities:
    cycle = find_limit_cycle(model)
    real = cycle.multipliers[np.abs(cycle.multipliers.imag) < 1e-9].real
    pair = cycle.multipliers[cycle.multipliers.imag > 1e-9]
    found = dict(zip(_STATES, map(float, cycle.x0), strict=False))
    return found | {
        "multiplier 1": float(real[0]),
        "multiplier 2, Re": float(pair[0].real),
        "multiplier 2, Im": float(pair[0].imag),
        "multiplier 4": float(real[1]),
    }


def _level(bird: Bird) -> Quantities:
    name = "shoulder.flap.amplitude_deg"
    return {"flap amplitude, deg": float(trim_flight(bird, {name: (40.0, 47.0)}).values[name])}


_CHAPTER_6 = {
    "largest |multiplier|": 0.96,
    "power, W": 16.7,
    "speed, m/s": 14.0,
    "forearm.roll offset, deg": -5.5,
}


def _with_tail(bird: Bird) -> Quantities:
    trim = trim_flight(bird)
    (roll,) = trim.values.values()
    largest = float(np.abs(trim.cycle.multipliers).max())
    values = (largest, trim.cycle.power, trim.cycle.mean_speed, roll)
    return dict(zip(_CHAPTER_6, values, strict=True))


def _chapter_8() -> Iterator[Case]:
    numbers = {
        (20, 0.2): (1.37, 1.42, 7.41),
        (15, 0.2): (1.31, 0.25, 8.90),
        (10, 0.2): (1.22, -2.18, 11.92),
        (20, 0.1): (1.39, 0.33, 8.45),
        (20, 0.0): (1.45, -3.76, 12.55),
    }
    for (k, c), published in numbers.items():

        def computed(k: float = k, c: float = c) -> Quantities:
            bird = load_bird("ibis_thesis_ch8")
            bird = bird.with_joint("shoulder.flap", stiffness=k, damping=c)
            flight = find_limit_cycle(MultibodyModel(bird))
            values = (abs(flight.multipliers[0]), flight.power, flight.potential_power)
            return dict(zip(_CHAPTER_8, map(float, values), strict=True))

        yield Case(
            f"chapter 8, k = {k} N m/rad, C = {c} N m s/rad, 0.002 kg m2 a segment",
            "birdmb cycle ibis_thesis_ch8 "
            f"--set shoulder.flap.stiffness={k} --set shoulder.flap.damping={c}",
            dict(zip(_CHAPTER_8, published, strict=True)),
            computed,
        )


_CHAPTER_8 = ("largest |multiplier|", "P_act, W", "P_g, W")


def _appendix_a() -> Iterator[Case]:
    starts = {3.5: ([-1.66, 4.24, 0.32], 5.9), 5.0: ([5.39, -4.12, 0.13], 11.9)}
    numbers = {3.5: (5.920340, 0.812252), 5.0: (11.904275, 0.572052)}
    for c, (period, multiplier) in numbers.items():

        def computed(c: float = c) -> Quantities:
            guess, period_guess = starts[c]
            model = OdeModel(
                lambda _, x: np.array([-x[1] - x[2], x[0] + 0.15 * x[1], 0.2 + x[2] * (x[0] - c)]),
                ("x", "y", "z"),
            )
            cycle = find_limit_cycle(model, guess, period_guess=period_guess, segments=4)
            others = np.delete(cycle.multipliers, cycle.trivial_index or 0)
            return {"period": cycle.period, "largest |multiplier|": float(np.abs(others).max())}

        yield Case(
            f"appendix A, Roessler's system, a = 0.15, b = 0.2, c = {c:g}",
            "python examples/orbits_roessler.py",
            {"period": period, "largest |multiplier|": multiplier},
            computed,
        )
