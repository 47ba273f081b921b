"""Which of the body's six motions a model leaves free: its states, their names, units and sizes.

In space the body has the states u, v, w (m/s, velocity of the centre of mass G along the body's
axes), p, q, r (rad/s, angular velocity about them), phi and theta (rad, roll and pitch angle).
Place and heading are ignorable. The axes follow from those of the heading by turning by theta about
y, then by phi about x.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from birdmb._typing import BoolArray, FloatArray, IntArray
from birdmb.errors import ArgumentError

MotionName = Literal["planar", "free", "held"]
FlightMotionName = Literal["planar", "free"]

SPACE_STATES = ("u", "v", "w", "p", "q", "r", "phi", "theta")
_UNITS = ("m/s",) * 3 + ("rad/s",) * 3 + ("rad",) * 2
_SCALE = (10.0, 2.0, 2.0, 1.0, 1.0, 1.0, 0.2, 0.2)
_LATERAL = ("v", "p", "r", "phi")
_TWIST = 6
_PHI, _THETA = 6, 7


@dataclass(frozen=True)
class Mirror:
    """The mirror image, in the plane of symmetry, of a state x: `signs * x[order]`."""

    order: IntArray
    signs: FloatArray


@dataclass(frozen=True)
class Motion:
    """A choice of the body's states in space; the others are zero.

    Attributes:
        name: how users ask for it.
        states: names of its m states, in the order of `SPACE_STATES`.
    """

    name: MotionName
    states: tuple[str, ...]

    @cached_property
    def indices(self) -> IntArray:
        """Positions (m,) of the states among those in space."""
        return np.array([SPACE_STATES.index(name) for name in self.states], dtype=np.int64)

    @cached_property
    def directions(self) -> IntArray:
        """Components of the twist (6,) that are states."""
        return self.indices[self.indices < _TWIST]

    @cached_property
    def units(self) -> tuple[str, ...]:
        """Units of the states."""
        return tuple(_UNITS[i] for i in self.indices)

    @cached_property
    def scale(self) -> tuple[float, ...]:
        """Typical sizes of the states."""
        return tuple(_SCALE[i] for i in self.indices)

    @cached_property
    def is_symmetric(self) -> bool:
        """Whether the body stays in its plane of symmetry."""
        return not self.lateral.any()

    @property
    def lateral(self) -> BoolArray:
        """Which (m,) of the states are lateral: mirroring the bird changes their sign."""
        return np.array([name in _LATERAL for name in self.states], dtype=bool)

    def in_space(self, states: FloatArray) -> FloatArray:
        """States in space (K, 8) of `states` (K, n), the first m of which are the body's."""
        found = np.zeros((len(states), len(SPACE_STATES)))
        found[:, self.indices] = states[:, : len(self.states)]
        return found


PLANAR = Motion("planar", ("u", "w", "q", "theta"))
FREE = Motion("free", SPACE_STATES)
HELD = Motion("held", ())


def motion_named(name: str, among: tuple[Motion, ...] = (PLANAR, FREE)) -> Motion:
    """The motion of a name; raises `ArgumentError` where there is none `among` these."""
    for motion in among:
        if motion.name == name:
            return motion
    names = [f'"{motion.name}"' for motion in among]
    listed = f"{', '.join(names[:-1])} or {names[-1]}"
    raise ArgumentError(f'motion must be {listed}, not "{name}".')


def heading_velocity(space: FloatArray) -> FloatArray:
    """Velocity (K, 3) m/s forward, to the right and upwards, seen along the heading.

    Of states in space (K, 8).
    """
    forward, right, down = np.einsum("kba,kb->ak", _heading_in_body(space), space[:, :3])
    return np.column_stack([forward, right, -down])


def planar_velocity(states: FloatArray) -> FloatArray:
    """Forward speed and climb rate (K, 2) m/s of states (K, n) in planar motion."""
    # As `heading_velocity`, whose other states are zero.
    u, w, _, theta = states[:, : len(PLANAR.states)].T
    c, s = np.cos(theta), np.sin(theta)
    return np.array([c * u + s * w, s * u - c * w]).T


def heading_rate(space: FloatArray) -> FloatArray:
    """Rates (K,) rad/s of the heading, to the right positive, of states in space (K, 8)."""
    q, r, phi, theta = space[:, 4:].T
    return np.asarray((q * np.sin(phi) + r * np.cos(phi)) / np.cos(theta))


def along_body(space: FloatArray, air: FloatArray) -> FloatArray:
    """Components (K, 3) along the body's axes of `air` (K, 3) m/s, forwards, right and down.

    In the attitude of states in space (K, 8).
    """
    return np.asarray(np.einsum("kba,ka->kb", _heading_in_body(space), air))


def gravity_along_body(space: FloatArray, gravity: float) -> FloatArray:
    """Gravitational acceleration (K, 3) m/s2 along the body's axes, of states in space (K, 8)."""
    phi, theta = space[:, [_PHI, _THETA]].T
    along = np.empty((len(space), 3))
    along[:, 0] = -gravity * np.sin(theta)
    down = gravity * np.cos(theta)
    along[:, 1], along[:, 2] = down * np.sin(phi), down * np.cos(phi)
    return along


def _heading_in_body(space: FloatArray) -> FloatArray:
    """Axes of the heading, forward, right and down, along the body's; columns of (K, 3, 3)."""
    phi, theta = space[:, [_PHI, _THETA]].T
    c, s, cr, sr = np.cos(theta), np.sin(theta), np.cos(phi), np.sin(phi)
    rows = [[c, 0.0 * c, -s], [s * sr, cr, c * sr], [s * cr, -sr, c * cr]]
    return np.array(rows).transpose(2, 0, 1)
