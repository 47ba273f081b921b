"""The bird as data: topology files, their validation, and dotted names for every value."""

from birdmb.topology.airframe import Apex, Drag, Tail
from birdmb.topology.attachments import Attachment
from birdmb.topology.bird import Bird
from birdmb.topology.drivers import Driver, Harmonic
from birdmb.topology.feathers import Feather, Hinge
from birdmb.topology.joints import SIDES, Joint, JointSide
from birdmb.topology.loading import load_bird
from birdmb.topology.parts import Air, Body, Gait
from birdmb.topology.samples import DriverFit
from birdmb.topology.sections import Section
from birdmb.topology.segments import Segment, Segments
from birdmb.topology.values import parse_assignment
from birdmb.topology.wings import (
    PRESETS,
    Discretisation,
    Polar,
    Profile,
    Root,
    Stall,
    Wing,
)

__all__ = [
    "PRESETS",
    "SIDES",
    "Air",
    "Apex",
    "Attachment",
    "Bird",
    "Body",
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
    "Polar",
    "Profile",
    "Root",
    "Section",
    "Segment",
    "Segments",
    "Stall",
    "Tail",
    "Wing",
    "load_bird",
    "parse_assignment",
]
