"""The rigid bird: a body with massless wings on their drivers (docs/model.md, section 6)."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.prescribed import (
    PrescribedWing,
    WakeTable,
    driver_motion,
    driver_motion_along,
    every_second,
    no_wakes,
    odd_wakes,
    pair_wakes,
    prescribed_wing,
)
from birdmb.aerodynamics.prescribed_lags import (
    LagTable,
    every_second_lag,
    lag_table,
)
from birdmb.arguments import checked
from birdmb.errors import StateError
from birdmb.models.air_kernel import Shapes
from birdmb.models.failures import (
    lifting_line_lost,
    overflow_told,
    refuse_runaway,
    wing_misplaced,
)
from birdmb.models.flight import Flight
from birdmb.models.flight_cycle import FlightCycle
from birdmb.models.gusts import Gust
from birdmb.models.instants import NEARBY
from birdmb.models.motion import PLANAR, FlightMotionName, Mirror, Motion, motion_named
from birdmb.models.refusals import refuse_asymmetric, require_inertia
from birdmb.models.rigid_kernel import RigidBody, integrate_rigid, rates_along
from birdmb.models.rigid_tables import RigidTable, RigidTables
from birdmb.models.starts import INCIDENCES, PATH_ANGLES, SPEEDS, steady_states, steady_turns
from birdmb.models.trim import mean_trim
from birdmb.models.wake_states import wake_states
from birdmb.models.wing_model import STEPS_PER_BEAT, BirdModel
from birdmb.topology import SIDES, Bird
from birdmb.wing.arrays import WingArrays
from birdmb.wing.stacked import NearShapes, StackedShapes, wing_shapes

_ORDER = 4
_TOLERANCE = 1e-6
_MOST_STEPS = 1000
_PHASES = 16  # enough for means over a beat, to guess from


def rigid_body(bird: Bird, motion: Motion) -> RigidBody:
    """The constants of a bird's motion; raises `TopologyError` as `require_inertia`."""
    if motion is not PLANAR:
        require_inertia(bird)
    body = bird.assembled.body
    inertia = body.inertia_tensor
    return RigidBody(
        body.mass,
        inertia,
        np.asarray(np.linalg.inv(inertia), float),
        bird.gravity,
        motion.indices,
        motion.directions,
    )


