"""The tree of body and wings in Exudyn, its joints prescribed or compliant."""

from __future__ import annotations

from functools import cached_property
from typing import Any, Literal, Self

import numpy as np
import numpy.typing as npt

from birdmb._typing import BoolArray, FloatArray, IntArray
from birdmb.aerodynamics.prescribed import driver_motion, driver_motion_along
from birdmb.errors import StateError
from birdmb.models.compiled_calls import COMPILED, calls_compiled_code
from birdmb.models.determinacy import refuse_undetermined
from birdmb.models.exudyn_tree import BODY_COORDINATES, ExudynBird, typical_inertias
from birdmb.models.failures import overflow_told, refuse_runaway, wing_misplaced
from birdmb.models.flight import Flight
from birdmb.models.gusts import Gust
from birdmb.models.implicit import integrate_implicitly
from birdmb.models.instants import DriverState, Instants
from birdmb.models.integration import Integration, Integrator, integration_for
from birdmb.models.loads import LoadsAlong
from birdmb.models.multibody_kernel import body_velocity, tree_forces
from birdmb.models.partition import body_forces, partitioned
from birdmb.models.rates_kernel import Motion
from birdmb.models.rigid import RigidModel
from birdmb.models.springs import has_two_sides, spring_torques_along, springs_of
from birdmb.models.stepped_cycle import SteppedCycle
from birdmb.models.tree_rates import TreeRates
from birdmb.models.wing_model import BODY_SCALE, BODY_STATES, BODY_UNITS, BirdModel
from birdmb.topology import Bird
from birdmb.wing.chain import joints_turning_the_whole
from birdmb.wing.shape import WingShape
from birdmb.wing.stacked import StackedShapes

_JOINT_SCALE = (0.5, 10.0)  # rad, rad/s


