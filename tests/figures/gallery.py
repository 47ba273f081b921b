"""Every figure that the package draws of its results, from coarse and quick computations."""

import functools
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

import birdmb
from birdmb import figures
from birdmb.kinematics import KinematicsFit, fit_kinematics
from birdmb.orbits import (
    Branch,
    LimitCycle,
    OdeModel,
    PerturbedResponse,
    StabilityBoundary,
    Steps,
    continue_branch,
    find_limit_cycle,
    mode_disturbance,
    perturbed_response,
    stability_boundary,
)
from birdmb.studies import assess_validity, bird_branch, gust_response
from birdmb.studies.parameter_study import parameter_study
from birdmb.studies.perturbed import perturbed_flight
from birdmb.studies.stability_opening import StabilityOpening
from birdmb.studies.sweeps import sweep
from birdmb.studies.zero_curve import ZeroCurve

from ..studies.sweeping import Inline

EXAMPLES = Path(__file__).parents[2] / "examples"
FLAP, SWEEP, OPENING = (
    "shoulder.flap.amplitude_deg",
    "shoulder.sweep.offset_deg",
    "tail.opening_deg",
)
RIGID = functools.partial(birdmb.RigidModel, steps_per_beat=30)


def coarse(name: str) -> birdmb.Bird:
    return birdmb.load_bird(name).with_values({"wing.discretisation": 8})


@functools.cache
def cycle() -> birdmb.FlightCycle:
    model = birdmb.MultibodyModel(coarse("ibis_compliant_shoulder"), steps_per_beat=32)
    return birdmb.find_limit_cycle(model, tolerance=1e-7)


@functools.cache
def rigid() -> birdmb.FlightCycle:
    return birdmb.find_limit_cycle(RIGID(coarse("ibis_tail")))


@functools.cache
def flap_study() -> xr.Dataset:
    return parameter_study(coarse("ibis"), FLAP, [38.0, 42.0, 46.0])


@functools.cache
def tail() -> xr.Dataset:
    """Flights of the bird with a tail, the verdicts mixed: the pictures must show them all."""
    values = {SWEEP: [-15.0, -13.0], FLAP: [40.0, 44.0], OPENING: [20.0, 35.0]}
    with TemporaryDirectory() as directory:
        study = sweep(
            coarse("ibis_tail"),
            values,
            store=Path(directory) / "s.db",
            executor=Inline(),
            model=RIGID,
        )
        data = study.to_xarray(timings=True).load()
    data["largest_modulus"][...] = [[[1.1, 0.95], [1.05, 0.9]], [[1.02, 0.97], [1.2, 0.85]]]
    data["stability"] = xr.where(data["largest_modulus"] > 1, "unstable", "stable")
    data["stability"][0, 0, 0] = "undecided"
    data["warning"][...] = ""
    data["warning"][0, 1, 1] = "beyond"
    data["flight"][0, 0, 1] = "backwards"
    data["sheet_jump"][0, 0, 0, 1] = True
    return data


@functools.cache
def grid() -> xr.Dataset:
    return tail().isel({SWEEP: 0}).sel(along=[FLAP, OPENING])


def openings() -> tuple[StabilityOpening, ...]:
    ends = ("the end of the range",) * 2
    return tuple(
        StabilityOpening(
            FLAP, SWEEP, at, (ZeroCurve(np.array([[36.0, 20.0 - at], [44.0, 30.0]]), ends),)
        )
        for at in (-15.0, -14.0, -13.0)
    )


def _duffing(frequency: float) -> OdeModel:
    return OdeModel(
        lambda t, s: [s[1], -0.1 * s[1] - s[0] - s[0] ** 3 + 0.3 * np.cos(frequency * t)],
        ("x", "v"),
        period=2 * np.pi / frequency,
        guess=[0.3, 0.0],
    )


def _mathieu(q: float, a: float) -> OdeModel:
    return OdeModel(
        lambda t, s: [s[1], -0.1 * s[1] - (a - 2 * q * np.cos(2 * t)) * s[0]],
        ("x", "v"),
        period=np.pi,
        guess=[0.0, 0.0],
        state_scale=[1.0, 1.0],
    )


