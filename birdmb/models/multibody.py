"""The multibody bird, its joints prescribed or compliant (docs/model.md, section 7)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import OrbitError, StateError
from birdmb.models.flight_cycle import FlightCycle
from birdmb.models.motion import FREE, HELD, PLANAR
from birdmb.models.rigid_flights import rigid_flights
from birdmb.models.starts import (
    FEW_INCIDENCES,
    FEW_PATH_ANGLES,
    FEW_SPEEDS,
    steady_states,
    steady_turns,
)
from birdmb.models.tree_actuators import ActuatedTree
from birdmb.models.wake_states import without_memory
from birdmb.orbits import find_limit_cycle

_BEATS_TO_SETTLE = 6


class MultibodyModel(ActuatedTree):
    """Body and both wings as one kinematic tree; prescribed joints follow their drivers exactly.

    The states are the body's, as `motion` says, then angle (rad) and rate (rad/s) of each compliant
    joint, named `shoulder.flap` and `shoulder.flap.rate`, and of each feather's hinge, named
    `feathers.5.hinge` and `feathers.5.hinge.rate`; a hinge is moved like a joint whose driver
    stands still. Where left and right wing need not move as mirror images each has its own, those
    of the right wing first: `shoulder.flap.right`, `shoulder.flap.left`. The point whose velocity
    is u, v, w is the centre of mass of the body without its wings.

    Integrated with fixed steps, for shooting needs a flow that is smooth in the initial state: by
    Exudyn's explicit RK67 (order 6) with as many steps as the fastest motion of the joints and of
    the air's lags needs, or, where that would be too many, by implicit Radau IIA (order 5).
    `integration` tells which.

    Args:
        bird: the bird.
        motion: "planar", symmetric longitudinal flight with the states u, w, q and theta; "free",
            in space, with the states of `birdmb.models.motion`; "held", as in a wind tunnel: only
            the joints move.
        body_state: of a held body, its states u, w, q = 0, theta in the plane of symmetry, or all
            eight in space with no angular velocity; m/s, rad.
        steps_per_beat: integration steps per wingbeat; by default the model chooses.
        integrator: "explicit", "implicit", or "auto" for the model to choose.
        gust: velocity of the air, as for `BirdModel`.

    Raises:
        ArgumentError: no such motion, a held body without its state or one that turns.
        TopologyError: left and right differ in planar motion, motion in space lacks moments of
            inertia, or a compliant joint moves no mass.
    """

    limit_cycle_type: type[FlightCycle] = FlightCycle

    def initial_guess(self) -> FloatArray:
        """State (n,) at t = 0: the rigid bird's, with the compliant joints settled about it.

        The compliant joints are left to swing for some beats on a body that flies on steadily.
        """
        start = self.driven_state()
        if not self.joint_states.count:
            return start
        if self.motion is HELD:
            for _ in range(_BEATS_TO_SETTLE):
                start = self.flow(start, 0.0, self.bird.period)
            return start
        held = self._held_like(start)
        joints = self.joint_states.spread(held.initial_guess(), held.joint_states.sides)
        motion = np.concatenate([start[: self.joint_states.first], joints])
        return self.with_lags(np.zeros(1), motion[None])[0]

    def starting_paths(self, times: FloatArray) -> Iterator[FloatArray]:
        """Paths (K, n) at `times` (K,) s to look for flights from, the guess first.

        Along the flights of the rigid bird, then along steady flights, with the compliant joints as
        they swing on a body held in that flight's mean motion, and on their drivers. Of a held body
        the guess alone.
        """
        guess = self.guess_along(times)
        yield guess
        if self.motion is HELD:
            return
        for paths in (self._rigid, self._steady):
            for body in paths(times):
                swinging = self._joints_held(body, times)
                if swinging is not None:
                    yield self.with_lags(times, np.hstack([body, swinging]))
                yield self.with_lags(times, np.hstack([body, guess[:, self.joint_states.states]]))

    def _rigid(self, times: FloatArray) -> FloatArray:
        """Paths (S, K, m) of the body along the flights of the rigid bird."""
        planar = rigid_flights(self.bird.side("right"), times)
        space = PLANAR.in_space(planar.reshape(-1, len(PLANAR.states)))
        return space[:, self.motion.indices].reshape(
            len(planar), times.size, self.joint_states.first
        )

    def _steady(self, times: FloatArray) -> FloatArray:
        """Paths (S, K, m) of the body in steady flights, in space also in turns to both sides."""
        states = steady_states(self, FEW_SPEEDS, FEW_INCIDENCES, FEW_PATH_ANGLES)
        space = PLANAR.in_space(states)
        if self.motion is FREE:
            space = np.vstack([space, steady_turns(space, self.bird.gravity)])
        return np.repeat(space[:, None, self.motion.indices], times.size, axis=1)

    def _joints_held(self, body: FloatArray, times: FloatArray) -> FloatArray | None:
        """States (K, m) of the compliant joints on a body held as it moves on average."""
        if not self.joint_states.count:
            return None
        held = self._held_like(body.mean(axis=0))
        try:
            cycle = find_limit_cycle(held, accuracy=1e-3, method="collocation")
        except (OrbitError, StateError):
            return None
        states = cycle.trajectory(times).states
        return self.joint_states.spread(states, held.joint_states.sides)

    def _held_like(self, body: FloatArray) -> MultibodyModel:
        """The same bird held as a state (n,) has its body, but for its turning, in still air.

        In a symmetric motion it has states for both wings together, else for each. The air has no
        memory.
        """
        space = self.motion.in_space(body[None, : self.joint_states.first])[0]
        space[3:6] = 0.0
        options: dict[str, Any] = {**self._options(), "motion": "held", "body_state": space}
        return type(self)(without_memory(self.bird), **options)
