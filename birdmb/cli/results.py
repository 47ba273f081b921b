"""A limit cycle as one JSON object, and as a sentence."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import asdict
from importlib.metadata import version
from typing import TYPE_CHECKING

import numpy as np

from birdmb.quantities import described_by, valid_by
from birdmb.topology.joints import split_side

if TYPE_CHECKING:
    from birdmb.models import FlightCycle, FlightMode
    from birdmb.models.wing_model import BirdModel
    from birdmb.studies import Validity


def finite(value: float) -> float | None:
    """A number fit for JSON, which has no infinity and no NaN: `None` stands for them."""
    return float(value) if math.isfinite(value) else None


def result_object(cycle: FlightCycle, validity: Validity, model_name: str) -> dict[str, object]:
    """What `birdmb cycle --json` prints, in SI units and rad: numbers, texts, lists and objects."""
    model = cycle.model
    bird = model.bird
    return {
        "bird": bird.name,
        "fingerprint": bird.fingerprint(),
        "model": model_name,
        "motion": model.motion.name,
        "birdmb_version": version("birdmb"),
        "x0": dict(zip(cycle.state_names, _numbers(cycle.x0), strict=True)),
        "start_time": cycle.start_time,
        "method": cycle.method,
        "method_reason": cycle.method_reason,
        "nodes": cycle.nodes,
        "intervals": cycle.intervals,
        "flown_closure": finite(cycle.flown_closure),
        "iterations": len(cycle.iterations) - 1,
        "steps_per_beat": model.steps_per_beat,
        "integrator": model.integration_method,
        "multipliers": [[float(m.real), float(m.imag)] for m in cycle.multipliers],
        "multiplier_errors": _numbers(cycle.multiplier_errors),
        "multiplier_integration_errors": _numbers(cycle.multiplier_integration_errors),
        "doubling_times": _numbers(cycle.doubling_times),
        "modes": [_mode(mode) for mode in cycle.flight_modes],
        "stability": cycle.stability,
        "verdict": verdict_sentence(cycle),
        "failed_checks": list(cycle.failed_checks),
        "why_no_flight": cycle.why_no_flight,
        "taken_as_prescribed": taken_as_prescribed(model),
        **{name: finite(value) for name, value in described_by(cycle).items()},
        "joint_powers": cycle.joint_powers,
        "driver_powers": cycle.driver_powers,
        "driver_work": {name: work._asdict() for name, work in cycle.driver_work.items()},
        "dissipation": cycle.dissipation,
        **{name: finite(value) for name, value in valid_by(validity).items()},
        "validity_warnings": list(validity.warnings),
        "stalled_sections": [asdict(section) for section in validity.stalled],
    }


def _mode(mode: FlightMode) -> dict[str, object]:
    """A mode: multiplier as real and imaginary part, times in s."""
    return {
        "plane": mode.plane,
        "name": mode.name,
        "multiplier": [mode.multiplier.real, mode.multiplier.imag],
        "error": finite(mode.error),
        "doubling_time": finite(mode.doubling_time),
        "participation": mode.participation,
    }


def taken_as_prescribed(model: BirdModel) -> list[str]:
    """Compliant joints and hinges that the model holds to their drivers."""
    free = [joint.name for joint in model.bird.compliant_joints]
    free += [feather.hinge_name for feather in model.bird.hinged_feathers]
    moving = {split_side(state)[0] for state in model.state_names}
    return [name for name in free if name not in moving]


def mean_flight(cycle: FlightCycle) -> dict[str, float]:
    """Speed and climb rate, m/s, and pitch angle, rad, of a flight on average over a beat."""
    return {
        "mean_speed": cycle.mean_speed,
        "mean_climb_rate": cycle.mean_climb_rate,
        "mean_pitch": cycle.mean_pitch,
    }


def other_flights_sentence(others: list[FlightCycle]) -> str:
    """That a bird has other flights than the one reported, and which."""
    each = " and ".join(
        f"{o.mean_speed:.2f} m/s, climbing {o.mean_climb_rate:+.2f} m/s ({o.stability})"
        for o in others
    )
    flights = "another flight" if len(others) == 1 else "other flights"
    return f"This bird has {flights}, at {each}: `birdmb flights` lists all that it finds."


def _numbers(values: Iterable[float]) -> list[float | None]:
    return [finite(value) for value in values]


def growth(cycle: FlightCycle, i: int) -> str:
    """What a disturbance in mode i does: "doubles in 0.471 s (1.9 beats)"."""
    modulus, error = float(np.abs(cycle.multipliers[i])), float(cycle.verdict_errors[i])
    if not abs(modulus - 1) > error:
        return "undecided within its error"
    if modulus < 1 and error > 0.01 * modulus:  # all that is known is how slow it is at most
        slowest = cycle.period * math.log(2) / -math.log(modulus + error)
        return f"halves in < {_time(slowest, cycle.period)}"
    does = "doubles" if modulus > 1 else "halves"
    return f"{does} in {_time(float(cycle.doubling_times[i]), cycle.period)}"


def _time(seconds: float, period: float) -> str:
    return f"{seconds:.2g} s ({seconds / period:.2g} beats)"


def verdict_sentence(cycle: FlightCycle) -> str:
    """Whether the bird can fly hands-off at its speed and climb, and how fast disturbances grow.

    What speaks against the numbers, or against calling them a flight, comes first.
    """
    doubts = []
    if cycle.failed_checks:
        doubts.append(f"not to be trusted: {' and '.join(cycle.failed_checks)}")
    if cycle.why_no_flight is not None:
        doubts.append(f"not a flight: {cycle.why_no_flight}")
    return "; ".join([*doubts, _verdict(cycle)])


def _verdict(cycle: FlightCycle) -> str:
    rate = cycle.mean_climb_rate
    flight = f"{cycle.stability} at {cycle.mean_speed:.2f} m/s, climbing {rate:+.2f} m/s:"
    if cycle.stability == "unstable":
        return f"{flight} the fastest-growing disturbance {growth(cycle, 0)}"
    if cycle.stability == "stable":
        return f"{flight} the slowest-decaying disturbance {growth(cycle, 0)}"
    return (
        f"{flight} the modulus of a multiplier is 1 within its error, so that the disturbance may "
        "grow or decay"
    )
