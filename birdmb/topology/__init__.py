"""The bird as data: topology files, their validation, and dotted names for every value."""

from birdmb.topology.airframe import Apex, Drag, Tail
from birdmb.topology.bird import Bird, Segments
from birdmb.topology.drivers import Driver, Harmonic
from birdmb.topology.joints import SIDES, Joint, JointSide
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
    Root,
    Segment,
    Wing,
)
from birdmb.topology.samples import DriverFit
from birdmb.topology.values import parse_assignment

__all__ = [
    "BONES",
    "PRESETS",
    "SIDES",
    "Air",
    "Apex",
    "Bird",
    "Body",
    "Bone",
    "Discretisation",
    "Drag",
    "Driver",
    "DriverFit",
    "Feather",
    "Gait",
    "Harmonic",
    "Hinge",
    "Joint",
    "JointSide",
    "Root",
    "Segment",
    "Segments",
    "Tail",
    "Wing",
    "load_bird",
    "parse_assignment",
]
