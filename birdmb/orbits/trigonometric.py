"""Trigonometric interpolation of periodic functions through an odd number of equidistant nodes.

Phases are parts of the period, the nodes k/N for k = 0 to N - 1. Sources: Trefethen, Spectral
Methods in MATLAB (2000), chapter 3; Boyd, Chebyshev and Fourier Spectral Methods (2001).
"""

from __future__ import annotations

import functools

import numpy as np
from scipy.interpolate import CubicSpline

from birdmb._typing import FloatArray


@functools.lru_cache(maxsize=16)
def differentiation_matrix(nodes: int) -> FloatArray:
    """Matrix (N, N) from values at N nodes to the interpolant's derivatives by phase there."""
    apart = np.subtract.outer(np.arange(nodes), np.arange(nodes))
    with np.errstate(divide="ignore"):
        matrix = np.pi * (-1.0) ** apart / np.sin(np.pi * apart / nodes)
    np.fill_diagonal(matrix, 0.0)
    matrix.flags.writeable = False
    return np.asarray(matrix)


def interpolation_matrix(nodes: int, phases: FloatArray) -> FloatArray:
    """Matrix (K, N) from values at N nodes to the interpolant's values at `phases` (K,)."""
    apart = np.subtract.outer(phases, np.arange(nodes) / nodes)
    apart -= np.round(apart)
    # Dirichlet's kernel as a ratio of two sinc functions, which has no 0/0 at a node.
    return np.asarray(np.sinc(nodes * apart) / np.sinc(apart))


def interpolated(values: FloatArray, phases: FloatArray) -> FloatArray:
    """Values (K, ...) at `phases` (K,) of the interpolant through `values` (N, ...)."""
    nodes = len(values)
    flat = interpolation_matrix(nodes, phases) @ values.reshape(nodes, -1)
    return np.asarray(flat.reshape(len(phases), *values.shape[1:]))


def resampled(values: FloatArray, nodes: int) -> FloatArray:
    """Values (nodes, ...) at other nodes of the interpolant through `values` (N, ...)."""
    if nodes == len(values):
        return values
    return interpolated(values, np.arange(nodes) / nodes)


def along_path(values: FloatArray, phases: FloatArray) -> FloatArray:
    """Values (P, ...) at `phases` (P,) of a closed path through `values` (K, ...) at even instants.

    Through an even number, which has no interpolant of its own, by periodic cubic splines.
    """
    if len(values) % 2:
        return interpolated(values, phases)
    grid = np.arange(len(values) + 1) / len(values)
    closed = np.concatenate([values, values[:1]])
    return np.asarray(CubicSpline(grid, closed, bc_type="periodic")(np.mod(phases, 1.0)))


def between_nodes(values: FloatArray, parts: FloatArray) -> FloatArray:
    """Values (N, K, ...) of the interpolant, `parts` (K,) of an interval after each of N nodes."""
    nodes, count = len(values), len(parts)
    harmonics = np.fft.rfft(values.reshape(nodes, -1), axis=0)
    turns = np.exp(2j * np.pi / nodes * np.multiply.outer(np.arange(len(harmonics)), parts))
    turned = harmonics[:, None, :] * turns[:, :, None]
    shifted = np.fft.irfft(turned, n=nodes, axis=0)
    return np.asarray(shifted.reshape(nodes, count, *values.shape[1:]))


def without_drift(path: FloatArray) -> FloatArray:
    """Values (K, n) along a period as nodes of a closed path, from `path` (K + 1, n) that is open.

    What its end is off its beginning is spread evenly along it.
    """
    count = len(path) - 1
    return np.asarray(path[:-1] - np.outer(np.arange(count) / count, path[-1] - path[0]))
