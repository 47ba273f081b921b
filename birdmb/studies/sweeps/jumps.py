"""Jumps: neighbours in a study whose flights the step of the parameter between does not explain.

Where several limit cycles exist, a search may end on one at a point and on another at the next one.
Neighbours of one family obey |dz| <= |dp| max |dz/dp|, the maximum being that between them. The
sensitivities at both ends are known; where the flights differ by much more than the larger of them
allows, they lie on different sheets, or the sheet is steeper between them than at either end. The
comparison has no scale of its own, and takes no more than the two points.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from birdmb._typing import FloatArray
from birdmb.studies.sweeps.grid import Grid, Place, is_number

# Sensitivities that grow towards one end explain more than the difference, never less; twice
# allows for their errors, and for a sheet that is steeper in between.
_EXPLAINED = 2.0
# In units of the state scale: what flights that no parameter changes differ by.
_ROUND_OFF = 1e-6

BoolArray = npt.NDArray[np.bool_]


def sheet_jumps(
    grid: Grid, found: Mapping[Place, Mapping[str, Any]], bounds: Mapping[str, Sequence[float]]
) -> xr.DataArray:
    """Jumps of a study by place and by the parameter `along` which they are; see `jumps`.

    Args:
        grid: the points.
        found: results of those that have a flight.
        bounds: (lowest, highest) of the values that flights are trimmed by, by name.
    """
    states = list(dict.fromkeys(name for result in found.values() for name in result["x0"]))
    width = {name: high - low for name, (low, high) in bounds.items()}
    components = [*states, *width]
    flights = np.full((*grid.shape, len(components)), np.nan)
    strengths = np.full((*grid.shape, len(grid.parameters)), np.nan)
    turns = np.full(len(components), np.inf)
    for place, result in found.items():
        sizes = dict(zip(result["x0"], result["state_scale"], strict=True)) | width
        values = result["x0"] | result["trimmed"]
        own = [components.index(name) for name in sizes]
        flights[place][own] = [values[name] / size for name, size in sizes.items()]
        for i, name in enumerate(grid.parameters):
            if name in result["sensitivity"]:
                strengths[(*place, i)] = np.abs(result["sensitivity"][name]).max()
        turns[components.index("theta")] = 2.0 * np.pi / sizes["theta"]
    marked = np.zeros(strengths.shape, dtype=bool)
    for axis, (_, values) in enumerate(grid.parameters.items()):
        numbers = [value for value in values if is_number(value)]
        if len(numbers) == len(values):
            marked[..., axis] = jumps(flights, strengths[..., axis], numbers, axis, turns)
    about = "whether this flight and that at the next larger value lie on different sheets"
    return xr.DataArray(marked, dims=[*grid.parameters, "along"], attrs={"long_name": about})


def neighbours_apart(study: xr.Dataset) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Values of the pairs of neighbours whose flights lie on different sheets, in a dataset."""
    pairs = []
    marked = study["sheet_jump"]
    for *place, axis in np.argwhere(marked.values):
        name = str(study["along"].values[axis])
        here = {str(d): study[d].values[i].item() for d, i in zip(marked.dims, place, strict=False)}
        larger = study[name].values[study[name].values > here[name]].min().item()
        pairs.append((here, here | {name: larger}))
    return pairs


def jumps(
    flights: FloatArray,
    strengths: FloatArray,
    values: Sequence[float],
    axis: int,
    turns: FloatArray,
) -> BoolArray:
    """Whether the flight at a point and that at the next larger value lie on different sheets.

    Args:
        flights: (..., m) over the grid, in units that make them comparable; NaN where a point has
            none, or a component is not among its own.
        strengths: largest component of |dz/dp| (...) by the parameter, NaN where it is not known.
        values: of the parameter, in the order of the grid.
        axis: of the grid, along which it varies.
        turns: (m,), what a whole turn adds to a component, which leaves the flight what it is;
            infinite where there is none.

    Returns:
        (...), at the smaller of the two values; false where either has no flight, or the
        sensitivity of neither is known.
    """
    order = np.argsort(values, kind="stable")
    z, s = (np.moveaxis(a, axis, 0)[order] for a in (flights, strengths))
    marked = np.zeros(s.shape, dtype=bool)
    step = np.diff(np.asarray(values, dtype=float)[order])
    apart = np.diff(z, axis=0)
    turning = np.isfinite(turns)
    apart[..., turning] -= turns[turning] * np.round(apart[..., turning] / turns[turning])
    # Components that only one of the two has make flights of different kinds, not of sheets.
    difference = np.where(np.isnan(apart), -1.0, np.abs(apart)).max(axis=-1, initial=-1.0)
    allowed = _EXPLAINED * np.fmax(s[1:], s[:-1]) * step.reshape(-1, *[1] * (s.ndim - 1))
    with np.errstate(invalid="ignore"):
        marked[:-1] = (difference > _ROUND_OFF) & (difference > allowed)
    back = np.empty_like(order)
    back[order] = np.arange(order.size)
    return np.asarray(np.moveaxis(marked[back], 0, axis))


def unexplained(
    here: Mapping[str, Any],
    there: Mapping[str, Any],
    steps: Mapping[str, float],
    bounds: Mapping[str, Sequence[float]],
) -> bool:
    """Whether steps of some parameters do not explain how the flights at both ends differ.

    As `jumps` marks them, along several parameters at once.

    Args:
        here, there: results of the two points.
        steps: from the one to the other, by the parameters' names.
        bounds: (lowest, highest) of the values that flights are trimmed by, by name.
    """
    if here["x0"].keys() != there["x0"].keys():
        return False
    allowed = 0.0
    for name, step in steps.items():
        known = [end["sensitivity"][name] for end in (here, there) if name in end["sensitivity"]]
        if not known:
            return False
        allowed += _EXPLAINED * abs(step) * max(float(np.abs(each).max()) for each in known)
    sizes = dict(zip(here["x0"], here["state_scale"], strict=True))
    sizes |= {name: high - low for name, (low, high) in bounds.items()}
    ends = [end["x0"] | end["trimmed"] for end in (here, there)]
    apart = {name: ends[1][name] - ends[0][name] for name in sizes}
    turn = 2.0 * np.pi
    apart["theta"] -= turn * round(apart["theta"] / turn)
    difference = max(abs(apart[name]) / size for name, size in sizes.items())
    return difference > max(allowed, _ROUND_OFF)
