"""Exact loads of a flat section that heaves and pitches, of a start, and of a plate on a spring.

Lengths are in half chords, times in half chords travelled, with the complex amplitudes of motions
exp(i k t), k the reduced frequency: of heaving upwards h, in half chords, and of pitching nose up
alpha, about an axis `axis` half chords behind the middle (-1 is the leading edge). T. Theodorsen,
NACA Report 496, 1935; I. E. Garrick, NACA Report 567, 1936.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad
from scipy.special import i0, i1, k0, k1

from birdmb.studies.flight_regime import wake_deficiency

Deficiency = Callable[[float], complex]


@dataclass(frozen=True)
class OscillatingSection:
    """A section that heaves and pitches at one frequency.

    Attributes:
        k: reduced frequency, angular frequency times half the chord by the speed.
        heave: complex amplitude upwards, half chords.
        pitch: complex amplitude nose up, rad.
        axis: of pitching, half chords behind the middle of the chord.
        deficiency: what of the quasi-steady circulation a wake leaves, by k: Theodorsen's function.
    """

    k: float
    heave: complex
    pitch: complex
    axis: float
    deficiency: Deficiency = wake_deficiency

    @property
    def circulatory(self) -> complex:
        """Amplitude of what of the downwash makes circulation."""
        return self.deficiency(self.k) * self.downwash

    @property
    def downwash(self) -> complex:
        """Amplitude of the normal velocity at the three-quarter-chord point, over the speed."""
        rising = 1j * self.k
        return self.pitch - rising * self.heave + (0.5 - self.axis) * rising * self.pitch

    @property
    def lift(self) -> complex:
        """Amplitude of the lift coefficient."""
        k, a = self.k, self.axis
        apparent = np.pi * (k**2 * self.heave + (1j * k + a * k**2) * self.pitch)
        return complex(apparent + 2.0 * np.pi * self.circulatory)

    @property
    def moment(self) -> complex:
        """Amplitude of the moment coefficient about the axis, nose up."""
        k, a = self.k, self.axis
        of_pitch = -1j * k * (0.5 - a) + (0.125 + a**2) * k**2
        apparent = np.pi * (a * k**2 * self.heave + of_pitch * self.pitch)
        circulatory = 2.0 * np.pi * (a + 0.5) * self.circulatory
        return complex(0.5 * (apparent + circulatory))

    @property
    def thrust(self) -> float:
        """Mean thrust coefficient: the leading edge's suction, and the lift's part forwards."""
        suction = self.circulatory - 0.5j * self.k * self.pitch
        lift_forwards = -0.5 * (complex(self.pitch).conjugate() * self.lift).real
        return float(np.pi * abs(suction) ** 2 + lift_forwards)

    @property
    def power(self) -> float:
        """Mean power coefficient of what moves the section."""
        heaving, pitching = 1j * self.k * self.heave, 1j * self.k * self.pitch
        # The moment coefficient counts in chords, the rate in half chords.
        given = -(heaving.conjugate() * self.lift) - 2.0 * (pitching.conjugate() * self.moment)
        return float(0.5 * given.real)


def no_deficiency(_: float) -> complex:
    """What a quasi-steady wake leaves of the circulation: all."""
    return 1.0


def wagner_function(half_chords: float) -> float:
    """Part of its final circulation that a section has after a start, W. R. Sears's integral."""

    def kernel(x: float) -> float:
        slow = (k0(x) - k1(x)) ** 2 + (np.pi * (i0(x) + i1(x))) ** 2
        return float(np.exp(-half_chords * x) / (x**2 * slow))

    missing = quad(kernel, 0.0, 1.0, limit=200)[0] + quad(kernel, 1.0, 300.0, limit=200)[0]
    return 1.0 - float(missing)


@dataclass(frozen=True)
class SprungPlate:
    """A flat plate that heaves at an axis about which a spring holds it.

    I alpha'' + K alpha is the fluid's moment about the axis, all per span. M. N. J. Moore, Journal
    of Fluid Mechanics 757, 2014, has such a plate.

    Attributes:
        inertia: I, in the fluid's density times half chords to the fourth power.
        stiffness: K, in density times speed squared times half chords squared.
        axis: half chords behind the middle of the chord; the leading edge by default.
    """

    inertia: float
    stiffness: float
    axis: float = -1.0

    def pitch(self, k: float, of_heave: complex, of_pitch: complex) -> complex:
        """Pitch amplitude (rad) per half chord of heave.

        By the fluid's moment coefficients per half chord of heave and per rad.
        """
        # They count in half the density times chords squared.
        return 2.0 * of_heave / (self.stiffness - self.inertia * k**2 - 2.0 * of_pitch)

    def oscillating(self, k: float, deficiency: Deficiency = wake_deficiency) -> OscillatingSection:
        """The plate as it heaves by half a chord with this reduced frequency."""
        moments = [
            OscillatingSection(k, heave, pitch, self.axis, deficiency).moment
            for heave, pitch in ((1.0, 0.0), (0.0, 1.0))
        ]
        return OscillatingSection(k, 1.0, self.pitch(k, *moments), self.axis, deficiency)
