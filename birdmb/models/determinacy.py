"""Whether the accelerations of the free coordinates are determined: their mass matrix regular."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import TopologyError
from birdmb.topology import Bird

# Of what is typical of the bird: far below any wing's, and above round-off.
_NO_INERTIA = 1e-14
_TAKES_PART = 0.1


def refuse_undetermined(
    bird: Bird, mass: FloatArray, typical: FloatArray, names: Sequence[str]
) -> None:
    """Raise `TopologyError` that names the joints whose motion moves no mass.

    Args:
        bird: the bird.
        mass: mass matrix (n, n) of the free coordinates.
        typical: mass or moment of inertia (n,) typical of each of them.
        names: their names.
    """
    scale = np.sqrt(typical)
    values, vectors = np.linalg.eigh(mass / np.outer(scale, scale))
    still = np.abs(vectors[:, values <= _NO_INERTIA]).max(axis=1, initial=0.0)
    if not still.any():
        return
    guilty = dict.fromkeys(np.array(names)[still > _TAKES_PART * still.max()].tolist())
    raise TopologyError(
        f"{bird.name}: {' and '.join(guilty)} can turn freely without moving any mass: the "
        f"acceleration is not determined. Give the segments carried a mass or an inertia about the "
        f"axis, or prescribe one joint (mode = prescribed)."
    )
