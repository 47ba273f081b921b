"""Studies of a bird's flight: trim, parameter studies, validity, tunnel, disturbed flight."""

from birdmb.studies.branch import bird_branch, flight_observables
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.errors import TrimError
from birdmb.studies.gust import gust_response
from birdmb.studies.memory import MemoryEffect, memory_effect
from birdmb.studies.parameter_study import parameter_study
from birdmb.studies.perturbed import flight_path, perturbed_flight
from birdmb.studies.scaling import ScaledBird, scale_bird
from birdmb.studies.stability_opening import stability_openings
from birdmb.studies.tail import tail_ranges, tail_study, within_limits
from birdmb.studies.tail_price import price_of_stability
from birdmb.studies.trim import Trim, TrimGuess, trim_flight
from birdmb.studies.tunnel import tunnel_and_free_flight
from birdmb.studies.validity import (
    Overlap,
    TailViolation,
    Validity,
    ValidityViolation,
    assess_validity,
)

__all__ = [
    "MemoryEffect",
    "ModelFactory",
    "Overlap",
    "ScaledBird",
    "TailViolation",
    "Trim",
    "TrimError",
    "TrimGuess",
    "Validity",
    "ValidityViolation",
    "assess_validity",
    "bird_branch",
    "flight_observables",
    "flight_path",
    "gust_response",
    "memory_effect",
    "parameter_study",
    "perturbed_flight",
    "price_of_stability",
    "scale_bird",
    "stability_openings",
    "tail_ranges",
    "tail_study",
    "trim_flight",
    "tunnel_and_free_flight",
    "within_limits",
]
