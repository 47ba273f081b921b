"""Loads of a wing that heaves, pitches and flaps in a stream."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError
from birdmb.studies.moving_wing.memory import lags_of_start, periodic_lags, settled_lags
from birdmb.studies.moving_wing.motion import WingMotion
from birdmb.studies.moving_wing.moving import InstantLoads, MovingWing
from birdmb.studies.moving_wing.plane_wing import PlaneWing
from birdmb.summary import Fact, Summarised

Wake = Literal["quasi-steady", "unsteady"]
_FEWEST_INSTANTS, _FEWEST_ELEMENTS = 3, 4


@dataclass(frozen=True, repr=False)
class MovingWingLoads(Summarised):
    """Loads of a moving wing at K instants, of both halves unless another thing is said.

    Attributes:
        wing: the wing.
        motion: its motion.
        speed: of the stream, m/s.
        density: of the fluid, kg/m3.
        wake: "quasi-steady" or "unsteady".
        times: (K,) s; of a periodic solution over a period, the end left out.
        lift: upwards (K,) N.
        thrust: against the stream (K,) N.
        moment: about the pitch axis, nose up (K,) N m.
        power: that moves the wing, apart from that which tows it (K,) W.
        wake_power: energy left in the wake per time (K,) W.
        profile_power: what profile drag and the profile's moment take (K,) W.
        apparent_energy: kinetic energy of the apparent mass (K,) J.
        positions: distances of the right half's N elements from the root, along the line (N,) m.
        widths: of the elements (N,) m.
        circulation: of the right half's elements (K, N) m2/s.
        angle_of_attack: (K, N) rad, before the downwash.
        sectional_lift: upwards, per span (K, N) N/m.
        lags: states of the wake (K, n), none where it is quasi-steady.
    """

    wing: PlaneWing
    motion: WingMotion
    speed: float
    density: float
    wake: Wake
    times: FloatArray
    lift: FloatArray
    thrust: FloatArray
    moment: FloatArray
    power: FloatArray
    wake_power: FloatArray
    profile_power: FloatArray
    apparent_energy: FloatArray
    positions: FloatArray
    widths: FloatArray
    circulation: FloatArray
    angle_of_attack: FloatArray
    sectional_lift: FloatArray
    lags: FloatArray

    def _summary(self) -> Iterator[Fact]:
        yield Fact("wake", self.wake)
        yield Fact("speed", f"{self.speed:.6g}", "m/s")
        yield Fact("mean lift coefficient", f"{self.mean_lift_coefficient:.4g}")
        yield Fact("mean thrust coefficient", f"{self.mean_thrust_coefficient:.4g}")
        yield Fact("mean power coefficient", f"{self.mean_power_coefficient:.4g}")
        yield Fact("instants", str(len(self.times)))
        yield Fact("elements", str(len(self.positions)))

    @property
    def dynamic_area(self) -> float:
        """Dynamic pressure of the stream times the wing's area, N."""
        return 0.5 * self.density * self.speed**2 * self.wing.area

    @property
    def mean_lift_coefficient(self) -> float:
        """Mean lift over `dynamic_area`."""
        return float(self.lift.mean()) / self.dynamic_area

    @property
    def mean_thrust_coefficient(self) -> float:
        """Mean thrust over `dynamic_area`."""
        return float(self.thrust.mean()) / self.dynamic_area

    @property
    def mean_power_coefficient(self) -> float:
        """Mean power over `dynamic_area` times the stream's speed."""
        return float(self.power.mean()) / (self.dynamic_area * self.speed)

    @property
    def efficiency(self) -> float:
        """Mean thrust times speed over mean power."""
        return self.mean_thrust_coefficient / self.mean_power_coefficient

    @property
    def energy_gap(self) -> FloatArray:
        """Power less what it is spent on, (K,) W: thrust, wake, profile, and apparent mass.

        None but for the instants' number, and what flow that separates dissipates: of periodic
        loads, whose rates of change are those of the trigonometric polynomial through them.
        """
        count = len(self.times)
        harmonics = 2j * np.pi * self.motion.frequency * np.fft.rfftfreq(count, 1.0 / count)
        stored = np.fft.irfft(harmonics * np.fft.rfft(self.apparent_energy), count)
        spent = self.thrust * self.speed + self.wake_power + self.profile_power + stored
        return np.asarray(self.power - spent)

    def amplitude(self, values: FloatArray, harmonic: int = 1) -> np.ndarray:
        """Complex amplitude a, (...), of values (K, ...) of a period: they hold Re(a exp(i m w t)).

        For `harmonic` m; the mean is that of 0.
        """
        turning = np.exp(-2j * np.pi * harmonic * self.motion.frequency * self.times)
        share = 1.0 if harmonic == 0 else 2.0
        return np.asarray(share * np.tensordot(turning, values, axes=(0, 0)) / len(self.times))


