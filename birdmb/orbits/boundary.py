"""The boundary of stability in the plane of two parameters."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from birdmb.arguments import checked
from birdmb.errors import ArgumentError, BirdmbError
from birdmb.orbits.branch import Branch
from birdmb.orbits.branch_points import Bifurcation
from birdmb.orbits.continuation import continue_branch
from birdmb.orbits.errors import BIFURCATIONS_FOUND
from birdmb.orbits.extended import Family
from birdmb.orbits.problem import Model
from birdmb.summary import Summarised

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class BoundaryPoint(Summarised):
    """Where the first change of stability lies for one value of the second parameter.

    Attributes:
        second: value of the second parameter.
        bifurcation: located on the branch in the first parameter; `None` if none was found.
        reason: why there is none, else empty.
    """

    second: float
    bifurcation: Bifurcation | None
    reason: str


@dataclass(frozen=True, repr=False)
class StabilityBoundary(Summarised):
    """Stability boundary, one point for each value of the second parameter."""

    first_name: str
    second_name: str
    points: tuple[BoundaryPoint, ...]

    def to_xarray(self) -> xr.Dataset:
        """Return the boundary over the second parameter; NaN where none was found."""
        found = [point.bifurcation for point in self.points]
        first = [np.nan if b is None else b.parameter for b in found]
        error = [np.nan if b is None else b.parameter_error for b in found]
        kind = np.array(["" if b is None else b.kind for b in found], dtype="U16")
        reason = np.array([point.reason for point in self.points], dtype=str)
        dim = "second_parameter"
        return xr.Dataset(
            {
                "first_parameter": (dim, first),
                "first_parameter_error": (dim, error),
                "kind": (dim, kind),
                "reason": (dim, reason),
            },
            coords={dim: [point.second for point in self.points]},
            attrs={"first_name": self.first_name, "second_name": self.second_name},
        )

    def plot(self) -> Figure:
        """Draw the boundary in the plane of the two parameters, by kind of bifurcation."""
        from birdmb.figures import plot_stability_boundary  # noqa: PLC0415 - it draws

        return plot_stability_boundary(self)


@checked
def stability_boundary(
    family: Callable[[float, float], Model],
    first_range: tuple[float, float],
    second_values: Iterable[float],
    guess: npt.ArrayLike | None = None,
    *,
    first_name: str = "first parameter",
    second_name: str = "second parameter",
    period_guess: float | None = None,
    **options: Any,
) -> StabilityBoundary:
    """Locate the first change of stability along one parameter for each value of another.

    That is the first bifurcation with orbits that are unstable on one of its two sides alone; those
    that make unstable orbits more or less unstable are passed. Each value costs a continuation up
    to there; each starts from the orbit at which the one before it started, so order the values.

    Args:
        family: function of the two parameters that returns the model.
        first_range: range of the first parameter, from the side where the orbits are known.
        second_values: values of the second parameter.
        guess: orbit at the start of the range for the first of the values.
        first_name: label.
        second_name: label.
        period_guess: as for `find_limit_cycle`.
        options: what else `continue_branch` takes.

    Returns:
        The boundary. A value at which no orbit or no change of stability was found keeps the
        reason; the others are not lost for it.
    """
    points = []
    for second in second_values:
        try:
            branch = _up_to_change(
                functools.partial(_swapped, family, second),
                first_range,
                guess,
                period_guess=period_guess,
                parameter_name=first_name,
                **options,
            )
        except ArgumentError:
            raise
        except BirdmbError as error:
            points.append(BoundaryPoint(second, None, str(error)))
            continue
        start = branch.points[0]
        guess = start.points
        period_guess = None if period_guess is None else start.period
        change = _change(branch)
        if change is None:
            reason = branch.stopped or "no change of stability in the range"
            points.append(BoundaryPoint(second, None, str(reason)))
        else:
            points.append(BoundaryPoint(second, change, ""))
    return StabilityBoundary(first_name, second_name, tuple(points))


def _up_to_change(
    family: Family,
    parameter_range: tuple[float, float],
    guess: npt.ArrayLike | None,
    **options: Any,
) -> Branch:
    """The branch up to its first change of stability, or as far as it goes."""
    branch = continue_branch(family, parameter_range, guess, max_bifurcations=1, **options)
    while _change(branch) is None and _may_go_on(branch):
        branch = continue_branch(
            family, parameter_range, resume=branch, max_bifurcations=1, **options
        )
    return branch


def _change(branch: Branch) -> Bifurcation | None:
    return next((found for found in branch.bifurcations if found.changes_stability), None)


def _may_go_on(branch: Branch) -> bool:
    stopped = branch.stopped
    return stopped is not None and stopped.reason == BIFURCATIONS_FOUND


def _swapped(family: Callable[[float, float], Model], second: float, first: float) -> Model:
    return family(first, second)
