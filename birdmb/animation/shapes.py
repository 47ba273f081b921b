"""Shapes of the body and the tail, to draw a bird by.

The model knows the body's mass but not its shape: the one drawn is a spindle of that mass, of the
density and slenderness of a bird's trunk.
"""

from __future__ import annotations

import numpy as np

from birdmb._typing import FloatArray, IntArray
from birdmb.topology import Bird

_DENSITY = 700.0  # kg/m3, of a trunk in its feathers
_SLENDERNESS = 5.5  # length over largest diameter
_RINGS, _AROUND = 15, 14
# Part of the length ahead of the centre of mass: the thickest part is there.
_AHEAD = 0.42


def body_shape(bird: Bird) -> tuple[FloatArray, IntArray]:
    """Vertices (V, 3) m in body axes and triangles (T, 3) of a spindle about the x axis."""
    along = np.linspace(0.0, 1.0, _RINGS)
    # Blunt breast, slender tail: thickest at `_AHEAD` from the front.
    thickness = np.sqrt(along) ** 1.5 * (1.0 - along) ** 1.04
    thickness /= thickness.max()
    part = float(np.trapezoid(thickness**2, along))
    radius = (bird.body.mass / (_DENSITY * np.pi * part * 2.0 * _SLENDERNESS)) ** (1.0 / 3.0)
    length = 2.0 * _SLENDERNESS * radius
    x = length * (_AHEAD - along)
    angle = 2.0 * np.pi * np.arange(_AROUND) / _AROUND
    circle = np.column_stack([np.zeros(_AROUND), np.cos(angle), np.sin(angle)])
    rings = radius * thickness[:, None, None] * circle
    rings[:, :, 0] = x[:, None]
    return rings.reshape(-1, 3), _tube(_RINGS, _AROUND)


def _tube(rings: int, around: int) -> IntArray:
    ring, place = np.divmod(np.arange((rings - 1) * around), around)
    here, beside = ring * around + place, ring * around + (place + 1) % around
    first = np.column_stack([here, beside, here + around])
    second = np.column_stack([beside, beside + around, here + around])
    return np.concatenate([first, second])


def tail_shape(bird: Bird) -> FloatArray | None:
    """Apex, right and left corner (3, 3) m of the tail, body axes; `None` if it is furled."""
    tail = bird.tail
    if tail is None or tail.span == 0.0:
        return None
    apex = np.array([tail.apex.x, 0.0, tail.apex.z])
    aft = tail.chord * np.array([-np.cos(tail.incidence), 0.0, np.sin(tail.incidence)])
    aside = np.array([0.0, 0.5 * tail.span, 0.0])
    return np.stack([apex, apex + aft + aside, apex + aft - aside])
