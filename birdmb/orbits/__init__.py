"""Periodic orbits and their Floquet multipliers, for any system with a flow."""

from birdmb.errors import ArgumentError
from birdmb.orbits.boundary import BoundaryPoint, StabilityBoundary, stability_boundary
from birdmb.orbits.branch import Branch, load_branch
from birdmb.orbits.branch_points import Bifurcation, BranchPoint
from birdmb.orbits.coexisting import Attempt, find_limit_cycles
from birdmb.orbits.continuation import continue_branch
from birdmb.orbits.cycle import LimitCycle
from birdmb.orbits.errors import (
    BranchFileError,
    BranchStopped,
    ConvergenceError,
    EquilibriumError,
    NotClosedError,
    NotSmoothError,
    SingularJacobianError,
)
from birdmb.orbits.floquet import floquet
from birdmb.orbits.iteration import Iteration
from birdmb.orbits.lyapunov import LyapunovEstimate, largest_lyapunov_exponent
from birdmb.orbits.multipliers import MultiplierSolver, Stability, product_multipliers
from birdmb.orbits.ode import OdeModel, Trajectory
from birdmb.orbits.periodic import periodic_multipliers
from birdmb.orbits.problem import Model, VariationalModel
from birdmb.orbits.response import PerturbedResponse, mode_disturbance, perturbed_response
from birdmb.orbits.result import FloquetResult
from birdmb.orbits.search import find_limit_cycle
from birdmb.orbits.tracer import Steps

__all__ = [
    "ArgumentError",
    "Attempt",
    "Bifurcation",
    "BoundaryPoint",
    "Branch",
    "BranchFileError",
    "BranchPoint",
    "BranchStopped",
    "ConvergenceError",
    "EquilibriumError",
    "FloquetResult",
    "Iteration",
    "LimitCycle",
    "LyapunovEstimate",
    "Model",
    "MultiplierSolver",
    "NotClosedError",
    "NotSmoothError",
    "OdeModel",
    "PerturbedResponse",
    "SingularJacobianError",
    "Stability",
    "StabilityBoundary",
    "Steps",
    "Trajectory",
    "VariationalModel",
    "continue_branch",
    "find_limit_cycle",
    "find_limit_cycles",
    "floquet",
    "largest_lyapunov_exponent",
    "load_branch",
    "mode_disturbance",
    "periodic_multipliers",
    "perturbed_response",
    "product_multipliers",
    "stability_boundary",
]
