"""Joint angles at single phases: where the search for the whole beat starts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from birdmb._typing import FloatArray, IntArray
from birdmb.kinematics.beats import most_harmonics
from birdmb.kinematics.observations import Observations, without
from birdmb.topology.samples import series_basis

PHASES = 24
_HARMONICS = 4
_PULL = 0.02  # towards the topology's mean pose, wing lengths per rad
_ITERATIONS = 40
_MOST_DAMPING = 1e8


@dataclass(frozen=True)
class MeanBeat:
    """The columns over a mean beat at even phases.

    Attributes:
        values: (PHASES, R), NaN where the samples do not tell.
        noise: rms distance (R,) of the samples from it.
        counts: how many samples (PHASES, R) each phase stands for.
    """

    values: FloatArray
    noise: FloatArray
    counts: IntArray


def mean_beat(seen: Observations, values: FloatArray, phases: FloatArray) -> MeanBeat:
    """A Fourier series through all samples (N, R) at `phases` (N,), in beats."""
    even = np.arange(PHASES) / PHASES
    mean = np.full((PHASES, values.shape[1]), np.nan)
    noise = np.zeros(values.shape[1])
    counts = np.zeros((PHASES, values.shape[1]), dtype=np.int64)
    bins = np.mod(np.round(phases * PHASES), PHASES).astype(np.int64)
    for column, samples in enumerate(values.T):
        there = np.isfinite(samples)
        np.add.at(counts[:, column], bins[there], 1)
        harmonics = min(_HARMONICS, most_harmonics(phases[there]))
        if harmonics == 0:
            continue
        basis = series_basis(phases[there], harmonics)
        solved = np.linalg.lstsq(basis, samples[there], rcond=None)[0]
        left = samples[there] - basis @ solved
        spare = max(1, left.size - basis.shape[1])
        noise[column] = np.sqrt(np.sum(left**2) / spare)
        mean[:, column] = series_basis(even, harmonics) @ solved
    return MeanBeat(mean, np.maximum(noise, 1e-5 * seen.typical), counts)


def solve_poses(seen: Observations, wanted: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Joint angles (P, A) at which columns are closest to those `wanted` (P, R).

    Levenberg-Marquardt on all poses at once, pulled weakly towards the topology's mean pose, which
    keeps joints there that the columns do not tell.

    Returns:
        The angles, and the rms distances (P,) of the columns, in typical sizes.
    """
    there = np.isfinite(wanted)
    weights = there / seen.typical
    wanted = np.where(there, wanted, 0.0)
    rest = np.tile(seen.wing.offset, (len(wanted), 1))
    joints = seen.wing.segment.size
    angles, damping = rest.copy(), np.full(len(wanted), 1e-2)
    left = _weighted(seen, weights, wanted, angles)
    cost = _cost(left, angles, rest)
    for _ in range(_ITERATIONS):
        slopes = seen.derivatives(angles) * weights[:, :, None]
        slopes = without(_bodily(seen, weights), slopes)
        normal = slopes.transpose(0, 2, 1) @ slopes
        pull = slopes.transpose(0, 2, 1) @ left[:, :, None]
        pull[:, :, 0] -= _PULL**2 * (angles - rest)[:, :joints]
        eye = np.eye(joints)
        step = np.linalg.solve(normal + (_PULL**2 + damping)[:, None, None] * eye, pull)[:, :, 0]
        tried = angles.copy()
        tried[:, :joints] += np.clip(step, -0.5, 0.5)
        left_there = _weighted(seen, weights, wanted, tried)
        cost_there = _cost(left_there, tried, rest)
        better = cost_there < cost
        angles[better], left[better] = tried[better], left_there[better]
        settled = cost - cost_there <= 1e-9 * cost
        cost = np.where(better, cost_there, cost)
        damping = np.clip(np.where(better, 0.2 * damping, 5.0 * damping), 1e-9, _MOST_DAMPING)
        if settled.all():
            break
    count = np.maximum(there.sum(axis=1), 1)
    return angles, np.sqrt(np.sum(left**2, axis=1) / count)


def _bodily(seen: Observations, weights: FloatArray) -> FloatArray:
    """Translations of the body only: rotations are small, by a fit to the body."""
    basis = seen.body_motion_basis(weights, np.zeros_like(weights))
    return basis[:, :, : min(3, seen.body_motions)]


def _weighted(
    seen: Observations, weights: FloatArray, wanted: FloatArray, angles: FloatArray
) -> FloatArray:
    return without(_bodily(seen, weights), (wanted - seen.predicted(angles)) * weights)


def _cost(left: FloatArray, angles: FloatArray, rest: FloatArray) -> FloatArray:
    return np.asarray(np.sum(left**2, axis=1) + _PULL**2 * np.sum((angles - rest) ** 2, axis=1))
