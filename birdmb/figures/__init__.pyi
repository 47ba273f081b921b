from .bird_branch import plot_bird_branch
from .branch import plot_branch, plot_stability_boundary
from .gust import plot_gust_response, plot_gust_states
from .kinematics import plot_kinematics
from .loads import plot_loads_and_power
from .multipliers import plot_multipliers
from .orbit import plot_orbit, plot_response
from .overview import plot_overview
from .page import paper
from .parameter_study import plot_multiplier_locus, plot_performance
from .perturbed_flight import plot_perturbed_flight
from .states import plot_states
from .sweep import plot_sweep
from .tail_study import plot_envelope, plot_manifold, plot_pareto, plot_stability_openings
from .tunnel import plot_tunnel_and_free_flight
from .validity import plot_validity
from .wing import plot_wing_phases

__all__ = [
    "paper",
    "plot_bird_branch",
    "plot_branch",
    "plot_envelope",
    "plot_gust_response",
    "plot_gust_states",
    "plot_kinematics",
    "plot_loads_and_power",
    "plot_manifold",
    "plot_multiplier_locus",
    "plot_multipliers",
    "plot_orbit",
    "plot_overview",
    "plot_pareto",
    "plot_performance",
    "plot_perturbed_flight",
    "plot_response",
    "plot_stability_boundary",
    "plot_stability_openings",
    "plot_states",
    "plot_sweep",
    "plot_tunnel_and_free_flight",
    "plot_validity",
    "plot_wing_phases",
]
