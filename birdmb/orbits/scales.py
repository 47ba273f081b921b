"""Typical sizes of the states and the layout of a guess: what makes states comparable."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError, StateError
from birdmb.orbits.problem import HasStateScale, Model, Scalable
from birdmb.orbits.segments import sample

SAMPLES_PER_SEGMENT = 8
MOST_SEGMENTS = 1000

# A state smaller than this part of the largest may be round-off of the others.
_DOUBTFUL = 1e-8
# Relative displacements of the other states that show what such a state is made of.
_KICKS = (1e-6, 1e-3)
# Round-off answers a kick of 1e-6 by about itself, 1e6 times what a true answer would be.
_LARGEST_ANSWER = 1e3
_PROPORTIONAL = 10.0
_OUTGROWN = 10.0
_AT_REST = 1e-7


def declared_scale(model: Model) -> FloatArray | None:
    """Scale (n,) that the model gives itself; ArgumentError if it is none."""
    if not isinstance(model, HasStateScale) or model.state_scale is None:
        return None
    scale, n = np.asarray(model.state_scale, float), len(model.state_names)
    if scale.shape != (n,) or not (np.isfinite(scale) & (scale > 0)).all():
        raise ArgumentError(f"state_scale must hold {n} positive, finite values.")
    return scale


def sizes_along(model: Model, path: FloatArray, start_time: float, span: float) -> FloatArray:
    """Scale (n,) of the states: the largest values along `path` (k, n).

    `path` begins at `start_time` and takes `span` (s). One that runs away does not set the scale:
    it counts up to a hundred times its beginning. A state that stays at zero, or so near that it
    may be round-off of others, takes the size of its answer to a displacement of those; without an
    answer its scale is 1.
    """
    size, early = np.abs(path).max(axis=0), np.abs(path[:2]).max(axis=0)
    size = np.where(early > 0, np.minimum(size, 100 * early), size)
    doubtful = size <= _DOUBTFUL * size.max()
    if doubtful.any() and not doubtful.all():
        moving = np.where(doubtful, 0.0, size)
        answer = _sizes_by_answer(model, path[0], moving, size, start_time, span)
        size = np.where(doubtful, answer, size)
    return np.where(size > 0, size, 1.0)


def _sizes_by_answer(
    model: Model, x: FloatArray, kick: FloatArray, size: FloatArray, start: float, span: float
) -> FloatArray:
    """Sizes (n,) of states as others shift by `kick` (n,), where `size` (n,) may be round-off."""
    times = start + span * np.arange(1, SAMPLES_PER_SEGMENT + 1) / SAMPLES_PER_SEGMENT
    until = float(times[-1])
    try:
        rest = sample(model, x, start, times, until)
        small, large = (
            np.abs(sample(model, x + part * kick, start, times, until) - rest).max(axis=0) / part
            for part in _KICKS
        )
    except StateError:
        return size
    answers = (small > 0) & (large > small / _PROPORTIONAL) & (large < small * _PROPORTIONAL)
    genuine = (size > 0) & (small <= _LARGEST_ANSWER * size)
    return np.where(genuine, size, np.where(answers, large, 0.0))


def outgrown(scale: FloatArray, path: FloatArray) -> FloatArray | None:
    """Scale (n,) of an orbit, states `path` (k, n), that the one taken from a guess does not fit.

    `None` where all sizes are within a factor of ten of it. A state below what the search with the
    old scale can tell from zero keeps its scale.
    """
    size = np.abs(path).max(axis=0)
    fitting = np.where(size > _AT_REST * scale, size, scale)
    ratio = fitting / scale
    return fitting if ratio.max() > _OUTGROWN or ratio.min() < 1 / _OUTGROWN else None


def lay_out(
    model: Model, guess: npt.ArrayLike, start_time: float, period: float, segments: int
) -> tuple[FloatArray, FloatArray]:
    """Lay a guess out: scale (n,) of the states along it, points (segments, n) to start from.

    The scale is the model's own if it has one.

    Raises:
        ArgumentError: the guess is neither one state (n,) nor one for each segment (segments, n),
            or a number is out of range.
        StateError: the flow fails on the way round.
    """
    start, n = np.array(guess, float), len(model.state_names)
    if not (isinstance(segments, int | np.integer) and 1 <= segments <= MOST_SEGMENTS):
        raise ArgumentError(
            f"segments must be at least 1 and at most {MOST_SEGMENTS}, a whole number, not "
            f"{segments}."
        )
    if not np.isfinite(start_time):
        raise ArgumentError(f"start_time must be finite, not {start_time}.")
    if start.shape not in {(n,), (segments, n)}:
        raise ArgumentError(
            f"the guess has shape {start.shape}; the states {', '.join(model.state_names)} need "
            f"({n},), or ({segments}, {n}) for the starts of {segments} segment(s)."
        )
    if not np.isfinite(start).all():
        raise ArgumentError("the guess holds values that are not finite.")
    declared = declared_scale(model)
    if declared is not None:
        return declared, _path(model, start, start_time, period, segments, 1)[1]
    scaled, scale = model, np.ones(n)
    # Twice where it has an effect: the first path is made without knowing any size.
    for _ in range(2 if isinstance(model, Scalable) else 1):
        path, points = _path(scaled, start, start_time, period, segments, SAMPLES_PER_SEGMENT)
        scale = sizes_along(scaled, path, start_time, period / segments)
        scaled = model.scaled_to(scale) if isinstance(model, Scalable) else model
    return scale, points


def _path(
    model: Model,
    start: FloatArray,
    start_time: float,
    period: float,
    segments: int,
    per_segment: int,
) -> tuple[FloatArray, FloatArray]:
    """States (k, n) along a period, and those (segments, n) at the starts of the segments."""
    if start.ndim == 2:
        return start, start
    if segments == per_segment == 1:
        return start[None, :], start[None, :]
    times = start_time + period * np.arange(segments * per_segment) / (segments * per_segment)
    path = sample(model, start, start_time, times, start_time + period)
    return path, path[::per_segment]
