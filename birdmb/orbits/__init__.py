"""Periodic orbits and their Floquet multipliers, for any system with a flow."""

from birdmb.orbits.cycle import LimitCycle
from birdmb.orbits.errors import (
    ArgumentError,
    ConvergenceError,
    EquilibriumError,
    NotClosedError,
    SingularJacobianError,
)
from birdmb.orbits.floquet import floquet
from birdmb.orbits.lyapunov import LyapunovEstimate, largest_lyapunov_exponent
from birdmb.orbits.multipliers import MultiplierSolver, Stability, product_multipliers
from birdmb.orbits.newton import Iteration
from birdmb.orbits.ode import OdeModel, Trajectory
from birdmb.orbits.periodic import periodic_multipliers
from birdmb.orbits.problem import Model, VariationalModel
from birdmb.orbits.response import PerturbedResponse, mode_disturbance, perturbed_response
from birdmb.orbits.result import FloquetResult
from birdmb.orbits.search import find_limit_cycle

__all__ = [
    "ArgumentError",
    "ConvergenceError",
    "EquilibriumError",
    "FloquetResult",
    "Iteration",
    "LimitCycle",
    "LyapunovEstimate",
    "Model",
    "MultiplierSolver",
    "NotClosedError",
    "OdeModel",
    "PerturbedResponse",
    "SingularJacobianError",
    "Stability",
    "Trajectory",
    "VariationalModel",
    "find_limit_cycle",
    "floquet",
    "largest_lyapunov_exponent",
    "mode_disturbance",
    "periodic_multipliers",
    "perturbed_response",
    "product_multipliers",
]