class TreeModel(BirdModel):
    """A bird as one kinematic tree of body and wings, in flight or held.

    The states are the body's, if it is free, then angle (rad) and rate (rad/s) of each compliant
    joint, named `shoulder.flap` and `shoulder.flap.rate`, and of each feather's hinge, named
    `feathers.5.hinge` and `feathers.5.hinge.rate`; a hinge is moved like a joint whose driver
    stands still. Left and right wing move as mirror images.

    Integrated with fixed steps, for shooting needs a flow that is smooth in its start: by Exudyn's
    explicit RK67 (order 6) with as many steps as the fastest motion of the joints needs, or, where
    that would be too many, by implicit Radau IIA (order 5). `integration` tells which.
    """

    limit_cycle_type: type[SteppedCycle]
    # How many of the states are the body's: all four, unless it is held.
    _body_states: int

    def __init__(
        self,
        bird: Bird,
        *,
        steps_per_beat: int | None = None,
        integrator: Integrator = "auto",
        gust: Gust | None = None,
    ) -> None:
        super().__init__(bird, steps_per_beat=steps_per_beat, gust=gust)
        self._integrator: Integrator = integrator
        hinges = [feather.hinge_name for feather in bird.hinged_feathers]
        names = [joint.name for joint in bird.compliant_joints] + hinges
        free = self._body_states
        self.state_names = BODY_STATES[:free] + tuple(n for j in names for n in (j, f"{j}.rate"))
        self.state_units = BODY_UNITS[:free] + ("rad", "rad/s") * len(names)
        compliant = [joint.mode == "compliant" for joint in bird.joints]
        self._compliant = np.array(compliant + [True] * len(hinges), dtype=bool)
        self._right_wing = slice(BODY_COORDINATES, BODY_COORDINATES + self._compliant.size)
        self._springs = springs_of(bird)
        self.rigid_joint_count = joints_turning_the_whole(self.wing)
        shaping = np.flatnonzero(self._compliant[self.rigid_joint_count :]) + self.rigid_joint_count
        self.prescribed = self._follow_drivers()
        self._instants = Instants(
            bird, self.wing, self.discretisation, self.rigid_joint_count, shaping.tolist()
        )
        self._tree = TreeRates(
            bird, self.wing, self.rigid_joint_count, self.airframe, self.prescribed, self._instants
        )
        self._refuse_undetermined()
        self._exudyn = ExudynBird(bird, self._forces, self.prescribed, self.driver_accelerations)
        self._integration: Integration | None = None

    def _options(self) -> dict[str, Any]:
        return {**super()._options(), "integrator": self._integrator}

    def _altered(self, **options: Any) -> Self:
        return super()._altered(**{"integrator": self.integration.method, **options})

    @property
    def integration(self) -> Integration:
        """Method and steps per beat: as wanted, or as the fastest joint motion needs."""
        # Not a cached property: its lock, taken before the one of the calls, could wait for ever.
        with COMPILED:
            if self._integration is None:
                self._integration = self._chosen_integration()
            return self._integration

    @calls_compiled_code
    def _chosen_integration(self) -> Integration:
        if not self._compliant.any() and self._integrator == "auto":
            return Integration("explicit", super().steps_per_beat)
        return integration_for(self, self._steps_wanted, self._integrator)

    @property
    def steps_per_beat(self) -> int:
        """Integration steps per wingbeat."""
        return self.integration.steps_per_beat

    @property
    def integration_method(self) -> Literal["explicit", "implicit"]:
        """Kind of the integration steps: implicit where joints or hinges are stiff."""
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
        joints = int(self._compliant.sum())
        return np.array(BODY_SCALE[: self._body_states] + _JOINT_SCALE * joints)

    def joint_motion_along(
        self, times: FloatArray, states: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Angles and rates (K, A) of joints and hinges at `times` (K,) s in states (K, n)."""
        angles, rates, _ = driver_motion_along(self.wing, times)
        angles[:, self._compliant] = states[:, self._body_states :: 2]
        rates[:, self._compliant] = states[:, self._body_states + 1 :: 2]
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
        q, v = self._exudyn.integrate(*self.coordinates(t0, x), t0, t1, steps)
        return self._state(q, v, f"between t = {t0:.4g} and {t1:.4g} s")

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
        body = np.empty((len(states), len(BODY_STATES)))
        body[:] = states[:, :4] if self._body_states else self.body_state(states[0])
        angles, rates = self.joint_motion_along(times, states)
        motion = Motion(body, angles, rates, self.air_velocities(times)[:, [0, 2]])
        a = self._tree.accelerations(times, motion)
        found = np.empty(states.shape)
        if self._body_states:
            u, w, pitch_rate, _ = body.T
            found[:, 0] = a[:, 0] - pitch_rate * w
            found[:, 1] = a[:, 1] + pitch_rate * u
            found[:, 2], found[:, 3] = a[:, 2], pitch_rate
        found[:, self._body_states :: 2] = states[:, self._body_states + 1 :: 2]
        found[:, self._body_states + 1 :: 2] = a[:, BODY_COORDINATES if self._body_states else 0 :]
        return found

    def _own(self, body: npt.ArrayLike, angles: FloatArray, rates: FloatArray) -> FloatArray:
        """A state, or its rates, from the body's part (4,) and the compliant joints' parts."""
        return np.concatenate(
            [np.asarray(body)[: self._body_states], np.column_stack([angles, rates]).ravel()]
        )

    def accelerations(self, t: float, x: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Accelerations (n,) of all coordinates and the actuators' forces (n,) on them.

        Coordinates X, Z (m), pitch (rad), right and left joints and hinges (rad). The forces (N,
        N m) are those that hold the prescribed joints to their drivers, without springs and
        dampers.
        """
        times, states = np.array([t]), np.asarray(x, dtype=float)[None, :]
        a, forces = self._accelerations(times, states, self.loads_along(times, states))
        return a[0], forces[0]

    @calls_compiled_code
    def _accelerations(
        self, times: FloatArray, states: FloatArray, loads: LoadsAlong
    ) -> tuple[FloatArray, FloatArray]:
        """As `accelerations`, each (K, c)."""
        q, v = self._coordinates(times, states)
        mass, bias = self._tree.inertia.at(q, v)
        torques = loads.stack.joint_torques + self._spring_torques_along(times, states)
        body = body_forces(loads.stack.force, loads.stack.moment, q[:, 2])
        _, _, driving = driver_motion_along(self.wing, times)
        given = np.hstack([np.zeros((times.size, BODY_COORDINATES)), driving, driving])
        with overflow_told(self.bird, f"the acceleration at t = {times[0]:.4g} s"):
            left = bias - np.hstack([body, torques, torques])
            return partitioned(mass, left, given, self.prescribed)

    def _spring_torques_along(self, times: FloatArray, states: FloatArray) -> FloatArray:
        angles, rates = self.joint_motion_along(times, states)
        driver_angles, driver_rates, _ = driver_motion_along(self.wing, times)
        return spring_torques_along(self._springs, angles - driver_angles, rates - driver_rates)

    def actuator_torques_along(
        self, times: FloatArray, states: FloatArray, loads: LoadsAlong
    ) -> FloatArray:
        """Torques (K, A) N m that move joints and hinges, left and right together.

        Of the actuators that hold prescribed joints to their drivers, inertia included; of spring
        and damper where a joint is compliant.
        """
        _, forces = self._accelerations(times, states, loads)
        right = forces[:, self._right_wing]
        return 2.0 * (right + self._spring_torques_along(times, states))

    def _shapes_along(
        self, times: FloatArray, angles: FloatArray, rates: FloatArray
    ) -> tuple[StackedShapes, IntArray]:
        distinct, shape_of = np.unique(times, return_inverse=True)
        shapes = self._instants.stacked(distinct).shapes
        if shapes is None:
            return self._instants.shapes(times, angles, rates), np.arange(times.size)
        return shapes, shape_of

    def driven_state(self, t: float = 0.0) -> FloatArray:
        """State (n,) at t (s) of the body in mean trim, with compliant joints on their drivers."""
        return self.guess_along(np.array([t]))[0]

    def guess_along(self, times: FloatArray) -> FloatArray:
        """A guess (K, n) of a limit cycle at `times` (K,) s: `driven_state` at each."""
        angles, rates, _ = driver_motion_along(self.wing, times)
        guess = np.empty((times.size, len(self.state_names)))
        if self._body_states:
            guess[:, : self._body_states] = self._trim
        guess[:, self._body_states :: 2] = angles[:, self._compliant]
        guess[:, self._body_states + 1 :: 2] = rates[:, self._compliant]
        return guess

    @cached_property
    def _trim(self) -> FloatArray:
        return RigidModel(self.bird).initial_guess()

    def _follow_drivers(self) -> BoolArray:
        """Which of the tree's coordinates (n,) follow a driver."""
        body = np.full(BODY_COORDINATES, self._body_states == 0)
        joints = ~self._compliant
        return np.concatenate([body, joints, joints])

    def _refuse_undetermined(self) -> None:
        """Raise `TopologyError` if the mass matrix at t = 0 leaves a compliant joint at will."""
        if not self._compliant.any():
            return
        angles, _, _ = driver_motion(self.wing, 0.0)
        q = np.concatenate([np.zeros(BODY_COORDINATES), angles, angles])[None, :]
        (mass,), _ = self._tree.inertia.at(q, np.zeros_like(q))
        free = ~self.prescribed
        names = ("X", "Z", "pitch", *self.bird.angle_names, *self.bird.angle_names)
        with overflow_told(self.bird, "the mass matrix"):
            refuse_undetermined(
                self.bird,
                mass[np.ix_(free, free)],
                typical_inertias(self.bird, free.size)[free],
                [name for name, is_free in zip(names, free, strict=True) if is_free],
            )

    def coordinates(self, t: float, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Coordinates and velocities (c,) of the tree, with X = Z = 0, of state x at time t."""
        (q,), (v,) = self._coordinates(np.array([t]), x[None, :])
        return q, v

    def _coordinates(self, times: FloatArray, states: FloatArray) -> tuple[FloatArray, FloatArray]:
        """As `coordinates`, each (K, c)."""
        u, w, pitch_rate, theta = np.array([self.body_state(x) for x in states]).T
        c, s = np.cos(theta), np.sin(theta)
        angles, rates = self.joint_motion_along(times, states)
        place = np.column_stack([np.zeros((times.size, 2)), theta])
        motion = np.column_stack([u * c + w * s, -u * s + w * c, pitch_rate])
        return np.hstack([place, angles, angles]), np.hstack([motion, rates, rates])

    def _state(self, q: FloatArray, v: FloatArray, when: str) -> FloatArray:
        if not (np.isfinite(q).all() and np.isfinite(v).all()):
            raise StateError(
                f"{self.bird.name}: the flight diverged {when} "
                f"(integrated with {self.steps_per_beat} steps per beat)."
            )
        joints = np.flatnonzero(self._compliant) + BODY_COORDINATES
        u, w = body_velocity(q[2], v[0], v[1])
        return self._own([u, w, v[2], q[2]], q[joints], v[joints])

    def instant(self, t: float) -> DriverState:
        """What time t (s) alone determines."""
        return self._instants.at(t)

    def _forces(self, t: float, q: FloatArray, v: FloatArray) -> FloatArray:
        """Generalised forces (n,) of air, springs and dampers: Exudyn's user function."""
        instant = self.instant(t)
        forward, _, down = self.air_velocities(np.array([t]))[0]
        with overflow_told(self.bird, f"the force of the air at t = {t:.4g} s"):
            forces, clearance = tree_forces(
                self.wing,
                instant.shape or self._shape(t, q, v),
                self.rigid_joint_count,
                self.airframe,
                self._springs,
                instant.angles,
                instant.rates,
                q,
                v,
                (float(forward), float(down)),
            )
        if not clearance >= 0.0:
            raise wing_misplaced(self.bird, t, q[self._right_wing], clearance)
        return np.asarray(forces)

    def _shape(self, t: float, q: FloatArray, v: FloatArray) -> WingShape:
        angles, rates = q[self._right_wing], v[self._right_wing]
        if not (np.isfinite(angles).all() and np.isfinite(rates).all()):
            angles, rates, _ = driver_motion(self.wing, t)  # any will do: there are no forces
        return self._instants.shape(t, angles, rates)

    def driver_accelerations(self, t: float) -> FloatArray:
        """Accelerations (n,) of the drivers, 0 for the body; only prescribed joints follow."""
        return self.instant(t).accelerations
