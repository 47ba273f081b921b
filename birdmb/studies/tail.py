"""What stability costs: level flights over the opening of the tail and the gait."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from os import PathLike

import numpy as np
import xarray as xr

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError, TopologyError
from birdmb.models import RigidModel
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.sweeps import Finished, Study, Trimming, sweep
from birdmb.studies.trim_defaults import default_parameters
from birdmb.studies.validity import LARGEST_TAIL_ANGLE
from birdmb.topology import Bird
from birdmb.topology.roles import flap_joint, sweep_joint

OPENING = "tail.opening_deg"
VALID = {"largest_tail_angle": LARGEST_TAIL_ANGLE}
"""Limits, as of `within_limits`, of the tail's slender-wing lift."""

# Of the states, in units of their scale: the multipliers are then known to some 1e-7.
ACCURACY = 3e-5
# Of orbit and climb rate (m/s): no closer than the nodes leave them.
_CLOSURE, _LEVEL = 1e-6, 1e-5
_OPENINGS = np.arange(0.0, 45.1, 3.0)  # degrees
_AMPLITUDES = np.linspace(1.1, 0.7, 9)  # of the bird's own
_SWEEPS = np.arange(-3.0, 3.1, 1.0)  # degrees, to the bird's own


def tail_ranges(bird: Bird) -> dict[str, list[float]]:
    """Values by dotted name over which `tail_study` levels the flight of a bird by default.

    The tail's opening from 0 to 45 degrees; the amplitude of the joint that flaps the wing, 1.1 to
    0.7 times the bird's own, where it has one; the offset of the joint that sweeps it, up to 3
    degrees to either side, where there is one. The latter two come first.

    Raises:
        TopologyError: the bird has no tail.
    """
    if bird.tail is None:
        raise TopologyError(f"{bird.name} has no tail to open; give it a table [tail].")
    flapping, sweeping = flap_joint(bird), sweep_joint(bird)
    ranges = {}
    if sweeping is not None:
        name = f"{sweeping.name}.offset_deg"
        ranges[name] = (float(bird.value(name)) + _SWEEPS).tolist()
    if flapping is not None and not flapping.driver.is_still:
        one_sine = flapping.driver.is_one_sine and flapping.amplitude
        name = f"{flapping.name}.{'amplitude_deg' if one_sine else 'gain'}"
        ranges[name] = (float(bird.value(name)) * _AMPLITUDES).tolist()
    return ranges | {OPENING: _OPENINGS.tolist()}


@checked
def tail_study(
    bird: Bird,
    store: str | PathLike[str],
    vary: Mapping[str, Sequence[float]] | None = None,
    *,
    trim: Mapping[str, tuple[float, float]] | None = None,
    every: int = 1,
    workers: int | None = None,
    executor: Executor | None = None,
    model: ModelFactory = RigidModel,
    on_point: Callable[[Finished], None] | None = None,
) -> Study:
    """Level the flight of a bird with a tail for openings of it and gaits.

    A store that was begun is filled up.

    Args:
        bird: a bird with a tail.
        store: file that keeps the study.
        vary: values by dotted name: of "tail.opening_deg" and of one or two others; by default
            `tail_ranges`. Neighbours start from one another, the last one named varying fastest.
        trim: bounds (lowest, highest) by dotted name of the one value that levels the flight; by
            default the offset of the joint that turns the chords.
        every: take only one of so many values.
        workers, executor, on_point: as for `sweep`.
        model: makes the model of a bird.

    Raises:
        TopologyError: the bird has no tail, or no value of a name.
        SweepError: as for `sweep`.
        ArgumentError: `every` is not positive, the opening is not varied, or not beside one or two
            others.
    """
    if every < 1:
        raise ArgumentError(f"every must be 1 or more, not {every}.")
    ranges = tail_ranges(bird) if vary is None else vary
    if OPENING not in ranges or len(ranges) not in {2, 3}:
        raise ArgumentError(
            f"the study varies {OPENING} and one or two other values, not {', '.join(ranges)}."
        )
    return sweep(
        bird,
        {name: list(values[::every]) for name, values in ranges.items()},
        store=store,
        workers=workers,
        executor=executor,
        model=model,
        trim=Trimming(trim or default_parameters(bird, 1), tolerance=_LEVEL),
        tolerance=_CLOSURE,
        accuracy=ACCURACY,
        on_point=on_point,
    )


def gait_parameters(data: xr.Dataset) -> list[str]:
    """Names of what a study's dataset varies besides the opening of the tail."""
    return [str(name) for name in data["along"].values if name != OPENING]


def within_limits(data: xr.Dataset, limits: Mapping[str, float]) -> xr.DataArray:
    """Which flights of a study exceed none of some limits.

    Args:
        data: dataset of a study.
        limits: largest modulus of variables of the dataset, by name and in their units, for
            instance of "mean_pitch" (rad). What is NaN, as the angle of a furled tail, is within.

    Raises:
        ArgumentError: the dataset has no variable of a name.
    """
    unknown = [name for name in limits if name not in data]
    if unknown:
        raise ArgumentError(f"flights are not described by {', '.join(unknown)}.")
    allowed = data["status"] == "found"
    for name, largest in limits.items():
        allowed &= ~(abs(data[name]) > largest)
    return allowed


def pareto_front(cost: FloatArray, modulus: FloatArray) -> FloatArray:
    """Positions of the flights that none beats in both cost and |Lambda|max, by rising cost.

    Both (K,); flights with NaN are none.
    """
    known = np.flatnonzero(np.isfinite(cost) & np.isfinite(modulus))
    order = known[np.lexsort((modulus[known], cost[known]))]
    best = np.minimum.accumulate(modulus[order])
    before = np.concatenate([[np.inf], best[:-1]])[: order.size]
    return np.asarray(order[modulus[order] < before])
