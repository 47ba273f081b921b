from .errors import ArgumentError, BirdmbError, OrbitError, StateError, TopologyError
from .figures import plot_gust_response
from .kinematics import JointMotion, KinematicsError, KinematicsFit, fit_kinematics
from .models import (
    Beat,
    CosineGust,
    Flight,
    FlightCycle,
    GaussianGust,
    Loads,
    MultibodyModel,
    RigidModel,
    StepGust,
)
from .morphology import bird_from_morphology
from .orbits import (
    Branch,
    ConvergenceError,
    FloquetResult,
    LimitCycle,
    OdeModel,
    continue_branch,
    find_limit_cycle,
    find_limit_cycles,
    floquet,
    largest_lyapunov_exponent,
    load_branch,
    mode_disturbance,
    perturbed_response,
    stability_boundary,
)
from .studies import (
    MemoryEffect,
    Trim,
    TrimError,
    Validity,
    assess_validity,
    gust_response,
    memory_effect,
    parameter_study,
    perturbed_flight,
    trim_flight,
    tunnel_and_free_flight,
)
from .studies.branch import bird_branch
from .studies.moving_wing import MovingWingLoads, PlaneWing, WingMotion, moving_wing_loads
from .studies.scaling import ScaledBird, scale_bird
from .studies.stability_opening import stability_openings
from .studies.sweeps import Study, SweepError, Trimming, sweep
from .studies.tail import tail_study
from .topology import Bird, load_bird
from .topology.shipped import bird_names

__version__: str

__all__ = [
    "ArgumentError",
    "Beat",
    "Bird",
    "BirdmbError",
    "Branch",
    "ConvergenceError",
    "CosineGust",
    "Flight",
    "FlightCycle",
    "FloquetResult",
    "GaussianGust",
    "JointMotion",
    "KinematicsError",
    "KinematicsFit",
    "LimitCycle",
    "Loads",
    "MemoryEffect",
    "MovingWingLoads",
    "MultibodyModel",
    "OdeModel",
    "OrbitError",
    "PlaneWing",
    "RigidModel",
    "ScaledBird",
    "StateError",
    "StepGust",
    "Study",
    "SweepError",
    "TopologyError",
    "Trim",
    "TrimError",
    "Trimming",
    "Validity",
    "WingMotion",
    "assess_validity",
    "bird_branch",
    "bird_from_morphology",
    "bird_names",
    "continue_branch",
    "find_limit_cycle",
    "find_limit_cycles",
    "fit_kinematics",
    "floquet",
    "gust_response",
    "largest_lyapunov_exponent",
    "load_bird",
    "load_branch",
    "memory_effect",
    "mode_disturbance",
    "moving_wing_loads",
    "parameter_study",
    "perturbed_flight",
    "perturbed_response",
    "plot_gust_response",
    "scale_bird",
    "stability_boundary",
    "stability_openings",
    "sweep",
    "tail_study",
    "trim_flight",
    "tunnel_and_free_flight",
]
