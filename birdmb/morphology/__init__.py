"""A bird's masses, centres of mass and inertias from the parts that were weighed and measured."""

from birdmb.morphology.building import bird_from_morphology
from birdmb.morphology.solids import (
    MassProperties,
    combined,
    cylinder,
    ellipsoid,
    plate,
    point_mass,
    rod,
)

__all__ = [
    "MassProperties",
    "bird_from_morphology",
    "combined",
    "cylinder",
    "ellipsoid",
    "plate",
    "point_mass",
    "rod",
]
