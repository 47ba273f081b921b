"""What the wings can be coloured by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError
from birdmb.models.loads_kernel import StackedWing

ColourName = Literal["circulation", "incidence", "load"]


@dataclass(frozen=True)
class Colour:
    """A quantity of the wing's elements.

    Attributes:
        name: how users ask for it.
        label: what it is, with its symbol.
        unit: of its values.
        of: values (F, N) of a wing's elements, whose chords point forwards along vectors
            (F, N, 3) and outwards along others, the left wing mirrored.
    """

    name: ColourName
    label: str
    unit: str
    of: Callable[[StackedWing, FloatArray, FloatArray], FloatArray]


def _circulation(wing: StackedWing, _forward: FloatArray, _out: FloatArray) -> FloatArray:
    return wing.circulation


def _incidence(wing: StackedWing, _forward: FloatArray, _out: FloatArray) -> FloatArray:
    return np.degrees(wing.angle_of_attack)


def _load(wing: StackedWing, forward: FloatArray, out: FloatArray) -> FloatArray:
    # Of a right wing in axes whose z points down.
    up = np.cross(out, forward)
    up /= np.linalg.norm(up, axis=-1, keepdims=True)
    return np.asarray((wing.force * up).sum(axis=-1) / (wing.chord * wing.width))


_COLOURS = {
    each.name: each
    for each in (
        Colour("circulation", "circulation Γ", "m²/s", _circulation),
        Colour("incidence", "angle of attack", "°", _incidence),
        Colour("load", "load, upwards", "N/m²", _load),
    )
}


def colour_named(name: str) -> Colour:
    """The colour of a name; raises `ArgumentError` where there is none."""
    for colour in _COLOURS.values():
        if colour.name == name:
            return colour
    raise ArgumentError(f'colour must be "circulation", "incidence" or "load", not "{name}".')