@checked
def moving_wing_loads(
    wing: PlaneWing,
    motion: WingMotion,
    *,
    speed: float,
    density: float = 1.225,
    wake: Wake = "unsteady",
    apparent_mass: bool = True,
    elements: int = 32,
    wake_points: int = 6,
    instants: int = 129,
    times: npt.ArrayLike | None = None,
) -> MovingWingLoads:
    """Compute the loads of a wing that heaves, pitches and flaps periodically in a stream.

    By the lifting line of the birds. Both halves move as mirror images, in the wake of both, whose
    vortices leave along the root's chord. With apparent mass the wind counts at the three-quarter-
    chord points even if the wake is quasi-steady, as by thin-airfoil theory; without apparent mass
    a quasi-steady wing meets it at the quarter chords, as birds do by default.

    Args:
        wing: the wing.
        motion: how it moves.
        speed: of the stream, m/s.
        density: of the fluid, kg/m3.
        wake: "quasi-steady", or "unsteady", in which circulation and downwash lag behind.
        apparent_mass: whether the sections have apparent mass and what goes with it.
        elements: in each half.
        wake_points: elements in each half at which lags are kept.
        instants: in a period, odd.
        times: ascending instants (K,) s of a start, in a wake that holds nothing at the first of
            them; by default the loads that repeat themselves every period.

    Raises:
        ArgumentError: a size is not positive, instants or times do not fit, the choice of wake is
            unknown, or flow would separate in a quasi-steady one.
        StateError: the wake of a start cannot be integrated.
    """
    if wing.stall is not None and wake == "quasi-steady":
        raise ArgumentError(
            'a wing that stalls needs wake="unsteady": how far flow has separated is a memory.'
        )
    if not (0.0 < speed < np.inf and 0.0 < density < np.inf):
        raise ArgumentError("speed and density must be positive and finite.")
    if elements < _FEWEST_ELEMENTS:
        raise ArgumentError(f"a half wing needs {_FEWEST_ELEMENTS} elements or more.")
    if not _FEWEST_ELEMENTS <= wake_points <= elements:
        raise ArgumentError(f"wake_points must be from {_FEWEST_ELEMENTS} to elements, {elements}.")
    moving = MovingWing(wing, motion, speed, density, elements, wake_points, apparent_mass)
    at = _instants(motion, instants) if times is None else _start(times)
    if wake == "unsteady":
        if times is not None:
            lags = lags_of_start(moving.rates, moving.attached, at)
        elif wing.stall is not None:
            lags = settled_lags(moving.rates, moving.attached, at, motion.period)
        else:
            slopes, drive = (np.array(a) for a in zip(*map(moving.lag_rates, at), strict=True))
            lags = periodic_lags(slopes, drive, motion.period)
        found = [moving.unsteady_loads(t, x) for t, x in zip(at, lags, strict=True)]
    else:
        found = [moving.quasi_steady_loads(t) for t in at]
        lags = np.empty((len(at), 0))
    columns = {
        name: np.array([getattr(one, name) for one in found]) for name in InstantLoads._fields
    }
    return MovingWingLoads(
        wing=wing,
        motion=motion,
        speed=speed,
        density=density,
        wake=wake,
        times=at,
        positions=moving.positions,
        widths=moving.widths,
        lags=lags,
        **columns,
    )


def _instants(motion: WingMotion, count: int) -> FloatArray:
    least = max(_FEWEST_INSTANTS, 4 * motion.highest_harmonic + 1)
    if count % 2 == 0 or count < least:
        raise ArgumentError(
            f"instants must be odd and {least} or more for these motions, not {count}."
        )
    return motion.period * np.arange(count) / count


def _start(times: npt.ArrayLike) -> FloatArray:
    at = np.asarray(times, float)
    if at.ndim != 1 or at.size < 2 or not (np.diff(at) > 0.0).all():
        raise ArgumentError("times of a start must be two or more, ascending.")
    return at
