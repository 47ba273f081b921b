"""The tree of body and wings in Exudyn, its joints prescribed or compliant."""

from __future__ import annotations

from functools import cached_property
from typing import Any, Literal, Self

import numpy as np
import numpy.typing as npt

from birdmb._typing import BoolArray, FloatArray
from birdmb.arguments import checked
from birdmb.errors import StateError
from birdmb.models.air_kernel import Motion, Shapes
from birdmb.models.compiled_calls import COMPILED, calls_compiled_code
from birdmb.models.determinacy import refuse_undetermined
from birdmb.models.exudyn_bird import ExudynBird
from birdmb.models.failures import refuse_runaway
from birdmb.models.flight import Flight
from birdmb.models.gusts import Gust
from birdmb.models.implicit import integrate_implicitly
from birdmb.models.instants import Instants
from birdmb.models.integration import Integration, Integrator, integration_for
from birdmb.models.joint_states import JointStates
from birdmb.models.motion import (
    FREE,
    HELD,
    PLANAR,
    Mirror,
    MotionName,
    gravity_along_body,
    motion_named,
)
from birdmb.models.refusals import held_state, refuse_asymmetric, require_inertia
from birdmb.models.rigid import RigidModel
from birdmb.models.springs import Springs, has_two_sides, springs_of
from birdmb.models.tree_coordinates import (
    IN_PLANE,
    IN_SPACE,
    coordinates_along,
    space_state,
    state_rates,
    whole,
)
from birdmb.models.tree_forces import TreeLoads
from birdmb.models.tree_rates import TreeRates
from birdmb.models.wake_states import wake_states, without_memory
from birdmb.models.wing_model import BirdModel
from birdmb.topology import SIDES, Bird
from birdmb.wing.arrays import WingArrays
from birdmb.wing.chain import joints_turning_the_whole


