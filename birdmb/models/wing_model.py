"""What both models of a bird have in common: the bird, its wing as arrays, its states' names."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from functools import cached_property, partial
from typing import Any, ClassVar, Literal, Self

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.aerodynamics.airframe import aero_constants
from birdmb.aerodynamics.elements import place_elements
from birdmb.aerodynamics.prescribed import driver_motion_along
from birdmb.errors import ArgumentError, StateError
from birdmb.models.air_kernel import Shapes
from birdmb.models.failures import lifting_line_lost, overflow_told, wing_misplaced
from birdmb.models.flight import Flight
from birdmb.models.gusts import Gust, velocity_of
from birdmb.models.loads import Loads, LoadsAlong
from birdmb.models.loads_kernel import Memory, loads_along
from birdmb.models.motion import PLANAR, Mirror, Motion, along_body
from birdmb.models.wake_states import WakeStates
from birdmb.summary import Fact, Summarised, shortened
from birdmb.topology import Bird
from birdmb.wing.arrays import joint_arrays, wing_arrays
from birdmb.wing.stacked import shape_at, wing_shapes

# Divisible by 1 to 6: that many shooting segments then share one grid of steps.
STEPS_PER_BEAT = 60
BODY_STATES, BODY_UNITS, BODY_SCALE = PLANAR.states, PLANAR.units, PLANAR.scale
_ANGLES = ("phi", "theta")
# By how much a number of beats may be off a whole one.
_WHOLE = 1e-12


class BirdModel(Summarised, ABC):
    """A bird with the loads of its wings; the first states are the body's, see `Motion`.

    Args:
        bird: the bird.
        steps_per_beat: integration steps per wingbeat; by default the model chooses.
        gust: velocity of the air at a time, uniform in space; by default the air is still.
    """

    kind: ClassVar[Literal["rigid", "multibody"]]
    state_names: tuple[str, ...]
    state_units: tuple[str, ...]
    motion: Motion = PLANAR
    wake: WakeStates
    # How many joints at the shoulder are left out of the wing's shape: they turn it as a whole.
    rigid_joint_count = 0

    def __init__(
        self, bird: Bird, *, steps_per_beat: int | None = None, gust: Gust | None = None
    ) -> None:
        self.bird = bird
        self.wing = wing_arrays(bird.side("right"))
        self.has_like_wings = bird.is_symmetric
        self.left_wing = self.wing if self.has_like_wings else wing_arrays(bird.side("left"))
        self.aero = aero_constants(bird)
        self._gust = gust
        self.period = bird.period
        self._steps_wanted = steps_per_beat
        numbers = bird.wing.resolved_discretisation
        self.discretisation = (numbers.elements, numbers.rounding, numbers.scheme == "one-step")

    def _title(self) -> str:
        return self.bird.name

    def _summary(self) -> Iterator[Fact]:
        yield Fact("motion", self.motion.name)
        yield Fact("states", shortened(", ".join(self.state_names)))
        yield Fact("wingbeat", f"{self.bird.period:.4g}", "s")
        yield Fact("air", self.bird.air.wake if self._gust is None else "in a gust")

    @cached_property
    def steps_per_beat(self) -> int:
        """Integration steps per wingbeat."""
        return STEPS_PER_BEAT if self._steps_wanted is None else self._steps_wanted

    @property
    def integration_method(self) -> Literal["explicit", "implicit"]:
        """Kind of the integration steps."""
        return "explicit"

    @property
    def has_kinks(self) -> bool:
        """Whether forces have kinks, which cost integration steps their order."""
        return False

    @property
    def mass(self) -> float:
        """Mass of all that flies, kg."""
        return self.bird.assembled.body.mass

    @abstractmethod
    def rhs(self, t: float, x: npt.ArrayLike) -> FloatArray:
        """Rates (n,) of the states at time t (s) in state x (n,)."""

    @abstractmethod
    def rates(self, times: FloatArray, states: FloatArray) -> FloatArray:
        """Rates (K, n) at `times` (K,) s of `states` (K, n), NaN where these are not finite."""

    def repeats_after(self, duration: float) -> bool:
        """Whether the rates surely repeat after `duration` (s): whole beats, in still air."""
        beats = duration / self.period
        return self._gust is None and abs(beats - round(beats)) <= _WHOLE * beats

    @abstractmethod
    def initial_guess(self) -> FloatArray:
        """State (n,) at t = 0 to look for a limit cycle from."""

    @abstractmethod
    def guess_along(self, times: FloatArray) -> FloatArray:
        """A guess (K, n) of a limit cycle at `times` (K,) s."""

    @abstractmethod
    def flow(self, x0: npt.ArrayLike, t0: float, t1: float) -> FloatArray:
        """State (n,) at t1 (s) of the flight through x0 (n,) at t0; raises `StateError`."""

    @property
    def is_mirrored(self) -> bool:
        """Whether the left wing is the mirror image of the right one in every state."""
        return self.has_like_wings and self.motion.is_symmetric

    @property
    def mirror(self) -> Mirror:
        """How states of the bird become those of its mirror image."""
        n, signs = len(self.state_names), np.ones(len(self.state_names))
        signs[: self.motion.lateral.size][self.motion.lateral] = -1.0
        return Mirror(np.arange(n), signs)

    def air_velocities(self, times: FloatArray) -> FloatArray:
        """Velocities (K, 3) m/s of the air at `times` (K,) s: forwards, to the right and down.

        Raises:
            ArgumentError: it moves sideways, and the body does not.
        """
        if self._gust is None:
            return np.zeros((times.size, 3))
        found = np.array([velocity_of(self._gust, t) for t in times.tolist()]).reshape(-1, 3)
        if self.is_mirrored and found[:, 1].any():
            raise ArgumentError('a side gust needs a model that moves in space (motion="free").')
        return found

    @abstractmethod
    def trajectory(
        self, x0: npt.ArrayLike, t0: float, t1: float, times: npt.ArrayLike | None = None
    ) -> Flight:
        """The flight from x0 (n,) at t0 to t1 (s), at the integration's steps or at `times`."""

    @property
    @abstractmethod
    def state_scale(self) -> FloatArray:
        """Typical sizes of the states, (n,)."""

    @property
    def state_periods(self) -> FloatArray:
        """Periods (n,) of the states: a full turn of roll and pitch angle, infinite of others."""
        turns = [2.0 * np.pi if name in _ANGLES else np.inf for name in self.state_names]
        return np.array(turns)

    @property
    def wing_area(self) -> float:
        """Area of both wings on their drivers at t = 0, m2; raises `StateError` without one."""
        start = np.zeros(1)
        angles, rates, _ = driver_motion_along(self.wing, start)
        shapes = wing_shapes(self.wing, angles, rates, *self.discretisation)
        if not shapes.converged[0]:
            raise lifting_line_lost(self.bird, 0.0, angles[0])
        elements = place_elements(shape_at(shapes, 0), self.wing.root)
        return float(2.0 * np.sum(elements.chord * elements.width))

    @property
    def motion_state_names(self) -> tuple[str, ...]:
        """Names of the states that tell how the bird moves; those of the air's memory follow."""
        return self.state_names[: len(self.state_names) - self.wake.count]

    def body_in_space(self, states: FloatArray) -> FloatArray:
        """The body's states in space (K, 8), as `SPACE_STATES`, of states (K, n)."""
        return self.motion.in_space(states)

    def joint_motion(self, t: float, x: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Angles (A,) rad and rates (A,) rad/s of the right wing's joints and hinges at t (s)."""
        states = np.asarray(x, dtype=float)[None, :]
        (angles,), (rates,) = self.joint_motion_along(np.array([t]), states)
        return angles, rates

    def joint_motion_along(
        self, times: FloatArray, states: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """As `joint_motion`, each (K, A), at `times` (K,) s in states (K, n)."""
        angles, rates = self.motion_of_both(times, states)
        return angles[:, 0], rates[:, 0]

    def motion_of_both(
        self, times: FloatArray, _states: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Angles and rates, each (K, 2, A), of joints and hinges of the right and the left wing."""
        angles, rates, _ = self.drivers_of_both(times)
        return angles, rates

    def drivers_of_both(self, times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Driver angles, rates and accelerations, each (K, 2, A), at `times` (K,) s."""
        of_both = np.empty((3, times.size, 2, self.wing.offset.size))
        of_both[:, :, 0] = driver_motion_along(self.wing, times)
        of_both[:, :, 1] = of_both[:, :, 0]
        if not self.has_like_wings:
            of_both[:, :, 1] = driver_motion_along(self.left_wing, times)
        angles, rates, accelerations = of_both
        return angles, rates, accelerations

    def actuator_torques(self, t: float, x: npt.ArrayLike) -> FloatArray:
        """Torques (A,) N m that move joints and hinges, both wings, at t (s) in state x (n,).

        Of massless wings: those that balance the air.
        """
        times, states = np.array([t]), np.asarray(x, dtype=float)[None, :]
        loads = self.loads_along(times, states)
        return np.asarray(self.actuator_torques_along(times, states, loads)[0].sum(axis=0))

    def actuator_torques_along(
        self, _times: FloatArray, _states: FloatArray, loads: LoadsAlong
    ) -> FloatArray:
        """As `actuator_torques`, (K, 2, A), right and left wing apart, with these loads."""
        return -loads.joint_torques

    def holding_power(
        self, times: FloatArray, _states: FloatArray, _loads: LoadsAlong
    ) -> FloatArray:
        """Power (K,) W of what holds the body in its motion; 0 where it flies."""
        return np.zeros(times.size)

    def loads(self, t: float, x: npt.ArrayLike) -> Loads:
        """Aerodynamic loads at time t (s) in state x (n,).

        Raises:
            StateError: the lifting line cannot be found or crosses the plane of symmetry, or the
                state is not finite.
        """
        return self.loads_along(np.array([t]), np.asarray(x, dtype=float)[None, :]).at(0)

    def loads_along(self, times: FloatArray, states: FloatArray) -> LoadsAlong:
        """Aerodynamic loads at `times` (K,) s in states (K, n); raises as `loads`."""
        finite = np.isfinite(states).all(axis=1)
        if not finite.all():
            t = float(times[np.argmin(finite)])
            raise StateError(f"loads asked for at t = {t:.6g} s in a state that is not finite.")
        angles, rates = self.motion_of_both(times, states)
        with overflow_told(self.bird, f"the force of the air at t = {times[0]:.4g} s"):
            shapes = self._shapes_along(times, angles, rates)
            for side, of in enumerate(shapes.of):
                converged = shapes.stacks[side].now.converged[of]
                if not converged.all():
                    k = int(np.argmin(converged))
                    raise lifting_line_lost(self.bird, float(times[k]), angles[k, side])
            stack = loads_along(
                joint_arrays(self.wing),
                shapes,
                self.rigid_joint_count,
                self.aero,
                angles,
                rates,
                self._twist_through_air(times, self.body_in_space(states)),
                self._memory_along(times, states),
            )
        for side, wing in enumerate((stack.right, stack.left)):
            misplaced = ~(wing.clearance >= 0.0)
            if misplaced.any():
                k = int(np.argmax(misplaced))
                t, distance = float(times[k]), float(wing.clearance[k])
                raise wing_misplaced(self.bird, t, angles[k, side], distance)
        return LoadsAlong(stack, self.aero)

    @abstractmethod
    def _shapes_along(self, times: FloatArray, angles: FloatArray, rates: FloatArray) -> Shapes:
        """Shapes of right and left wing at angles and rates (K, 2, A), and which (2, K) is whose.

        Those with the joints at zero that turn a wing as a whole.
        """

    def _memory_along(self, times: FloatArray, states: FloatArray) -> Memory:
        """What the air remembers at `times` (K,) s in states (K, n), and what accelerates it."""
        _, _, driven = self.drivers_of_both(times)
        lags = states[:, states.shape[1] - self.wake.count :]
        of_body, free = np.zeros((times.size, 6)), np.zeros_like(driven)
        if self.wake.count:
            rates, space = self.rates(times, states), self.body_in_space(states)
            of_body = self.motion.in_space(rates)[:, :6]
            of_body[:, :3] += np.cross(space[:, 3:6], space[:, :3])
            free, driven = self._joint_accelerations(rates, driven)
        return Memory(self.wake.lags, self.wake.sides, lags, of_body, free, driven)

    def _joint_accelerations(
        self, _rates: FloatArray, driven: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Accelerations, each (K, 2, A) rad/s2, of the joints that are free and of the others.

        Of the states' rates (K, n) and the drivers' accelerations. Here all follow drivers.
        """
        return np.zeros_like(driven), driven

    def _twist_through_air(self, times: FloatArray, space: FloatArray) -> FloatArray:
        """Twist (K, 6) of the body relative to the air, m/s and rad/s, in states (K, 8)."""
        twist = space[:, :6].copy()
        if self._gust is not None:
            twist[:, :3] -= along_body(space, self.air_velocities(times))
        return twist

    def _refuse_upright(self, times: FloatArray, states: FloatArray) -> None:
        """Raise `StateError` where the angles of motion in space end."""
        if self.motion.is_symmetric:
            return
        upright = np.abs(states[:, self.state_names.index("theta")]) >= 0.5 * np.pi
        if upright.any():
            t = float(times[np.argmax(upright)])
            raise StateError(
                f"{self.bird.name}: at t = {t:.4g} s the body pitches beyond 90 degrees, where "
                'roll and heading are not told apart (motion="free").'
            )

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle as the call that makes the model: compiled tables are made again where needed."""
        return partial(type(self), self.bird, **self._options()), ()

    def with_steps(self, steps_per_beat: int) -> Self:
        """The same model of the same bird with another number of integration steps per beat."""
        return self._altered(steps_per_beat=steps_per_beat)

    def in_gust(self, gust: Gust | None) -> Self:
        """The same model, with the same integration, in other air; `None` is still air."""
        return self._altered(steps_per_beat=self.steps_per_beat, gust=gust)

    def in_air(self, *, wake: Literal["quasi-steady", "unsteady"]) -> Self:
        """The same model, with the same options, in air with a memory or without."""
        return type(self)(self.bird.with_values({"air.wake": wake}), **self._options())

    @abstractmethod
    def with_lags(self, times: FloatArray, motion: FloatArray) -> FloatArray:
        """States (K, n) at `times` (K,) s of those that tell how the bird moves (K, m).

        With the lags that such motions, were they steady, would settle at.
        """

    def _altered(self, **options: Any) -> Self:
        return type(self)(self.bird, **{**self._options(), **options})

    def settings(self) -> dict[str, Any]:
        """Arguments of the model but for the bird, fit for JSON; `gust`: whether there is one."""
        options = {**self._options(), "gust": self._gust is not None}
        return {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in options.items()}

    def _options(self) -> dict[str, Any]:
        return {"steps_per_beat": self._steps_wanted, "gust": self._gust}

    def _steps(self, t0: float, t1: float) -> int:
        return max(1, round(self.steps_per_beat * abs(t1 - t0) / self.bird.period))
