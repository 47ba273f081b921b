"""Flow Jacobians between the nodes of a collocated orbit, from the derivative along it.

The variational equation dPhi/dt = A(t) Phi is integrated by Radau IIA from node to node, A being
the trigonometric interpolant of its values at the nodes. The method is L-stable: a mode that decays
within a fraction of an interval stays small (Hairer & Wanner, Solving Ordinary Differential
Equations II, section IV.5).
"""

from __future__ import annotations

import functools

import numpy as np
from scipy.special import eval_legendre, roots_jacobi

from birdmb._typing import FloatArray
from birdmb.orbits.trigonometric import between_nodes

_STAGES = 6
# Up to here six stages are exact to a part in 1e12; beyond, an interval is divided.
_LARGEST_STEP = 1.0
_MOST_PARTS = 4
# A mode that decays by more orders in a period leaves a multiplier below round-off of the others.
_MOST_DECAY = -float(np.log(np.finfo(float).eps))
_INSTANTS_SEEN = 8


def flow_jacobians(rate_jacobians: FloatArray) -> FloatArray:
    """Flow Jacobians from node to node, (N, n, n).

    `rate_jacobians` (N, n, n) are those of the rates at the nodes, by phase (times the period).
    What the stages leave of error falls off with the nodes faster than all other errors, so that
    the distance from the same on more nodes covers it.
    """
    nodes, n, _ = rate_jacobians.shape
    parts = _parts(rate_jacobians)
    count = nodes * parts
    abscissae, weights = _radau(_STAGES)
    within = (np.arange(parts)[:, None] + abscissae).ravel() / parts
    along = between_nodes(rate_jacobians, within).reshape(count, _STAGES, n, n) / count
    # Slopes K_i at the stages: K_i = A_i (I + sum_j w_ij K_j).
    size = _STAGES * n
    coupled = np.einsum("kiab,ij->kiajb", along, weights).reshape(count, size, size)
    slopes = np.linalg.solve(np.eye(size) - coupled, along.reshape(count, size, n))
    ends = np.einsum("i,kiab->kab", weights[-1], slopes.reshape(count, _STAGES, n, n))
    factors = (np.eye(n) + ends).reshape(nodes, parts, n, n)
    total = factors[:, 0]
    for part in range(1, parts):
        total = factors[:, part] @ total
    return total


def _parts(rate_jacobians: FloatArray) -> int:
    """Into how many parts an interval is divided, by the modes that live through a period."""
    nodes = len(rate_jacobians)
    seen = rate_jacobians[:: max(1, nodes // _INSTANTS_SEEN)] / nodes
    # No eigenvalue is larger than this.
    if float((seen * seen).sum(axis=(1, 2)).max()) <= _LARGEST_STEP**2:
        return 1
    rates = np.linalg.eigvals(seen)
    steps = np.where(nodes * rates.real > -_MOST_DECAY, np.abs(rates), 0.0)
    return int(np.clip(np.ceil(steps.max() / _LARGEST_STEP), 1, _MOST_PARTS))


@functools.cache
def _radau(stages: int) -> tuple[FloatArray, FloatArray]:
    """Abscissae (s,) in (0, 1] and coefficients (s, s) of Radau IIA; the last row weighs the end.

    The coefficients integrate the polynomials through the stages; in Legendre's basis that is well
    conditioned.
    """
    x = np.append(roots_jacobi(stages - 1, 1.0, 0.0)[0], 1.0)
    degrees = np.arange(stages)
    values = eval_legendre(degrees, x[:, None])
    integrals = np.empty((stages, stages))
    integrals[:, 0] = x + 1.0
    for k in degrees[1:]:
        difference = eval_legendre(k + 1, x) - eval_legendre(k - 1, x)
        integrals[:, k] = difference / (2 * k + 1)
    coefficients = np.linalg.solve(values.T, integrals.T).T / 2.0
    return (x + 1.0) / 2.0, np.asarray(coefficients)
