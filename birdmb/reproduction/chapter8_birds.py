"""The birds that chapter 8 may mean, and their flights on a sprung shoulder."""

from __future__ import annotations

import numpy.typing as npt

from birdmb.models import FlightCycle, MultibodyModel
from birdmb.orbits import FloquetResult, find_limit_cycle
from birdmb.reproduction.quantities import FLAP_AMPLITUDE, PUBLISHED_WING, bird
from birdmb.reproduction.tail_study import SWEEP_OFFSET
from birdmb.topology import Bird

TABLE_8_1 = {
    (20.0, 0.2): (1.37, 1.42, 7.41),
    (15.0, 0.2): (1.31, 0.25, 8.90),
    (10.0, 0.2): (1.22, -2.18, 11.92),
    (20.0, 0.1): (1.39, 0.33, 8.45),
    (20.0, 0.0): (1.45, -3.76, 12.55),
}
"""k (N m/rad) and C (N m s/rad): largest |multiplier|, P_act and P_g (W)."""

LIGHT_ELEMENTS = 16
"""Elements a wing of the birds whose shoulder flaps first."""

_BONES = ("humerus", "forearm", "hand")
_ITERATIONS = 25


def with_inertia(one: Bird, moment: float) -> Bird:
    """The bird with this moment of inertia (kg m2) about every axis of every segment."""
    return one.with_values({f"segments.{bone}.inertia": [moment] * 3 for bone in _BONES})


def flap_first(one: Bird) -> Bird:
    """The bird whose shoulder flaps before it pitches."""
    pitch, flap, *others = one.model_dump()["joints"]
    return one.model_validate({**one.model_dump(), "joints": [flap, pitch, *others]})


def light_and_flap_first() -> Bird:
    """The bird with the inertias of slender bones whose shoulder flaps before it pitches."""
    return flap_first(bird("ibis_compliant_shoulder", wing__discretisation=LIGHT_ELEMENTS))


def readings() -> dict[str, Bird]:
    """The birds that the text may mean, by what is read."""
    slender, isotropic = bird("ibis_compliant_shoulder"), bird("ibis_thesis_ch8")
    return {
        "slender bones": slender,
        "slender bones; flap before pitch": light_and_flap_first(),
        "point masses": with_inertia(slender, 0.0),
        "0.0003 kg m2": with_inertia(slender, 0.0003),
        "0.002 kg m2": isotropic,
        "0.0033 kg m2": with_inertia(slender, 0.0033),
        "0.01 kg m2; as printed": with_inertia(slender, 0.01),
        "0.002; published discretisation": isotropic.with_values(PUBLISHED_WING),
        "0.002; flap before pitch": flap_first(isotropic),
        "0.002; flap amplitude 43.47 deg": isotropic.with_values({FLAP_AMPLITUDE: 43.47}),
        "0.002; sweep offset -19.5 deg": isotropic.with_values({SWEEP_OFFSET: -19.5}),
    }


def sprung_flight(
    one: Bird,
    stiffness: float,
    damping: float,
    guess: npt.ArrayLike | FloquetResult | None = None,
) -> FlightCycle:
    """Limit cycle with a spring (N m/rad) and a damper (N m s/rad) at the shoulder's flap.

    Raises:
        OrbitError, StateError: as for `find_limit_cycle`.
    """
    sprung = one.with_joint("shoulder.flap", stiffness=stiffness, damping=damping)
    return find_limit_cycle(MultibodyModel(sprung), guess, max_iterations=_ITERATIONS)