class RigidModel(BirdModel):
    """Rigid body with massless wings; all joints follow their drivers, compliant ones too.

    With motion "planar" in symmetric longitudinal flight, with the states u, w, q and theta; with
    "free" in space, with the states of `birdmb.models.motion`. In air that remembers (`air.wake`
    is "unsteady") the lags of its wake follow, see `birdmb.models.wake_states`.

    Integrated by classical Runge-Kutta steps, with exact variational equations, over a table of
    the wing at every half step. By default there are as many as keep the estimated error of a beat
    below 1e-6 of the state scale, but no more than 1000: what is left of the error, the cycle found
    says.
    """

    kind = "rigid"
    limit_cycle_type: type[FlightCycle] = FlightCycle

    @checked
    def __init__(
        self,
        bird: Bird,
        *,
        motion: FlightMotionName = "planar",
        steps_per_beat: int | None = None,
        gust: Gust | None = None,
    ) -> None:
        super().__init__(bird, steps_per_beat=steps_per_beat, gust=gust)
        self.motion = motion_named(motion)
        refuse_asymmetric(bird, self.motion)
        self.wake = wake_states(bird, 1 if self.is_mirrored else len(SIDES))
        self.state_names = self.motion.states + self.wake.names
        self.state_units = self.motion.units + self.wake.units
        self._constants = (self.aero, rigid_body(bird, self.motion))
        self._tables = RigidTables()

    @cached_property
    def steps_per_beat(self) -> int:
        """Integration steps per wingbeat: as wanted, or as the error estimate asks for."""
        if self._steps_wanted is not None:
            return self._steps_wanted
        steps = STEPS_PER_BEAT
        # Written so that a flight that diverges asks for more.
        while 2 * steps <= _MOST_STEPS and not self._error_of(steps) <= _TOLERANCE:
            steps *= 2
        return steps

    def _error_of(self, steps: int) -> float:
        """Error of a beat from the first guess, in units of the state scale.

        By Richardson's extrapolation from half the steps, over every second phase of the table.
        """
        period = self.bird.period
        fine = self._table(0.0, period, steps)
        right = every_second(fine.right)
        left = right if fine.left is fine.right else every_second(fine.left)
        lags = None if fine.lags is None else every_second_lag(fine.lags)
        coarse = RigidTable(right, left, self._wakes(right, left), lags)
        start, still = self.initial_guess(), np.zeros((2 * steps + 1, 3))
        ends = [
            integrate_rigid(*table.for_kernels, start, period / n, air, *self._constants)[0][-1]
            for table, n, air in ((fine, steps, still), (coarse, steps // 2, still[::2].copy()))
        ]
        return float(np.abs((ends[0] - ends[1]) / self.state_scale).max()) / (2**_ORDER - 1)

    @property
    def state_scale(self) -> FloatArray:
        """Typical sizes of the states, (n,)."""
        return np.array(self.motion.scale + self.wake.scale)

    def rhs(self, t: float, x: npt.ArrayLike) -> FloatArray:
        """Rates (n,) of the states at time t (s) in state x (n,)."""
        times, states = np.array([t]), np.asarray(x, dtype=float)[None, :]
        table = self._tabulated(times)
        phase = np.zeros(1, np.int64)
        return self._along(table, phase, times, states, slopes_wanted=False)[0][0]

    def rates(self, times: FloatArray, states: FloatArray) -> FloatArray:
        """Rates (K, n) at `times` (K,) s of `states` (K, n), NaN where these are not finite.

        Raises:
            StateError: the wing has no loads, or the motion is beyond floating point.
        """
        return self._along(
            *self._tables.holding(times, self._tabulated), times, states, slopes_wanted=False
        )[0]

    def rate_jacobians(self, times: FloatArray, states: FloatArray) -> FloatArray:
        """Derivatives (K, n, n) of the rates, rows, by the states, columns; exact; as `rates`."""
        return self._along(
            *self._tables.holding(times, self._tabulated), times, states, slopes_wanted=True
        )[1]

    def _along(
        self,
        table: RigidTable,
        phase: IntArray,
        times: FloatArray,
        states: FloatArray,
        *,
        slopes_wanted: bool,
    ) -> tuple[FloatArray, FloatArray]:
        self._refuse_upright(times, states)
        air = self.air_velocities(times)
        with overflow_told(self.bird, "the force of the air"):
            return rates_along(
                *table.for_kernels, phase, states, air, *self._constants, slopes_wanted
            )

    def flow(self, x0: npt.ArrayLike, t0: float, t1: float) -> FloatArray:
        """State (n,) at t1 (s) of the flight through x0 (n,) at t0; raises `StateError`."""
        return self._integrate(x0, t0, t1)[0][-1]

    def flow_jacobian(
        self, x0: npt.ArrayLike, t0: float, t1: float
    ) -> tuple[FloatArray, FloatArray]:
        """State (n,) at t1 and its derivative (n, n) by x0, exact for the discrete steps."""
        states, _, sensitivity = self._integrate(x0, t0, t1)
        return states[-1], sensitivity

    def trajectory(
        self, x0: npt.ArrayLike, t0: float, t1: float, times: npt.ArrayLike | None = None
    ) -> Flight:
        """The flight from x0 (n,) at t0 to t1 (s), at the integration's steps or at `times`."""
        states, rates, _ = self._integrate(x0, t0, t1)
        flight = Flight(self.state_names, np.linspace(t0, t1, states.shape[0]), states, rates)
        return flight if times is None else flight.at(times)

    def _options(self) -> dict[str, Any]:
        return {**super()._options(), "motion": self.motion.name}

    def initial_guess(self) -> FloatArray:
        """State (n,) in which the loads, averaged over a beat, come closest to balance."""
        return self.with_lags(np.zeros(1), self._first_guess[None])[0]

    def guess_along(self, times: FloatArray) -> FloatArray:
        """A guess (K, n) of a limit cycle at `times` (K,) s: the initial guess, held steadily.

        Times that are spread evenly over a beat, and are not few, serve for the means as well.
        """
        guess = self._trim(times) if self._span_a_beat(times) else self._first_guess
        return self.with_lags(times, np.tile(guess, (times.size, 1)))

    def with_lags(self, times: FloatArray, motion: FloatArray) -> FloatArray:
        """States (K, n) of those of the body (K, m): with the lags that these settle at."""
        if not self.wake.count:
            return motion
        own = motion.shape[1]
        states = np.hstack([motion, np.tile(self.wake.attached, (len(motion), 1))])
        table, phase = self._tables.at(times, self._tabulated)
        rates, slopes = self._along(table, phase, times, states, slopes_wanted=True)
        states[:, own:] = self.wake.settled(rates[:, own:], slopes[:, own:, own:])
        return states

    def starting_paths(self, times: FloatArray) -> Iterator[FloatArray]:
        """Paths (K, n) at `times` (K,) s to look for flights from, the guess first.

        Then steady flights at several speeds, incidences and path angles; in space turns to both
        sides, too.
        """
        yield self.guess_along(times)
        states = steady_states(self, SPEEDS, INCIDENCES, PATH_ANGLES)
        found = PLANAR.in_space(states)
        if self.motion is not PLANAR:
            found = np.vstack([found, steady_turns(found, self.bird.gravity)])
        for state in found[:, self.motion.indices]:
            yield self.with_lags(times, np.tile(state, (times.size, 1)))

    def _span_a_beat(self, times: FloatArray) -> bool:
        if times.size < _PHASES:
            return False
        period = self.bird.period
        steps = np.diff(times, append=times[0] + period)
        return bool((np.abs(steps - period / times.size) < 1e-9 * period).all())

    @cached_property
    def _first_guess(self) -> FloatArray:
        return self._trim(np.linspace(0.0, self.bird.period, _PHASES + 1)[:-1])

    def _trim(self, times: FloatArray) -> FloatArray:
        table, _ = self._tables.at(times, self._tabulated)
        with overflow_told(self.bird, "the flight in which the mean loads balance"):
            return self._state_of(mean_trim(self.bird, table.right, self.aero))

    def _state_of(self, planar: FloatArray) -> FloatArray:
        """State (n,) of a symmetric flight with the states u, w, q, theta (4,)."""
        return PLANAR.in_space(planar[None, :])[0, self.motion.indices]

    def _integrate(
        self, x0: npt.ArrayLike, t0: float, t1: float
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        steps = self._steps(t0, t1)
        start = np.asarray(x0, dtype=float)
        refuse_runaway(self.bird, self.state_names, start, self.state_scale, t0)
        table, gusts = (
            self._table(t0 % self.bird.period, t1 - t0, steps),
            self.air_velocities(np.linspace(t0, t1, 2 * steps + 1)),
        )
        with overflow_told(self.bird, f"the flight from t = {t0:.4g} to {t1:.4g} s"):
            found = integrate_rigid(
                *table.for_kernels, start, (t1 - t0) / steps, gusts, *self._constants
            )
        if not np.isfinite(found[0]).all():
            raise StateError(
                f"{self.bird.name}: the flight from t = {t0:.4g} s diverged before "
                f"t = {t1:.4g} s (start: {self._described(start)})."
            )
        self._refuse_upright(np.linspace(t0, t1, steps + 1), found[0])
        return found

    def _described(self, x: FloatArray) -> str:
        return ", ".join(f"{n} = {v:.4g}" for n, v in zip(self.state_names, x, strict=True))

    def _table(self, t0: float, duration: float, steps: int) -> RigidTable:
        """The wing at every half step from t0 on."""
        times = t0 + duration * np.arange(2 * steps + 1) / max(2 * steps, 1)
        return self._tables.of(times, self._tabulated)

    def _tabulated(self, times: FloatArray) -> RigidTable:
        right = self.wing_at(times)
        left = right if self.has_like_wings else self._left_at(times)
        return RigidTable(right, left, self._wakes(right, left), self._lags(times, right, left))

    def _wakes(self, right: PrescribedWing, left: PrescribedWing) -> WakeTable:
        """What asymmetric motions or wings need; symmetric flight does without, as do lags."""
        if self.motion is PLANAR or self.wake.count:
            return no_wakes()
        return odd_wakes(right) if left is right else pair_wakes(right, left)

    def _lags(
        self, times: FloatArray, right: PrescribedWing, left: PrescribedWing
    ) -> LagTable | None:
        """What the lags of air that remembers need; none of other air."""
        lags = self.wake.lags
        if not self.wake.count:
            return None
        near = self._near_shapes(self.wing, times, right)
        near_left = near if left is right else self._near_shapes(self.left_wing, times, left)
        return lag_table(right, left, near, near_left, lags, self.is_mirrored, self.aero.density)

    def _near_shapes(
        self, arrays: WingArrays, times: FloatArray, wing: PrescribedWing
    ) -> NearShapes:
        """Shapes of a tabulated wing, with those nearby in time where the air remembers."""
        if not self.wake.count:
            return NearShapes(wing.shapes, wing.shapes, wing.shapes, 1.0)
        step = NEARBY * self.bird.period
        before, after = (self._shapes_at(arrays, near) for near in (times - step, times + step))
        return NearShapes(wing.shapes, before, after, step)

    def _shapes_at(self, arrays: WingArrays, times: FloatArray) -> StackedShapes:
        angles, rates, _ = driver_motion_along(arrays, times)
        return wing_shapes(arrays, angles, rates, *self.discretisation)

    @property
    def mirror(self) -> Mirror:
        """How states of the bird become those of its mirror image: the wings change sides."""
        of_body = super().mirror
        order = of_body.order.copy()
        own = order.size - self.wake.count
        order[own:] = self.wake.mirrored(own)
        return Mirror(order, of_body.signs)

    def _shapes_along(self, times: FloatArray, _angles: FloatArray, _rates: FloatArray) -> Shapes:
        table, phase = self._tables.at(times, self._tabulated)
        distinct = np.unique(times) if phase.size else times
        right = self._near_shapes(self.wing, distinct, table.right)
        left = right
        if table.left is not table.right:
            left = self._near_shapes(self.left_wing, distinct, table.left)
        return Shapes((right, left), np.stack([phase, phase]))

    def wing_at(self, times: FloatArray) -> PrescribedWing:
        """The right wing on its drivers at `times` (P,) s.

        Raises `StateError` where it has no loads.
        """
        return self._wing_at(self.wing, times)

    def _left_at(self, times: FloatArray) -> PrescribedWing:
        return self._wing_at(self.left_wing, times)

    def _wing_at(self, arrays: WingArrays, times: FloatArray) -> PrescribedWing:
        with overflow_told(self.bird, "the wing's circulation"):
            wing = prescribed_wing(arrays, self.aero.tail, times, *self.discretisation)
        if not wing.shapes.converged.all():
            t = float(times[np.argmin(wing.shapes.converged)])
            raise lifting_line_lost(self.bird, t, driver_motion(arrays, t)[0])
        misplaced = ~(wing.clearance >= 0.0)
        if misplaced.any():
            worst = int(np.argmin(np.where(misplaced, wing.clearance, np.inf)))
            t, distance = float(times[worst]), float(wing.clearance[worst])
            raise wing_misplaced(self.bird, t, driver_motion(arrays, t)[0], distance)
        return wing
