"""Every figure that the package draws, from coarse and quick computations."""

import functools
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

import birdmb
from birdmb import figures
from birdmb.kinematics import fit_kinematics
from birdmb.orbits import (
    OdeModel,
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
from birdmb.studies.stability_opening import stability_openings
from birdmb.studies.sweeps import sweep
from birdmb.studies.tail import tail_study

EXAMPLES = Path(__file__).parents[2] / "examples"
FLAP = "shoulder.flap"
RIGID = functools.partial(birdmb.RigidModel, steps_per_beat=32)


class Inline:
    """An executor that computes where it is asked."""


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
    return parameter_study(coarse("ibis"), f"{FLAP}.amplitude_deg", [38.0, 42.0, 46.0])


@functools.cache
def grid() -> xr.Dataset:
    """Flights of the bird with a tail, some of them stable."""
    values = {"tail.opening_deg": [5.0, 20.0, 35.0], f"{FLAP}.amplitude_deg": [36.0, 40.0, 44.0]}
    with TemporaryDirectory() as directory:
        study = sweep(
            coarse("ibis_tail"), values, store=Path(directory) / "s.db", workers=1, model=RIGID
        )
        return study.to_xarray(timings=True)


@functools.cache
def tail() -> xr.Dataset:
    values = {
        "forearm.sweep.offset_deg": [-15.0, -13.0],
        f"{FLAP}.amplitude_deg": [36.0, 40.0, 44.0],
        "tail.opening_deg": [5.0, 20.0, 35.0],
    }
    with TemporaryDirectory() as directory:
        study = tail_study(coarse("ibis_tail"), Path(directory) / "t.db", values, workers=1)
        return study.to_xarray(timings=True)


@functools.cache
def openings() -> tuple:
    return stability_openings(
        coarse("ibis_tail"), {f"{FLAP}.amplitude_deg": (36.0, 44.0)},
        {"forearm.sweep.offset_deg": [-15.0, -13.0]}, openings=(5.0, 40.0),
    )  # fmt: skip


def duffing(frequency: float) -> OdeModel:
    return OdeModel(
        lambda t, s: [s[1], -0.1 * s[1] - s[0] - s[0] ** 3 + 0.3 * np.cos(frequency * t)],
        ("x", "v"),
        period=2 * np.pi / frequency,
        guess=[0.3, 0.0],
    )


def mathieu(q: float, a: float) -> OdeModel:
    return OdeModel(
        lambda t, s: [s[1], -0.1 * s[1] - (a - 2 * q * np.cos(2 * t)) * s[0]],
        ("x", "v"),
        period=np.pi,
        guess=[0.0, 0.0],
        state_scale=[1.0, 1.0],
    )


@functools.cache
def oscillation() -> birdmb.LimitCycle:
    model = OdeModel(
        lambda _, s: [s[1], 0.3 * (1 - s[0] ** 2) * s[1] - s[0]], ("x", "v"), guess=[2.0, 0.0]
    )
    return find_limit_cycle(model, period_guess=6.3)


def _branch() -> Figure:
    return continue_branch(duffing, (0.6, 2.0), parameter_name="frequency").plot("v")


def _boundary() -> Figure:
    return stability_boundary(
        mathieu, (0.0, 1.0), [0.8, 1.0, 1.2], first_name="q", second_name="a",
        steps=Steps(first=0.1, longest=0.2),
    ).plot()  # fmt: skip


def _bird_branch() -> Figure:
    branch = bird_branch(
        coarse("ibis_compliant_shoulder"), f"{FLAP}.stiffness", (6.6, 5.0), max_points=14,
        steps=Steps(longest=0.2),
    )  # fmt: skip
    return figures.plot_bird_branch(branch)


def _response() -> Figure:
    disturbance = mode_disturbance(oscillation(), 1, 0.3)
    return perturbed_response(oscillation(), disturbance, periods=2).plot()


def _gust() -> xr.Dataset:
    return gust_response(cycle(), birdmb.GaussianGust(vertical=1.0, horizontal=0.5), periods=4)


def _kinematics() -> Figure:
    return fit_kinematics(EXAMPLES / "pigeon_points.csv", "pigeon", frame="forward-left-up").plot()


GALLERY: dict[str, Callable[[], Figure]] = {
    "states": lambda: figures.plot_states(cycle()),
    "multipliers": lambda: figures.plot_multipliers(cycle()),
    "loads": lambda: figures.plot_loads_and_power(cycle()),
    "wing": lambda: figures.plot_wing_phases(cycle()),
    "overview": lambda: figures.plot_overview(cycle()),
    "tunnel": lambda: figures.plot_tunnel_and_free_flight(rigid()),
    "validity": lambda: figures.plot_validity(assess_validity(rigid()).data),
    "gust": lambda: figures.plot_gust_response(_gust()),
    "gust_states": lambda: figures.plot_gust_states(_gust()),
    "perturbed": lambda: figures.plot_perturbed_flight(
        perturbed_flight(rigid(), amplitude=0.05, periods=3, samples=40)
    ),
    "performance": lambda: figures.plot_performance(flap_study()),
    "locus": lambda: figures.plot_multiplier_locus(flap_study()),
    "sweep_map": lambda: figures.plot_sweep(grid(), None, {}),
    "sweep_bank": lambda: figures.plot_sweep(grid(), "path_angle", {}),
    "sweep_lines": lambda: figures.plot_sweep(grid(), None, {f"{FLAP}.amplitude_deg": 40.0}),
    "manifold": lambda: figures.plot_manifold(tail(), {}),
    "envelope": lambda: figures.plot_envelope(tail(), limits={}),
    "pareto": lambda: figures.plot_pareto(tail(), {}),
    "openings": lambda: figures.plot_stability_openings(openings(), "ibis_tail"),
    "orbit": lambda: oscillation().plot(),
    "response": _response,
    "branch": _branch,
    "boundary": _boundary,
    "bird_branch": _bird_branch,
    "kinematics": _kinematics,
}
