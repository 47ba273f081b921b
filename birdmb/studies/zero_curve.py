"""A curve in the plane on which a function vanishes, followed by pseudo-arclength continuation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import root_scalar

from birdmb._typing import FloatArray
from birdmb.errors import BirdmbError
from birdmb.summary import Summarised

# What a function may raise where it has no value.
_Undefined = (BirdmbError, ValueError)


@dataclass(frozen=True, repr=False)
class ZeroCurve(Summarised):
    """Points on a curve, in order.

    Attributes:
        points: (K, 2).
        ends: why it ends, at the first and at the last point.
    """

    points: FloatArray
    ends: tuple[str, str]


def trace_zero(
    function: Callable[[float, float], float],
    start: tuple[float, float],
    bounds: tuple[tuple[float, float], tuple[float, float]],
    *,
    step: float = 0.03,
    tolerance: float = 1e-9,
    max_points: int = 500,
) -> ZeroCurve:
    """Follow function(x, y) = 0 from a point on it in both directions.

    Each point lies on the line across the curve's last chord at a step ahead of it, where the
    secant method finds the zero; turns are followed. The step is halved where this fails.

    Args:
        function: of the two coordinates.
        start: a point on the curve, to within the step.
        bounds: lowest and highest of each coordinate; they are its unit.
        step: length of a step in these units.
        tolerance: error of a point across the curve, in these units.
        max_points: in each direction.

    Raises:
        BirdmbError: the function is not defined at the start.
        ValueError: there is no zero within a step of the start.
    """
    low, high = np.array(bounds, dtype=float).T
    width = high - low

    def value(s: FloatArray) -> float:
        x, y = (low + s * width).tolist()
        return function(x, y)

    origin = (np.array(start, dtype=float) - low) / width
    h = 0.1 * step
    gradient = np.array([value(origin + h * e) - value(origin - h * e) for e in np.eye(2)])
    gradient /= np.linalg.norm(gradient)
    origin = _on_line(value, origin, gradient, step, tolerance)
    along = np.array([-gradient[1], gradient[0]])
    halves = [
        _followed(value, origin, sign * along, step, tolerance, max_points) for sign in (-1, 1)
    ]
    (before, first), (after, last) = halves
    points = np.array([*before[::-1], origin, *after])
    return ZeroCurve(low + points * width, (first, last))


def _followed(
    value: Callable[[FloatArray], float],
    origin: FloatArray,
    direction: FloatArray,
    longest: float,
    tolerance: float,
    max_points: int,
) -> tuple[list[FloatArray], str]:
    """Points after the origin, and why there are no more."""
    points, last, step = list[FloatArray](), origin, longest
    while len(points) < max_points:
        ahead = last + step * direction
        if (ahead < 0.0).any() or (ahead > 1.0).any():
            if step > longest / 64:
                step /= 2
                continue
            return points, "a bound"
        across = np.array([-direction[1], direction[0]])
        try:
            new = _on_line(value, ahead, across, step, tolerance)
        except _Undefined as error:
            if step > longest / 16:
                step /= 2
                continue
            return points, str(error)
        chord = new - last
        direction = chord / np.linalg.norm(chord)
        points.append(new)
        last, step = new, min(2.0 * step, longest)
    return points, "the number of points allowed"


def _on_line(
    value: Callable[[FloatArray], float],
    point: FloatArray,
    across: FloatArray,
    reach: float,
    tolerance: float,
) -> FloatArray:
    """The zero on the line through `point` along `across`, no further than `reach` away."""

    def at(distance: float) -> float:
        if abs(distance) > reach:
            raise ValueError("the curve turns or ends")
        return value(point + distance * across)

    try:
        x1 = 0.02 * reach
        found = root_scalar(at, x0=0.0, x1=x1, method="secant", xtol=tolerance, maxiter=20)
    except ValueError:
        # Where it is steep the secant overshoots; between two signs it cannot.
        here = at(0.0)
        beyond = [end for end in (-reach, reach) if at(end) * here < 0]
        if not beyond:
            raise
        found = root_scalar(at, bracket=(0.0, beyond[0]), method="brentq", xtol=tolerance)
    if not found.converged:
        raise ValueError("the curve was lost")
    return np.asarray(point + found.root * across)
