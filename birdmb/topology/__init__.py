"""The bird as data: topology files, their validation, and dotted names for every value."""

from birdmb.topology.airframe import Apex, Drag, Tail
from birdmb.topology.bird import Bird, Segments
from birdmb.topology.loading import load_bird
from birdmb.topology.parts import (
    BONES,
    PRESETS,
    Air,
    Body,
    Bone,
    Discretisation,
    Feather,
    Gait,
    Hinge,
    Joint,
    Root,
    Segment,
    Wing,
)
from birdmb.topology.values import parse_assignment

__all__ = [
    "BONES",
    "PRESETS",
    "Air",
    "Apex",
    "Bird",
    "Body",
    "Bone",
    "Discretisation",
    "Drag",
    "Feather",
    "Gait",
    "Hinge",
    "Joint",
    "Root",
    "Segment",
    "Segments",
    "Tail",
    "Wing",
    "load_bird",
    "parse_assignment",
]
