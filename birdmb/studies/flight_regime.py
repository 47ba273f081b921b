"""The dimensionless numbers of a bird before it flies, and where they are outside the theory.

At the speed at which the wings, stretched out, carry the weight with a lift coefficient of 0.5.

- On short wings a lifting line has too much lift: at an aspect ratio of 4, 8 % more than by the
  slope of H. B. Helmbold (Jahrbuch der Deutschen Luftfahrtforschung, 1942).
- Birds from 10 g to 10 kg fly at Reynolds numbers of 1e4 to 1e6 (G. R. Spedding et al., J. Exp.
  Biol. 211, 2008), and thin plates keep their lift down to 1e4 (J. Winslow et al., J. Aircraft 55,
  2018). Insects, below that, fly by separated flow (S. P. Sane, J. Exp. Biol. 206, 2003).
- What an unsteady wake leaves of the lift is C(k) of T. Theodorsen (NACA Report 496, 1935); the
  limit of k is that of `birdmb.studies.validity`.
- Animals cruise at Strouhal numbers of 0.2 to 0.4 (G. K. Taylor et al., Nature 425, 2003). Other
  ones are no mistake.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.special import hankel2

from birdmb.studies.driven_motion import is_still, tip_height
from birdmb.studies.validity import LARGEST_REDUCED_FREQUENCY
from birdmb.topology import Bird
from birdmb.wing.outline import span_and_area

LIFT_COEFFICIENT = 0.5
LEAST_ASPECT_RATIO = 4.0
LEAST_REYNOLDS_NUMBER, LARGEST_REYNOLDS_NUMBER = 1e4, 1e7


@dataclass(frozen=True)
class FlightRegime:
    """Sizes and dimensionless numbers of a bird; NaN where nothing carries it or nothing flaps."""

    span: float
    """Of the wings stretched out, m."""
    area: float
    """Likewise, with the gap over the body, m2."""
    speed: float
    """At which the wings carry the weight with a lift coefficient of 0.5, m/s."""
    reynolds_number: float
    """Of the mean chord at that speed."""
    reduced_frequency: float
    """k = pi f c/U of the mean chord c at that speed U; that is omega c/(2 U)."""
    strouhal_number: float
    """f A/U at that speed, with A the distance between the highest and lowest place of the tips."""

    @property
    def aspect_ratio(self) -> float:
        """Span squared by area."""
        return self.span**2 / self.area


def flight_regime(bird: Bird) -> FlightRegime:
    """Compute a bird's sizes and dimensionless numbers.

    Raises:
        StateError: an edge of the wing has no extent.
    """
    span, area = span_and_area(bird)
    chord = area / span
    weight, density = bird.total_mass * bird.gravity, bird.air.density
    carried = weight > 0.0 and density > 0.0
    speed = (
        float(np.sqrt(2.0 * weight / (density * area * LIFT_COEFFICIENT))) if carried else np.nan
    )
    frequency = np.nan if is_still(bird) else bird.gait.frequency
    return FlightRegime(
        span=span,
        area=area,
        speed=speed,
        reynolds_number=speed * chord / bird.air.kinematic_viscosity,
        reduced_frequency=np.pi * frequency * chord / speed,
        strouhal_number=frequency * tip_height(bird) / speed,
    )


def regime_warnings(regime: FlightRegime, *, with_memory: bool = False) -> Iterator[str]:
    """A sentence for each number that is outside the theory; of air `with_memory` or without."""
    aspect_ratio = regime.aspect_ratio
    if aspect_ratio < LEAST_ASPECT_RATIO:
        yield (
            f"the aspect ratio of the wings is {aspect_ratio:.3g}, below {LEAST_ASPECT_RATIO:g}: a "
            f"lifting line gives them {lift_excess(aspect_ratio):.0%} too much lift per incidence. "
            f"Check the lengths, or take the loads for rough."
        )
    at = (
        f"at {regime.speed:.3g} m/s, where the wings carry the weight with a lift coefficient of "
        f"{LIFT_COEFFICIENT:g}"
    )
    reynolds_number = regime.reynolds_number
    if reynolds_number < LEAST_REYNOLDS_NUMBER:
        yield (
            f"the Reynolds number of the mean chord is {reynolds_number:.2g} {at}: below "
            f"{LEAST_REYNOLDS_NUMBER:.0e} flow does not stay attached as the model's does. Check "
            f"lengths and masses, or take the loads for rough."
        )
    if reynolds_number > LARGEST_REYNOLDS_NUMBER:
        yield (
            f"the Reynolds number of the mean chord is {reynolds_number:.2g} {at}: nothing that "
            f"flaps flies above {LARGEST_REYNOLDS_NUMBER:.0e}. Check lengths, masses and "
            f"air.kinematic_viscosity."
        )
    k = regime.reduced_frequency
    if k > LARGEST_REDUCED_FREQUENCY and not with_memory:
        deficiency = wake_deficiency(k)
        yield (
            f"the reduced frequency is {k:.2g} {at}, above {LARGEST_REDUCED_FREQUENCY:g}: the "
            f"unsteady wake, which the model leaves out, would leave {abs(deficiency):.0%} of what "
            f"the beat changes of the lift, {-np.degrees(np.angle(deficiency)):.0f} degrees later. "
            f'Check gait.frequency, or take air.wake = "unsteady".'
        )


def lift_excess(aspect_ratio: float) -> float:
    """Part by which the lift slope of Prandtl's elliptical wing exceeds that of Helmbold's."""
    slender = 2.0 / aspect_ratio
    return float((np.hypot(1.0, slender) + slender) / (1.0 + slender) - 1.0)


def wake_deficiency(reduced_frequency: float) -> complex:
    """Theodorsen's function C(k), the part of the quasi-steady lift of circulation."""
    one, zero = hankel2(1, reduced_frequency), hankel2(0, reduced_frequency)
    return complex(one / (one + 1j * zero))
