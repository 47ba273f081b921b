"""Models of a bird in flight: each turns a bird into a flow of named states."""

from typing import TypeAlias

from birdmb.models.beat import Beat
from birdmb.models.cycle_file import load_cycle
from birdmb.models.energy import Work
from birdmb.models.flight import Flight
from birdmb.models.flight_cycle import FlightCycle
from birdmb.models.flight_modes import FlightMode
from birdmb.models.gusts import CosineGust, GaussianGust, Gust, StepGust
from birdmb.models.loads import Loads, TailLoads, WingLoads
from birdmb.models.multibody import MultibodyModel
from birdmb.models.rigid import RigidModel
from birdmb.models.wing_model import BirdModel

FlightModel: TypeAlias = RigidModel | MultibodyModel
"""A model of a bird whose limit cycles are flights."""

__all__ = [
    "Beat",
    "BirdModel",
    "CosineGust",
    "Flight",
    "FlightCycle",
    "FlightMode",
    "FlightModel",
    "GaussianGust",
    "Gust",
    "Loads",
    "MultibodyModel",
    "RigidModel",
    "StepGust",
    "TailLoads",
    "WingLoads",
    "Work",
    "load_cycle",
]
