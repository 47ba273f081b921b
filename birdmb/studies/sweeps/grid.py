"""The points of a sweep, and from which neighbour each one starts.

The results must depend neither on the number of workers nor on what finishes first, so that the
neighbour is a function of the point's place in the grid alone. It is also independent of how far
the grid reaches: values can be appended to a study without changing what it holds already.
"""

from __future__ import annotations

import itertools
import math
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias, TypeGuard

import numpy as np

from birdmb.studies.sweeps.errors import SweepError
from birdmb.topology import Bird
from birdmb.topology.messages import shown

Value: TypeAlias = float | int | str | bool
Place: TypeAlias = tuple[int, ...]
"""Position in the grid: one index into the values of each parameter."""

# Along each parameter, every fourth value starts from the fourth before and opens a chain of three.
# Shorter strides leave workers idle, longer ones start further from the flight they look for.
_STRIDE = 4
# Of a million points the places alone take some hundred megabytes, their results two gigabytes.
MOST_POINTS = 2_000_000
# Of the way to the value before: what a flow errs by counts little, nor does its curvature.
_STEP = 1e-2
_LARGEST = sys.float_info.max


@dataclass(frozen=True)
class Grid:
    """All combinations of the values of some parameters.

    Attributes:
        parameters: values by dotted name, in the order given.
    """

    parameters: Mapping[str, tuple[Value, ...]]

    @classmethod
    def of(cls, bird: Bird, vary: Mapping[str, Sequence[Any]]) -> Grid:
        """The grid of `vary`, checked for what cannot be meant.

        Raises:
            TopologyError: the bird has no value of that name.
            SweepError: no parameter, no values, a value twice or none that can be stored, the same
                value under two names, or more points than can be kept in mind.
        """
        if not vary:
            raise SweepError("A sweep needs at least one parameter to vary.")
        for name, values in vary.items():
            bird.value(name)
            if not len(values):
                raise SweepError(f"{name} has no values to take.")
        size = math.prod(map(len, vary.values()))
        if size > MOST_POINTS:
            raise SweepError(
                f"{size:.3g} points are asked for, more than the {MOST_POINTS:.3g} that a study "
                f"can hold; take fewer values, or split them over several stores."
            )
        if pair := overlap([*vary]):
            raise SweepError(f"{pair[0]} and {pair[1]} are one value; vary it under one name.")
        return cls({name: _distinct(name, values) for name, values in vary.items()})

    @property
    def size(self) -> int:
        """How many points there are."""
        return math.prod(self.shape)

    @property
    def shape(self) -> tuple[int, ...]:
        """How many values each parameter takes."""
        return tuple(map(len, self.parameters.values()))

    def places(self) -> Iterator[Place]:
        """All places, the last parameter varying fastest."""
        return itertools.product(*map(range, self.shape))

    def values(self, place: Place) -> dict[str, Value]:
        """Values of the parameters, by name, at a place."""
        return {
            name: values[i]
            for i, (name, values) in zip(place, self.parameters.items(), strict=True)
        }

    def steps(self, place: Place) -> dict[str, float]:
        """Small steps, by name, in those parameters that are numbers at a place.

        Towards the value before, whose bird is known to be possible; at the first value away from
        zero, and none at zero itself. Like the neighbour, they do not depend on values after.
        """
        steps = {}
        for i, (name, values) in zip(place, self.parameters.items(), strict=True):
            here, before = values[i], values[max(i - 1, 0)]
            if is_number(here) and is_number(before):
                way = float(before) - float(here) if i else float(here)
                if way:
                    steps[name] = _STEP * way
        return steps

    def extends(self, other: Grid) -> bool:
        """Whether every place of `other` has the same values here, and the same parameters."""
        return list(self.parameters) == list(other.parameters) and all(
            self.parameters[name][: len(values)] == values
            for name, values in other.parameters.items()
        )


def parent(place: Place) -> Place | None:
    """The place whose flight a place starts from: back along the last parameter not at its first.

    `None` for the first place of all, which starts from the model's own guess.
    """
    for axis in reversed(range(len(place))):
        i = place[axis]
        if i > 0:
            back = _STRIDE if i % _STRIDE == 0 else 1
            return (*place[:axis], i - back, *place[axis + 1 :])
    return None


def is_number(value: Value) -> TypeGuard[float]:
    """Whether a value is a number; a switch is none."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def overlap(names: Sequence[str]) -> tuple[str, str] | None:
    """Two of these dotted names that lead to the same value: an angle's, or a whole and its part.

    `None` if there are no two.
    """
    plain = [name.removesuffix("_deg") for name in names]
    for j, second in enumerate(plain):
        for i, first in enumerate(plain[:j]):
            whole, part = sorted((first, second), key=len)
            if whole == part or part.startswith(f"{whole}."):
                return names[i], names[j]
    return None


def _distinct(name: str, values: Sequence[Any]) -> tuple[Value, ...]:
    plain = tuple(_plain(name, value) for value in values)
    if len(set(plain)) < len(plain):
        twice, _ = Counter(plain).most_common(1)[0]
        raise SweepError(f"{name} is to be {twice} twice; keep one of the two.")
    return plain


def _plain(name: str, value: Any) -> Value:
    """The value as one of Python's own, which a store gives back to the last bit."""
    plain = value.item() if isinstance(value, np.generic) else value
    if not isinstance(plain, int | float | str):
        raise SweepError(f"{name} can be swept over numbers and texts, not over {plain!r}.")
    if isinstance(plain, int | float) and not abs(plain) <= _LARGEST:
        raise SweepError(f"{name} cannot be {shown(plain)}; it must be a finite number.")
    return plain