class TreeModel(BirdModel):
    """A bird as one kinematic tree of body and wings; see `birdmb.MultibodyModel`."""

    kind = "multibody"

    @checked
    def __init__(
        self,
        bird: Bird,
        *,
        motion: MotionName = "planar",
        body_state: npt.ArrayLike | None = None,
        steps_per_beat: int | None = None,
        integrator: Integrator = "auto",
        gust: Gust | None = None,
    ) -> None:
        super().__init__(bird, steps_per_beat=steps_per_beat, gust=gust)
        self.motion = motion_named(motion, (PLANAR, FREE, HELD))
        refuse_asymmetric(bird, self.motion)
        self._held = held_state(self.motion, body_state)
        self._coordinates_of_body = IN_PLANE if self.is_mirrored else IN_SPACE
        if self.motion is FREE:
            require_inertia(bird)
        self._integrator: Integrator = integrator
        compliant = [joint.mode == "compliant" for joint in bird.joints]
        self.joint_states = JointStates(
            bird,
            first=len(self.motion.states),
            sides=1 if self.is_mirrored else len(SIDES),
            compliant=np.array(compliant + [True] * len(bird.hinged_feathers), dtype=bool),
        )
        self.wake = wake_states(bird, 1 if self.is_mirrored else len(SIDES))
        self.state_names = self.motion.states + self.joint_states.names + self.wake.names
        self.state_units = self.motion.units + self.joint_states.units + self.wake.units
        springs = [springs_of(bird.side(side)) for side in SIDES]
        self._springs = Springs(*(np.concatenate(pair) for pair in zip(*springs, strict=True)))
        self.rigid_joint_count = joints_turning_the_whole(self.wing)
        self.prescribed = self._follow_drivers()
        right = self._instants_of(self.wing)
        instants = right, right if bird.is_symmetric else self._instants_of(self.left_wing)
        self.tree = TreeRates(
            bird,
            self.wing,
            instants,
            body_coordinates=self._coordinates_of_body,
            is_mirrored=self.is_mirrored,
            rigid_joint_count=self.rigid_joint_count,
            aero=self.aero,
            springs=self._springs,
            prescribed=self.prescribed,
            lags=self.wake.lags,
        )
        if self.joint_states.count:
            angles, _, _ = self.drivers_of_both(np.zeros(1))
            refuse_undetermined(bird, self.tree.inertia, angles.ravel(), ~self.prescribed)
        self._exudyn = ExudynBird(
            bird,
            self._coordinates_of_body,
            self._loads,
            self.prescribed,
            self.tree.driver_accelerations,
            self.wake.count,
        )
        self._integration: Integration | None = None

    @property
    def is_mirrored(self) -> bool:
        """Whether the left wing is the mirror image of the right one in every state."""
        held_aside = self._held is not None and bool(self._held[FREE.lateral].any())
        return super().is_mirrored and not held_aside

    def _instants_of(self, wing: WingArrays) -> Instants:
        shaping = (
            np.flatnonzero(self.joint_states.compliant[self.rigid_joint_count :])
            + self.rigid_joint_count
        )
        return Instants(
            self.bird, wing, self.discretisation, self.rigid_joint_count, shaping.tolist()
        )

    def _options(self) -> dict[str, Any]:
        own = {"motion": self.motion.name, "integrator": self._integrator}
        return {**super()._options(), **own, "body_state": self._held}

    def _altered(self, **options: Any) -> Self:
        return super()._altered(**{"integrator": self.integration.method, **options})

    @property
    def mirror(self) -> Mirror:
        """How states of the bird become those of its mirror image: the wings change sides."""
        of_body = super().mirror
        order = of_body.order.copy()
        order[self.joint_states.states] = self.joint_states.mirrored
        order[self._lags] = self.wake.mirrored(self._lags.start)
        return Mirror(order, of_body.signs)

    def body_in_space(self, states: FloatArray) -> FloatArray:
        """The body's states in space (K, 8), as `SPACE_STATES`, of states (K, n)."""
        if self._held is not None:
            return np.tile(self._held, (len(states), 1))
        return super().body_in_space(states)

    @property
    def integration(self) -> Integration:
        """Method and steps per beat: as wanted, or as the fastest joint or lag needs."""
        # Not a cached property: its lock, taken before the one of the calls, could wait for ever.
        with COMPILED:
            if self._integration is None:
                self._integration = self._chosen_integration()
            return self._integration

    @calls_compiled_code
    def _chosen_integration(self) -> Integration:
        rigid = not (self.joint_states.compliant.any() or self.wake.count)
        if rigid and self._integrator == "auto":
            return Integration("explicit", super().steps_per_beat)
        return integration_for(self, self._steps_wanted, self._integrator)

    @property
    def steps_per_beat(self) -> int:
        """Integration steps per wingbeat."""
        return self.integration.steps_per_beat

    @property
    def integration_method(self) -> Literal["explicit", "implicit"]:
        """Kind of the integration steps: implicit where joints, hinges or lags are stiff."""
        return self.integration.method

    @property
    def has_kinks(self) -> bool:
        """Whether a spring is stiffer to one side."""
        return has_two_sides(self._springs)

    @property
    def mass(self) -> float:
        """Mass of body and both wings, kg."""
        return self.bird.total_mass

    @property
    def state_scale(self) -> FloatArray:
        """Typical sizes of the states, (n,)."""
        return np.array(self.motion.scale + self.joint_states.scale + self.wake.scale)

    def motion_of_both(
        self, times: FloatArray, states: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Angles and rates, each (K, 2, A), of joints and hinges of the right and the left wing."""
        angles, rates, _ = self.drivers_of_both(times)
        self.joint_states.put(states, angles, rates)
        return angles, rates

    def flow(self, x0: npt.ArrayLike, t0: float, t1: float) -> FloatArray:
        """State (n,) at t1 (s) of the flight through x0 (n,) at t0; raises `StateError`."""
        start = np.asarray(x0, dtype=float)
        refuse_runaway(self.bird, self.state_names, start, self.state_scale, t0)
        return self._advanced(start, t0, t1, self._steps(t0, t1))

    @calls_compiled_code
    def trajectory(
        self, x0: npt.ArrayLike, t0: float, t1: float, times: npt.ArrayLike | None = None
    ) -> Flight:
        """The flight from x0 (n,) at t0 to t1 (s), at the integration's steps or at `times`."""
        grid = np.linspace(t0, t1, self._steps(t0, t1) + 1)
        states = np.empty((grid.size, len(self.state_names)))
        states[0] = np.asarray(x0, dtype=float)
        for i in range(1, grid.size):
            states[i] = self._advanced(states[i - 1], grid[i - 1], grid[i], 1)
        flight = Flight(self.state_names, grid, states, self.rates(grid, states))
        return flight if times is None else flight.at(times)

    @calls_compiled_code
    def _advanced(self, x: FloatArray, t0: float, t1: float, steps: int) -> FloatArray:
        if self.integration.method == "implicit":
            return integrate_implicitly(self.rates, x, t0, t1, steps, self.state_scale)
        start = *self.coordinates(t0, x), x[self._lags]
        end = self._exudyn.integrate(*start, t0, t1, steps)
        return self._state(*end, f"between t = {t0:.4g} and {t1:.4g} s")

    def rhs(self, t: float, x: npt.ArrayLike) -> FloatArray:
        """Rates (n,) of the states at t (s), by exact partition of the equations of motion."""
        return self.rates(np.array([t]), np.asarray(x, dtype=float)[None, :])[0]

    def rates(self, times: FloatArray, states: FloatArray) -> FloatArray:
        """Rates (K, n) at `times` (K,) s of `states` (K, n), NaN where these are not finite.

        Raises:
            StateError: no lifting line fits the wing, or the motion is beyond floating point.
        """
        finite = np.isfinite(states).all(axis=1)
        if not finite.all():
            found = np.full(states.shape, np.nan)
            if finite.any():
                found[finite] = self.rates(times[finite], states[finite])
            return found
        self._refuse_upright(times, states)
        space = self.body_in_space(states)
        angles, rates = (
            each[:, : self.joint_states.sides].reshape(len(states), -1)
            for each in self.motion_of_both(times, states)
        )
        twist = self._twist_through_air(times, space)
        given = twist, gravity_along_body(space, self.bird.gravity), angles, rates
        # All in one layout: the kernels are compiled anew for each other one.
        motion = Motion(*map(np.ascontiguousarray, (*given, states[:, self._lags])))
        a, lag_rates = self.tree.accelerations(times, motion)
        found = np.empty(states.shape)
        joints = self.joint_states.states
        first = self.joint_states.first
        if first:
            of_body = np.zeros((len(states), 6))
            of_body[:, self.motion.directions] = a[:, : self.motion.directions.size]
            found[:, :first] = state_rates(space, of_body)[:, self.motion.indices]
        found[:, joints][:, ::2] = states[:, joints][:, 1::2]
        found[:, joints][:, 1::2] = a[:, self.motion.directions.size :]
        found[:, self._lags] = lag_rates
        return found

    def _joint_accelerations(
        self, rates: FloatArray, driven: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        free = np.zeros_like(driven)
        self.joint_states.put(rates, np.zeros_like(driven), free)
        driven[:, :, self.joint_states.compliant] = 0.0
        return free, driven

    def _shapes_along(self, times: FloatArray, angles: FloatArray, rates: FloatArray) -> Shapes:
        return self.tree.shapes(times, angles, rates)

    def driven_state(self, t: float = 0.0) -> FloatArray:
        """State (n,) at t (s) of the body in mean trim, with compliant joints on their drivers."""
        return self.guess_along(np.array([t]))[0]

    def guess_along(self, times: FloatArray) -> FloatArray:
        """A guess (K, n) of a limit cycle at `times` (K,) s: `driven_state` at each."""
        guess = np.empty((times.size, self._lags.start))
        if self.motion is not HELD:
            guess[:, : self.joint_states.first] = self._trim
        angles, rates, _ = self.drivers_of_both(times)
        guess[:, self.joint_states.states] = self.joint_states.taken(angles, rates)
        return self.with_lags(times, guess[:, : self._lags.start])

    def with_lags(self, times: FloatArray, motion: FloatArray) -> FloatArray:
        """States (K, n) of those of body and joints (K, m): with the lags that these settle at."""
        if not self.wake.count:
            return motion
        states = np.hstack([motion, np.tile(self.wake.attached, (times.size, 1))])
        return np.hstack([motion, self.wake.settled(*self.wake.linear(self.rates, times, states))])

    @cached_property
    def _trim(self) -> FloatArray:
        still = without_memory(self.bird.side("right"))
        planar = RigidModel(still).initial_guess()
        return PLANAR.in_space(planar[None])[0, self.motion.indices]

    @property
    def _joints(self) -> slice:
        """The tree's coordinates of joints and hinges, those of the right wing first."""
        return slice(self._coordinates_of_body.size, None)

    @property
    def _lags(self) -> slice:
        """Where the lags of the air stand among the states."""
        return slice(self.joint_states.states.stop, None)

    def _follow_drivers(self) -> BoolArray:
        """Which of the tree's coordinates (n,) follow a driver."""
        body = np.full(self._coordinates_of_body.size, self.motion is HELD)
        joints = ~self.joint_states.compliant
        return np.concatenate([body, joints, joints])

    def coordinates(self, t: float, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Coordinates and velocities (c,) of the tree at the origin, of state x (n,) at t (s)."""
        (q,), (v,) = self._coordinates(np.array([t]), x[None, :])
        return q, v

    def _coordinates(self, times: FloatArray, states: FloatArray) -> tuple[FloatArray, FloatArray]:
        """As `coordinates`, each (K, c)."""
        of_body = coordinates_along(self.body_in_space(states))
        q, v = (
            np.hstack([body[:, self._coordinates_of_body], joints.reshape(times.size, -1)])
            for body, joints in zip(of_body, self.motion_of_both(times, states), strict=True)
        )
        return q, v

    def _state(self, q: FloatArray, v: FloatArray, lags: FloatArray, when: str) -> FloatArray:
        if not all(np.isfinite(each).all() for each in (q, v, lags)):
            raise StateError(
                f"{self.bird.name}: the flight diverged {when} "
                f"(integrated with {self.steps_per_beat} steps per beat)."
            )
        body = self._coordinates_of_body
        space = space_state(whole(q[: body.size], body), whole(v[: body.size], body))
        angles, rates = (each[self._joints].reshape(1, len(SIDES), -1) for each in (q, v))
        (joints,) = self.joint_states.taken(angles, rates)
        return np.concatenate([space[self.motion.indices], joints, lags])

    def _loads(self, t: float, q: FloatArray, v: FloatArray, lags: FloatArray) -> TreeLoads:
        """What acts on the tree in Exudyn but gravity and its own inertia."""
        return self.tree.loads(t, q, v, lags, self.air_velocities(np.array([t]))[0])
