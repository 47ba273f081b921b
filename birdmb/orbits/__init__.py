"""Periodic orbits and their Floquet multipliers, for any system with a flow."""

from birdmb.orbits.cycle import LimitCycle
from birdmb.orbits.errors import (
    ArgumentError,
    ConvergenceError,
    EquilibriumError,
    SingularJacobianError,
)
from birdmb.orbits.multipliers import Stability
from birdmb.orbits.newton import Iteration
from birdmb.orbits.ode import OdeModel, Trajectory
from birdmb.orbits.problem import Model, VariationalModel
from birdmb.orbits.search import find_limit_cycle

__all__ = [
    "ArgumentError",
    "ConvergenceError",
    "EquilibriumError",
    "Iteration",
    "LimitCycle",
    "Model",
    "OdeModel",
    "SingularJacobianError",
    "Stability",
    "Trajectory",
    "VariationalModel",
    "find_limit_cycle",
]
