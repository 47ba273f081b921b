"""Linear collocation equations on many nodes, solved by what is known on fewer.

The lowest harmonics of a solution are those of the equations on fewer nodes, of which there is a
factorisation. In the others differentiation prevails, and the derivative of the rates counts by its
mean. Both together precondition GMRES (two grids: Canuto, Hussaini, Quarteroni & Zang, Spectral
Methods: Fundamentals in Single Domains, 2006, chapter 4).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import LinearOperator, gmres

from birdmb._typing import FloatArray
from birdmb.orbits.newton import Linear
from birdmb.orbits.trigonometric import resampled

# Smaller matrices are factorised in less time.
_FEWEST_UNKNOWNS = 600
_PRODUCTS, _RESTARTS = 20, 2


@dataclass(frozen=True)
class Factorised:
    """The factorised linear equations on some nodes: their number N and their solver.

    Of n states at each node, which come first, and of k more unknowns.
    """

    nodes: int
    solve: Linear

    def solve_on_more(
        self, product: Linear, right: FloatArray, rates: FloatArray, tolerance: float
    ) -> FloatArray | None:
        """The step with product(step) = `right` (M n + k,) on M nodes.

        But for a part `tolerance` of `right`; `None` where it takes too many products, or where a
        factorisation on all nodes is sooner done. `rates` (M, n, n) are the derivatives of the
        rates by phase.
        """
        if len(right) < _FEWEST_UNKNOWNS or self.nodes >= len(rates):
            return None
        shape = len(right), len(right)
        found, failed = gmres(
            LinearOperator(shape, matvec=product, dtype=np.float64),
            right,
            M=LinearOperator(shape, matvec=self._preconditioner(rates), dtype=np.float64),
            rtol=tolerance,
            restart=_PRODUCTS,
            maxiter=_RESTARTS,
        )
        return None if failed or not np.isfinite(found).all() else np.asarray(found)

    def _preconditioner(self, rates: FloatArray) -> Linear:
        fewer, (nodes, n, _) = self.nodes, rates.shape
        split, first = nodes * n, fewer // 2 + 1
        turns = 2j * np.pi * np.arange(first, nodes // 2 + 1)
        high = np.linalg.inv(turns[:, None, None] * np.eye(n) - rates.mean(axis=0))

        def precondition(vector: FloatArray) -> FloatArray:
            # The equations are divided by the root of the number of nodes.
            harmonics = np.fft.rfft(vector[:split].reshape(nodes, n) * np.sqrt(nodes), axis=0)
            kept = np.fft.irfft(harmonics[:first], n=fewer, axis=0) * (fewer / nodes)
            low = self.solve(np.concatenate([kept.ravel() / np.sqrt(fewer), vector[split:]]))
            harmonics[:first] = 0.0
            harmonics[first:] = (high @ harmonics[first:, :, None])[:, :, 0]
            states = np.fft.irfft(harmonics, n=nodes, axis=0)
            states += resampled(low[: fewer * n].reshape(fewer, n), nodes)
            return np.concatenate([states.ravel(), low[fewer * n :]])

        return precondition
