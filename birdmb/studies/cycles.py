"""Limit cycles of the variations of one bird, each started from the one before."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any, TypeAlias, cast

from birdmb._typing import FloatArray
from birdmb.errors import OrbitError, StateError
from birdmb.models import FlightCycle
from birdmb.orbits import Model, find_limit_cycle
from birdmb.topology import Bird

ModelFactory: TypeAlias = Callable[[Bird], Model]
"""Turns a bird into a model: `RigidModel`, `MultibodyModel`, or either with options bound."""


class WarmCycles:
    """Finds limit cycles of variations of a bird, from the last one found or else from scratch.

    Args:
        bird: the bird that is varied.
        model: makes the model of a variation.
    """

    def __init__(self, bird: Bird, model: ModelFactory) -> None:
        self._bird, self._model = bird, model
        self._last: FlightCycle | None = None

    def __call__(self, values: Mapping[str, Any]) -> FlightCycle:
        """The limit cycle with these values by dotted name.

        Raises:
            TopologyError: a name is unknown or a value impossible.
            OrbitError: no cycle was found.
            StateError: the search could not start, or the wing cannot be modelled.
        """
        model = self._model(self._bird.with_values(values))
        last = self._last
        if last is not None and last.state_names == tuple(model.state_names):
            with suppress(OrbitError, StateError):
                return self._kept(model, last.x0, last.segment_jacobians)
        return self._kept(model, None, None)

    def _kept(
        self, model: Model, guess: FloatArray | None, jacobians: FloatArray | None
    ) -> FlightCycle:
        cycle = cast("FlightCycle", find_limit_cycle(model, guess, jacobian_guess=jacobians))
        self._last = cycle
        return cycle
