"""What a model's flow depends on: whether it makes a difference to it that a value is varied."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Protocol

import numpy as np

from birdmb.errors import TopologyError
from birdmb.topology import Bird

_VALUES_COMPARED = 4


class HasInputs(Protocol):
    """A model that says what its flow depends on."""

    @property
    def inputs(self) -> tuple[object, ...]:
        """Equal for two models whose flows are the same."""


def flattened(*parts: object) -> tuple[object, ...]:
    """Numbers, texts and arrays in nested tuples, and in lists, as one tuple that compares."""
    flat: list[object] = []
    for part in parts:
        if isinstance(part, tuple | list):
            flat += [len(part), *flattened(*part)]
        elif isinstance(part, np.ndarray):
            flat += [part.shape, part.tobytes()]
        else:
            flat.append(part)
    return tuple(flat)


def ignores(
    model: Callable[[Bird], HasInputs], bird: Bird, name: str, values: Sequence[object]
) -> bool:
    """Whether the models of a bird with these values of `name` all fly alike.

    So do rigid birds whose springs are varied, and all birds with the stiffness of a joint that is
    prescribed. Values that no bird can have are passed over; a single value is never ignored.
    """
    seen = set()
    for value in list(values)[:_VALUES_COMPARED]:
        with suppress(TopologyError):
            seen.add(model(bird.with_values({name: value})).inputs)
            if len(seen) > 1:
                return False
    return len(seen) == 1 and len(values) > 1
