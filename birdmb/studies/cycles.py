"""Limit cycles of the variations of one bird, each started from the one before."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any, TypeAlias, cast

import numpy as np
import numpy.typing as npt

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
        options: what else `find_limit_cycle` takes.
    """

    def __init__(
        self, bird: Bird, model: ModelFactory, options: Mapping[str, Any] | None = None
    ) -> None:
        self._bird, self._model, self._options = bird, model, dict(options or {})
        self.start_from(None, None)

    def start_from(self, x0: npt.ArrayLike | None, jacobians: npt.ArrayLike | None) -> None:
        """Start the next one from a state x0 (n,), and from segment Jacobians (M, n, n) if given.

        `None` for both: from the model's own guess.
        """
        self._x0, self._jacobians = x0, jacobians

    def __call__(self, values: Mapping[str, Any]) -> FlightCycle:
        """The limit cycle with these values by dotted name.

        Raises:
            TopologyError: a name is unknown or a value impossible.
            OrbitError: no cycle was found.
            StateError: the search could not start, or the wing cannot be modelled.
        """
        model = self._model(self._bird.with_values(values))
        # A varied mode of a joint may have given the one before other states.
        if self._x0 is not None and np.size(self._x0) == len(model.state_names):
            with suppress(OrbitError, StateError):
                return self._kept(model, self._x0, self._jacobians)
        return self._kept(model, None, None)

    def _kept(
        self, model: Model, guess: npt.ArrayLike | None, jacobians: npt.ArrayLike | None
    ) -> FlightCycle:
        found = find_limit_cycle(model, guess, jacobian_guess=jacobians, **self._options)
        cycle = cast("FlightCycle", found)
        self.start_from(cycle.x0, cycle.segment_jacobians)
        return cycle
