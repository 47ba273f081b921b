"""The bird in a wind tunnel: its body held in steady motion, its joints free."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError
from birdmb.models.gusts import Gust
from birdmb.models.integration import Integrator
from birdmb.models.stepped_cycle import SteppedCycle
from birdmb.models.tree_model import TreeModel
from birdmb.topology import Bird

_BEATS_TO_SETTLE = 6


class TetheredModel(TreeModel):
    """The multibody bird in a wind tunnel: its body held in steady motion, its joints free.

    The states are the compliant joints' angles (rad) and rates (rad/s).

    Args:
        bird: the bird.
        body_state: u, w (m/s), q = 0 and theta (rad) of the body, (4,).
        steps_per_beat: integration steps per wingbeat; by default the model chooses.
        integrator: "explicit", "implicit", or "auto" for the model to choose.
        gust: velocity of the air, as for `BirdModel`.

    Raises:
        ArgumentError: the body turns.
    """

    limit_cycle_type: type[SteppedCycle] = SteppedCycle
    _body_states = 0

    def __init__(
        self,
        bird: Bird,
        body_state: npt.ArrayLike,
        *,
        steps_per_beat: int | None = None,
        integrator: Integrator = "auto",
        gust: Gust | None = None,
    ) -> None:
        super().__init__(bird, steps_per_beat=steps_per_beat, integrator=integrator, gust=gust)
        self._held = np.array(body_state, dtype=float)
        self._held.flags.writeable = False
        if self._held.shape != (4,) or self._held[2] != 0.0:
            raise ArgumentError(
                "body_state must be u, w, q, theta with q = 0: a held body cannot turn."
            )

    def _options(self) -> dict[str, Any]:
        return {**super()._options(), "body_state": self._held}

    def starting_paths(self, times: FloatArray) -> Iterator[FloatArray]:
        """One path (K, n) at `times` (K,) s: the joints on their drivers."""
        yield self.guess_along(times)

    def body_state(self, x: FloatArray) -> FloatArray:  # noqa: ARG002
        """The body's state (4,), whatever the joints do."""
        return self._held

    def initial_guess(self) -> FloatArray:
        """State (n,) of the joints at t = 0, after some beats from their drivers."""
        x = self.driven_state()
        for _ in range(_BEATS_TO_SETTLE):
            x = self.flow(x, 0.0, self.bird.period)
        return x
