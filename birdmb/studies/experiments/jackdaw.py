"""Power of a jackdaw in level flight, against a flight model fitted to birds.

M. Klein Heerenbrink, L. C. Johansson and A. Hedenstroem, Proceedings of the Royal Society A 471,
2015 (their program afpt): aerodynamic power of a bird of 0.215 kg, with a span of 0.67 m, a wing
area of 0.0652 m2 and 5.95 wingbeats per second.

The bird here is the pigeon of the package scaled to that mass and frequency, and its bones and
feathers so that span and area, with the body between the wings, are theirs in the middle of the
downstroke. Roll of the forearm and flap amplitude level it at each speed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from birdmb.errors import BirdmbError
from birdmb.studies.experiments.comparison import QUASI_STEADY, UNSTEADY, Comparison, Experiment
from birdmb.studies.scaling import scale_bird
from birdmb.studies.trim import Trim, TrimGuess, trim_flight
from birdmb.topology import Bird, load_bird

MASS, FREQUENCY = 0.215, 5.95  # kg, Hz
SPAN, AREA = 0.67, 0.0652  # m, m2
# m/s: W.
CRUISE = 12.0
POWERS = {6.0: 2.37, 8.0: 2.09, 10.0: 2.29, 12.0: 2.83, 14.0: 3.67, 16.0: 4.83}
# On those of the scaled bird, for span and area.
_BONES, _FEATHERS = 1.260606, 0.995129
WAKES: Mapping[str, Mapping[str, object]] = {QUASI_STEADY: {}, UNSTEADY: {"air.wake": "unsteady"}}


def jackdaw(values: Mapping[str, object]) -> Bird:
    """The bird, with other values by dotted name."""
    scaled = scale_bird(load_bird("pigeon"), MASS, span=SPAN, frequency=FREQUENCY).bird
    sizes: dict[str, object] = {"name": "jackdaw", "wing.root.y": scaled.wing.root.y * _BONES}
    for name, segment in scaled.segments.items():
        sizes[f"segments.{name}.length"] = segment.length * _BONES
        inertia = np.array(segment.inertia) * _BONES**2
        sizes[f"segments.{name}.inertia"] = inertia.tolist()
        sizes[f"segments.{name}.centre_of_mass"] = [x * _BONES for x in segment.centre_of_mass]
    for feather in scaled.feathers:
        sizes[f"feathers.{feather.name}.length"] = feather.length * _FEATHERS
    return scaled.with_values({**sizes, **values})


def level_flights(values: Mapping[str, object]) -> dict[float, Trim | str]:
    """The jackdaw's level flights by speed (m/s), or why there is none.

    Followed up and down from the speed of cruise, so that each starts from its neighbour's.
    """
    bird, speeds = jackdaw(values), sorted(POWERS)
    cruise = trim_flight(bird, speed=CRUISE)
    found: dict[float, Trim | str] = {CRUISE: cruise}
    middle = speeds.index(CRUISE)
    for onwards in (speeds[middle + 1 :], speeds[:middle][::-1]):
        last = cruise
        for speed in onwards:
            guess = TrimGuess(last.values, last.cycle)
            try:
                last = trim_flight(bird, speed=speed, guess=guess)
            except BirdmbError as error:
                found[speed] = str(error)
            else:
                found[speed] = last
    return found


def _compare() -> Iterator[Comparison]:
    flights = {name: level_flights(values) for name, values in WAKES.items()}
    for speed, power in POWERS.items():
        computed, failures = {}, []
        for name, found in flights.items():
            flight = found[speed]
            if isinstance(flight, str):
                failures.append(f"{name}: {flight}")
            else:
                computed[name] = float(flight.cycle.power)
        quantity = f"aerodynamic power at {speed:g} m/s"
        yield Comparison("G", quantity, "W", power, computed, failure=" ".join(failures))


EXPERIMENT = Experiment(
    "G",
    "power of a jackdaw",
    "a flight model of birds, M. Klein Heerenbrink, L. C. Johansson and A. Hedenstroem 2015",
    _compare,
)
