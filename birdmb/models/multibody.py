"""The multibody bird in flight, its joints prescribed or compliant (docs/model.md, section 7)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import OrbitError, StateError
from birdmb.models.flight_cycle import FlightCycle
from birdmb.models.rigid_flights import rigid_flights
from birdmb.models.starts import (
    FEW_INCIDENCES,
    FEW_PATH_ANGLES,
    FEW_SPEEDS,
    steady_states,
)
from birdmb.models.tethered import TetheredModel
from birdmb.models.tree_model import TreeModel
from birdmb.models.wing_model import BODY_STATES
from birdmb.orbits import find_limit_cycle
from birdmb.topology import Bird


class MultibodyModel(TreeModel):
    """Body and both wings as one kinematic tree; prescribed joints follow their drivers exactly.

    The states are the body's four, then angle (rad) and rate (rad/s) of each compliant joint, named
    `shoulder.flap` and `shoulder.flap.rate`, and of each feather's hinge, named `feathers.5.hinge`
    and `feathers.5.hinge.rate`; a hinge is moved like a joint whose driver stands still. Left and
    right wing move as mirror images. The point whose velocity is `u`, `w` is the centre of mass of
    the body without its wings.

    Integrated with fixed steps, for shooting needs a flow that is smooth in its start: by Exudyn's
    explicit RK67 (order 6) with as many steps as the fastest motion of the joints needs, or, where
    that would be too many, by implicit Radau IIA (order 5). `integration` tells which.

    Args:
        bird: the bird.
        steps_per_beat: integration steps per wingbeat; by default the model chooses.
        integrator: "explicit", "implicit", or "auto" for the model to choose.
        gust: velocity of the air, as for `BirdModel`.
    """

    limit_cycle_type: type[FlightCycle] = FlightCycle
    _body_states = len(BODY_STATES)

    def initial_guess(self) -> FloatArray:
        """State (n,) at t = 0: the rigid bird's, with the compliant joints settled about it.

        The compliant joints are left to swing for some beats on a body that flies on steadily.
        """
        start = self.driven_state()
        if not self._compliant.any():
            return start
        tethered = TetheredModel(self.bird, start[:4], **self._options())
        return np.concatenate([start[:4], tethered.initial_guess()])

    def starting_paths(self, times: FloatArray) -> Iterator[FloatArray]:
        """Paths (K, n) at `times` (K,) s to look for flights from, the guess first.

        Along the flights of the rigid bird, then along steady flights, with the compliant joints as
        they swing on a body held in that flight's mean motion, and on their drivers.
        """
        guess = self.guess_along(times)
        yield guess
        for bodies in (rigid_flights, self._steady):
            for body in bodies(self.bird, times):
                swinging = self._tethered_joints(body, times)
                if swinging is not None:
                    yield np.hstack([body, swinging])
                yield np.hstack([body, guess[:, self._body_states :]])

    def _steady(self, _bird: Bird, times: FloatArray) -> FloatArray:
        steady = steady_states(self, FEW_SPEEDS, FEW_INCIDENCES, FEW_PATH_ANGLES)
        return np.repeat(steady[:, None, :], times.size, axis=1)

    def _tethered_joints(self, body: FloatArray, times: FloatArray) -> FloatArray | None:
        """States (K, m) of the compliant joints on a body held as it moves on average."""
        if not self._compliant.any():
            return None
        mean = body.mean(axis=0) * [1.0, 1.0, 0.0, 1.0]
        tethered = TetheredModel(self.bird, mean, **self._options())
        try:
            cycle = find_limit_cycle(tethered, accuracy=1e-3, method="collocation")
        except (OrbitError, StateError):
            return None
        return cycle.trajectory(times).states
