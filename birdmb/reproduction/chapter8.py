"""Chapter 8: the compliant shoulder, table 8.1."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial

from birdmb.models import MultibodyModel
from birdmb.orbits import find_limit_cycle
from birdmb.reproduction.published import Case, Published
from birdmb.reproduction.quantities import bird, flight_quantities

# k (N m/rad), C (N m s/rad): largest |multiplier|, P_act (W), P_g (W)
TABLE_8_1 = {
    (20.0, 0.2): (1.37, 1.42, 7.41),
    (15.0, 0.2): (1.31, 0.25, 8.90),
    (10.0, 0.2): (1.22, -2.18, 11.92),
    (20.0, 0.1): (1.39, 0.33, 8.45),
    (20.0, 0.0): (1.45, -3.76, 12.55),
}
_REASON = "the printed inertia has no such flight, and no reading of the text gives all five points"


def _flight(k: float, c: float) -> Mapping[str, float]:
    sprung = bird("ibis_thesis_ch8").with_joint("shoulder.flap", stiffness=k, damping=c)
    return flight_quantities(find_limit_cycle(MultibodyModel(sprung)))


def _cases() -> Iterator[Case]:
    for (k, c), (largest, active, potential) in TABLE_8_1.items():
        yield Case(
            "8",
            f"table 8.1, k = {k:g} N m/rad, C = {c:g} N m s/rad, 0.002 kg m2 a segment",
            "birdmb cycle ibis_thesis_ch8 "
            f"--set shoulder.flap.stiffness={k:g} --set shoulder.flap.damping={c:g}",
            partial(_flight, k, c),
            (
                Published("largest |multiplier|", "", largest, 0.005, "contradicts", _REASON),
                Published("P_act", "W", active, 0.005, "contradicts", _REASON),
                Published("P_g", "W", potential, 0.005, "contradicts", _REASON),
            ),
        )


CASES = tuple(_cases())
