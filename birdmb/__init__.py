"""Limit cycles, Floquet stability and power of flapping birds.

A bird is data (`load_bird`), a model turns it into a flow (`RigidModel`, `MultibodyModel`), an
orbit is a fixed point of that flow (`find_limit_cycle`), and its multipliers say whether the bird
can fly hands-off.
"""

from importlib.metadata import version

from birdmb.errors import BirdmbError, OrbitError, StateError, TopologyError
from birdmb.models import (
    Beat,
    Flight,
    FlightCycle,
    Loads,
    MultibodyModel,
    RigidModel,
)
from birdmb.orbits import ConvergenceError, LimitCycle, OdeModel, find_limit_cycle
from birdmb.topology import Bird, load_bird

__version__ = version("birdmb")

__all__ = [
    "Beat",
    "Bird",
    "BirdmbError",
    "ConvergenceError",
    "Flight",
    "FlightCycle",
    "LimitCycle",
    "Loads",
    "MultibodyModel",
    "OdeModel",
    "OrbitError",
    "RigidModel",
    "StateError",
    "TopologyError",
    "__version__",
    "find_limit_cycle",
    "load_bird",
]
