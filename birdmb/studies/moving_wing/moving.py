"""Loads of a moving wing at an instant."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._typing import FloatArray
from birdmb.aerodynamics.apparent_mass import apparent_inertia
from birdmb.aerodynamics.elements import place_elements
from birdmb.aerodynamics.pair import pair_loads, pair_wrench
from birdmb.aerodynamics.section_motion import section_motion
from birdmb.aerodynamics.separation_curves import separation_curves
from birdmb.aerodynamics.twist_loads import wing_wrench
from birdmb.aerodynamics.unsteady_circulation import Unsteady, lag_system, unsteady_circulations
from birdmb.aerodynamics.unsteady_loads import side_flow, side_wrenches
from birdmb.aerodynamics.wake_lags import wake_lags
from birdmb.studies.moving_wing.energy import apparent_energy, profile_power, wake_power
from birdmb.studies.moving_wing.instants import Instant, inertial_loads
from birdmb.studies.moving_wing.motion import WingMotion
from birdmb.studies.moving_wing.plane_wing import PlaneWing, lifting_line
from birdmb.wing.shape import WingShape, turned

# Of a period: central differences of the sections' velocities err by its square, 1e-9.
_STEP = 1e-5
_NO_DIRECTIONS = np.empty(0, np.int64)


class InstantLoads(NamedTuple):
    """Loads at an instant, named and sized as in `MovingWingLoads` but for the first axis."""

    lift: float
    thrust: float
    moment: float
    power: float
    wake_power: float
    profile_power: float
    apparent_energy: float
    circulation: FloatArray
    angle_of_attack: FloatArray
    sectional_lift: FloatArray


class MovingWing:
    """A wing that moves in a stream; its parameters are those of `moving_wing_loads`."""

    def __init__(
        self,
        wing: PlaneWing,
        motion: WingMotion,
        speed: float,
        density: float,
        elements: int,
        wake_points: int,
        apparent_mass: bool,
    ) -> None:
        self._motion = motion
        self._speed, self._density = speed, density
        self._profile_drag = wing.profile_drag
        self._apparent_mass = apparent_mass
        self._line = lifting_line(wing, elements, motion.pitch_axis)
        self._lags = wake_lags(elements, wake_points)
        self._attached = np.zeros(4 * wake_points)
        if wing.stall is not None:
            places, kept = np.zeros(wake_points), self._lags.kept
            curves = separation_curves([wing.profile], places, kept, elements)
            self._lags = self._lags._replace(separation=curves)
            self._attached = np.append(self._attached, np.ones(wake_points))
        placed = place_elements(self._line, np.zeros(3))
        self.widths = placed.width
        self.positions = np.cumsum(placed.width) - 0.5 * placed.width

    @property
    def attached(self) -> FloatArray:
        """Lags (n,) of a fluid at rest about a wing whose flow is attached."""
        return self._attached.copy()

    def rates(self, t: float, lags: FloatArray) -> FloatArray:
        """Rates (n,) 1/s of the lags (n,) at time t (s)."""
        return self._circulations(self._at(t), lags, False).lag_rates[:, 0].copy()

    def lag_rates(self, t: float) -> tuple[FloatArray, FloatArray]:
        """Slopes (n, n) 1/s of the lags' rates at time t (s), and these where all lags are none.

        Of attached flow, in which these are all that there is to the rates.
        """
        at = self._at(t)
        unsteady = self._circulations(at, np.zeros(4 * self._lags.kept.size), True)
        return unsteady.lag_rates[:, 1:].copy(), unsteady.lag_rates[:, 0].copy()

    def unsteady_loads(self, t: float, lags: FloatArray) -> InstantLoads:
        """Loads at time t (s) with these lags (n,)."""
        at = self._at(t)
        return self._with_memory(at, self._circulations(at, lags, False))

    def quasi_steady_loads(self, t: float) -> InstantLoads:
        """Loads at time t (s) of the wake that this motion would have in the long run."""
        if self._apparent_mass:
            slopes, drive = self.lag_rates(t)
            return self.unsteady_loads(t, np.asarray(np.linalg.solve(slopes, -drive)))
        at = self._at(t)
        placed = at.elements
        right, _ = pair_loads(placed, placed, True, self._density, self._profile_drag, at.twist)
        gamma, still = right.circulation, np.zeros(len(right.circulation))
        return self._summed(at, right.wrench, gamma, gamma, still, right.angle_of_attack)

    def _at(self, t: float) -> Instant:
        step = _STEP * self._motion.period
        before, now, after = (self._shape(at) for at in (t - step, t, t + step))
        elements = place_elements(now, np.zeros(3))
        sections = section_motion(before, now, after, step)
        heave, pitch, flap = (
            self._motion.course(series, np.array([t]))
            for series in (self._motion.heave, self._motion.pitch, self._motion.flap)
        )
        angle, rise, lifted = pitch.value[0], heave.rate[0], heave.acceleration[0]
        c, s = np.cos(angle), np.sin(angle)
        u, w = self._speed * c + rise * s, self._speed * s - rise * c
        twist = np.array([u, 0.0, w, 0.0, pitch.rate[0], 0.0])
        acceleration = np.array([lifted * s, 0.0, -lifted * c, 0.0, pitch.acceleration[0], 0.0])
        air = apparent_inertia(elements, self._density if self._apparent_mass else 0.0)
        flow = side_flow(elements, now.velocity, sections, air, twist, _NO_DIRECTIONS, False)
        rates = np.array([rise, pitch.rate[0], flap.rate[0]])
        return Instant(elements, flow, sections, air, twist, acceleration, rates, float(angle))

    def _shape(self, t: float) -> WingShape:
        flap = self._motion.course(self._motion.flap, np.array([t]))
        c, s = np.cos(flap.value[0]), np.sin(flap.value[0])
        turn = np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])
        return turned(self._line, turn, np.array([-flap.rate[0], 0.0, 0.0]))

    def _circulations(self, at: Instant, lags: FloatArray, slopes_wanted: bool) -> Unsteady:
        placed = at.elements
        system = lag_system(placed, placed, placed.induced_y, placed.induced_z, self._lags)
        flow = at.flow
        return unsteady_circulations(
            system, self._lags, flow.driving, flow.speed, lags, slopes_wanted
        )

    def _with_memory(self, at: Instant, unsteady: Unsteady) -> InstantLoads:
        placed, trailing = at.elements, unsteady.trailing
        y, z = placed.induced_y @ trailing, placed.induced_z @ trailing
        loads = side_wrenches(
            placed, at.flow, unsteady, y, z, 0, self._density, self._profile_drag
        )[:, :, 0]
        return self._summed(
            at,
            loads + inertial_loads(at),
            unsteady.circulation[:, 0],
            trailing[:, 0],
            unsteady.shed[:, 0],
            at.flow.angle_of_attack,
        )

    def _summed(
        self,
        at: Instant,
        loads: FloatArray,
        circulation: FloatArray,
        trailing: FloatArray,
        shed: FloatArray,
        angle_of_attack: FloatArray,
    ) -> InstantLoads:
        """Loads of both halves from those (N, 6) N and N m of the right one's elements."""
        placed = at.elements
        of_right = wing_wrench(placed.position, np.ascontiguousarray(loads[:, :, None]))
        total = pair_wrench(of_right, of_right)[:, 0]
        c, s = np.cos(at.pitch), np.sin(at.pitch)
        lifts = s * loads[:, 0] - c * loads[:, 2]
        lift, thrust = s * total[0] - c * total[2], c * total[0] + s * total[2]
        moment = total[4]
        against = np.array([lift, moment, -2.0 * of_right[3, 0]])
        return InstantLoads(
            lift,
            thrust,
            moment,
            -float(against @ at.rates),
            wake_power(at, self._density, circulation, trailing, shed),
            profile_power(at, self._density, self._profile_drag),
            apparent_energy(at),
            circulation,
            angle_of_attack,
            lifts / placed.width,
        )
