"""Mass, centre of mass and inertia of simple solids of uniform density, and of several together.

Every solid is described by its second moments of mass S = sum of m_i r_i r_i^T about its centre of
mass, which add up; the inertia tensor is trace(S) 1 - S. Points are (3,), m, in any one frame.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError


@dataclass(frozen=True)
class MassProperties:
    """Mass, centre of mass and second moments of mass of a solid.

    Attributes:
        mass: kg.
        centre: centre of mass (3,), m.
        second_moments: of mass about the centre of mass (3, 3), kg m2.
    """

    mass: float
    centre: FloatArray
    second_moments: FloatArray

    @property
    def inertia(self) -> FloatArray:
        """Inertia tensor (3, 3) about the centre of mass, kg m2."""
        return np.asarray(np.trace(self.second_moments) * np.eye(3) - self.second_moments)


def point_mass(mass: float, at: npt.ArrayLike) -> MassProperties:
    """A mass (kg) in one point."""
    return _solid(mass, at, [])


def rod(mass: float, start: npt.ArrayLike, end: npt.ArrayLike) -> MassProperties:
    """A slender straight rod of mass m and length l between two points: m l^2/12 across it."""
    start, end = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    return _solid(mass, (start + end) / 2, [(end - start) / np.sqrt(12)])


def cylinder(
    mass: float, start: npt.ArrayLike, end: npt.ArrayLike, across: npt.ArrayLike
) -> MassProperties:
    """A solid elliptic cylinder between the centres of its two ends.

    With semi-axes a and b: m (a^2 + b^2)/4 along it, m (l^2/12 + a^2/4) about the axis of b.

    Args:
        mass: m, kg.
        start, end: centres (3,) of its ends, l apart.
        across: the two semi-axes (2, 3) of its section as vectors, m; equal lengths for a round
            one, and square to each other and to the axis.
    """
    start, end = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    semi_axes = np.asarray(across, dtype=float) / 2
    return _solid(mass, (start + end) / 2, [(end - start) / np.sqrt(12), *semi_axes])


def plate(mass: float, centre: npt.ArrayLike, sides: npt.ArrayLike) -> MassProperties:
    """A thin flat parallelogram; a rectangle of sides a and b has m a^2/12, m b^2/12 in its plane.

    Args:
        mass: m, kg.
        centre: centre (3,), m.
        sides: its two sides (2, 3) as vectors, m.
    """
    return _solid(mass, centre, np.asarray(sides, dtype=float) / np.sqrt(12))


def ellipsoid(mass: float, centre: npt.ArrayLike, semi_axes: npt.ArrayLike) -> MassProperties:
    """A solid ellipsoid: m (b^2 + c^2)/5 about the axis of a, and likewise.

    Args:
        mass: m, kg.
        centre: centre (3,), m.
        semi_axes: the three semi-axes a, b, c (3, 3) as vectors square to each other, m.
    """
    return _solid(mass, centre, np.asarray(semi_axes, dtype=float) / np.sqrt(5))


def combined(solids: Iterable[MassProperties]) -> MassProperties:
    """Several solids as one, by Steiner's theorem.

    Raises:
        ArgumentError: they have no mass, and so no centre of mass.
    """
    solids = list(solids)
    mass = sum(solid.mass for solid in solids)
    if not mass > 0.0:
        raise ArgumentError("solids without mass have no centre of mass.")
    centre = sum((solid.mass * solid.centre for solid in solids), np.zeros(3)) / mass
    second_moments = np.zeros((3, 3))
    for solid in solids:
        lever = solid.centre - centre
        second_moments += solid.second_moments + solid.mass * np.outer(lever, lever)
    return MassProperties(mass, centre, second_moments)


def _solid(mass: float, centre: npt.ArrayLike, spreads: npt.ArrayLike) -> MassProperties:
    """A solid whose mass has these root mean squares (k, 3), m, along directions of its own."""
    along = np.asarray(spreads, dtype=float).reshape(-1, 3)
    return MassProperties(mass, np.asarray(centre, dtype=float), mass * along.T @ along)