@functools.cache
def oscillation() -> LimitCycle:
    model = OdeModel(
        lambda _, s: [s[1], 0.3 * (1 - s[0] ** 2) * s[1] - s[0]], ("x", "v"), guess=[2.0, 0.0]
    )
    return find_limit_cycle(model, period_guess=6.3)


@functools.cache
def response() -> PerturbedResponse:
    return perturbed_response(oscillation(), mode_disturbance(oscillation(), 1, 0.3), periods=2)


@functools.cache
def branch() -> Branch:
    return continue_branch(_duffing, (1.6, 2.0), parameter_name="frequency", max_points=20)


@functools.cache
def boundary() -> StabilityBoundary:
    return stability_boundary(
        _mathieu,
        (0.0, 1.0),
        [0.8, 1.0],
        first_name="q",
        second_name="a",
        steps=Steps(first=0.2, longest=0.3),
    )


@functools.cache
def flights() -> Branch:
    """Flights over the stiffness of the shoulder, with verdicts of all kinds."""
    found = bird_branch(
        coarse("ibis_compliant_shoulder"),
        "shoulder.flap.stiffness",
        (30.0, 20.0),
        steps=Steps(first=0.3, longest=0.4),
        max_points=3,
    )
    verdicts = ("stable", "unstable", "undecided")
    points = tuple(
        replace(point, observables={**point.observables, "largest_angle_of_attack": angle})
        for point, angle in zip(found.points, (0.2, 0.3, 0.2), strict=True)
    )
    for point, verdict in zip(points, verdicts, strict=True):
        vars(point)["stability"] = verdict
    return replace(found, points=points)


@functools.cache
def gust() -> xr.Dataset:
    return gust_response(cycle(), birdmb.GaussianGust(vertical=1.0, horizontal=0.5), periods=2)


@functools.cache
def disturbed() -> xr.Dataset:
    return perturbed_flight(rigid(), amplitude=0.05, periods=2, samples=30)


@functools.cache
def gait() -> KinematicsFit:
    return fit_kinematics(EXAMPLES / "pigeon_points.csv", "pigeon", frame="forward-left-up")


GALLERY: dict[str, Callable[[], Figure]] = {
    "states": lambda: figures.plot_states(cycle()),
    "multipliers": lambda: figures.plot_multipliers(cycle()),
    "loads": lambda: figures.plot_loads_and_power(cycle()),
    "wing": lambda: figures.plot_wing_phases(cycle()),
    "overview": lambda: figures.plot_overview(cycle()),
    "tunnel": lambda: figures.plot_tunnel_and_free_flight(rigid()),
    "validity": lambda: figures.plot_validity(assess_validity(rigid()).data),
    "gust": lambda: figures.plot_gust_response(gust()),
    "gust_states": lambda: figures.plot_gust_states(gust()),
    "perturbed": lambda: figures.plot_perturbed_flight(disturbed()),
    "performance": lambda: figures.plot_performance(flap_study()),
    "locus": lambda: figures.plot_multiplier_locus(flap_study()),
    "sweep_map": lambda: figures.plot_sweep(grid(), None, {}),
    "sweep_angle": lambda: figures.plot_sweep(grid(), "path_angle", {}),
    "sweep_lines": lambda: figures.plot_sweep(grid(), None, {FLAP: 40.0}),
    "manifold": lambda: figures.plot_manifold(tail(), {}),
    "envelope": lambda: figures.plot_envelope(tail(), limits={}),
    "pareto": lambda: figures.plot_pareto(tail(), {}),
    "openings": lambda: figures.plot_stability_openings(openings(), "ibis_tail"),
    "orbit": lambda: oscillation().plot(),
    "response": lambda: response().plot(),
    "branch": lambda: branch().plot("v"),
    "boundary": lambda: boundary().plot(),
    "bird_branch": lambda: figures.plot_bird_branch(flights()),
    "kinematics": lambda: gait().plot(),
}
