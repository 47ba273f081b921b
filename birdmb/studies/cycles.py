"""Limit cycles of the variations of one bird, each started from the one before."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.errors import OrbitError, StateError
from birdmb.models import BirdModel, FlightCycle, FlightModel
from birdmb.orbits import LimitCycle, find_limit_cycle
from birdmb.orbits.collocation_search import nodes_shown
from birdmb.orbits.enough_nodes import FIRST_NODES
from birdmb.topology import Bird

_MODELS_KEPT = 8

ModelFactory: TypeAlias = Callable[[Bird], FlightModel]
"""Turns a bird into a model: `RigidModel`, `MultibodyModel`, or either with options bound."""


class KeptModels:
    """Models of a bird at parameters (k,), the last few of them kept.

    Args:
        model_at: makes one.
    """

    def __init__(self, model_at: Callable[[FloatArray], BirdModel]) -> None:
        self._model_at = model_at
        self._kept: dict[tuple[float, ...], BirdModel] = {}

    def __call__(self, point: FloatArray) -> BirdModel:
        """The model; raises what making it raises."""
        key = tuple(point.tolist())
        if key not in self._kept:
            if len(self._kept) >= _MODELS_KEPT:
                del self._kept[next(iter(self._kept))]
            self._kept[key] = self._model_at(point)
        return self._kept[key]


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
        self._last: FlightCycle | FloatArray | None = None

    def start_from(self, guess: FlightCycle | FloatArray) -> None:
        """Start the next one from a cycle, or from a state (n,)."""
        self._last = guess

    def __call__(self, values: Mapping[str, Any]) -> FlightCycle:
        """The limit cycle with these values by dotted name.

        Raises:
            TopologyError: a name is unknown or a value impossible.
            OrbitError: no cycle was found.
            StateError: the search could not start, or the wing cannot be modelled.
        """
        model = self._model(self._bird.with_values(values))
        last = self._last
        # A varied mode of a joint may have given the one before other states.
        if last is not None and _states(last) == len(model.state_names):
            with suppress(OrbitError, StateError):
                if isinstance(last, FlightCycle):
                    return self._kept(find_near(model, last, self._options))
                return self._kept(find_limit_cycle(model, last, **self._options))
        return self._kept(find_limit_cycle(model, **self._options))

    def _kept(self, cycle: FlightCycle) -> FlightCycle:
        self._last = cycle
        return cycle


def find_near(model: FlightModel, cycle: FlightCycle, options: Mapping[str, Any]) -> FlightCycle:
    """The limit cycle of a model, from one of a model like it; raises as `find_limit_cycle`."""
    if cycle.method == "collocation":
        return find_limit_cycle(model, cycle, **options)
    return shot_near(model, cycle.points, cycle.segment_jacobians, options)


def shot_near(
    model: FlightModel,
    points: FloatArray,
    jacobians: npt.ArrayLike | None,
    options: Mapping[str, Any],
) -> FlightCycle:
    """The limit cycle of a model by shooting, from one of a model like it that was shot.

    Collocation is not tried again beside an orbit that it was too rough for.

    Args:
        model: the model.
        points: states (M, n) at the starts of the other one's segments.
        jacobians: its segment Jacobians (M, n, n), if known.
        options: what else `find_limit_cycle` takes.
    """
    count = options.get("segments") or len(points)
    # Of starts that do not fit the segments, the first leads to those that do.
    start = points if len(points) == count else points[0]
    shooting = {**options, "method": "shooting", "segments": count}
    found = find_limit_cycle(model, start, jacobian_guess=jacobians, **shooting)
    asked = options.get("segments") is not None or options.get("method") == "shooting"
    return found if asked else replace(found, method_reason="so was the cycle it started from")


def path_for_search(cycle: LimitCycle) -> FloatArray:
    """States (K, n) of a collocated cycle at as many nodes as a search from it begins with."""
    begun = max(FIRST_NODES, nodes_shown(cycle))
    return path_at_nodes(cycle, min(cycle.nodes or begun, begun))


def path_at_nodes(cycle: LimitCycle, nodes: int) -> FloatArray:
    """States (nodes, n) of a cycle at even instants of its period."""
    return cycle.trajectory(cycle.start_time + cycle.period * np.arange(nodes) / nodes).states


def _states(guess: FlightCycle | FloatArray) -> int:
    return len(guess.state_names) if isinstance(guess, FlightCycle) else guess.size
