"""Whether the accelerations of the free coordinates are determined: their mass matrix regular."""

from __future__ import annotations

import numpy as np

from birdmb._typing import BoolArray, FloatArray
from birdmb.errors import TopologyError
from birdmb.models.exudyn_tree import TreeInertia, typical_inertias
from birdmb.models.failures import overflow_told
from birdmb.models.tree_coordinates import COORDINATES
from birdmb.topology import Bird

# Of what is typical of the bird: far below any wing's, and above round-off.
_NO_INERTIA = 1e-14
_TAKES_PART = 0.1


def refuse_undetermined(
    bird: Bird, inertia: TreeInertia, angles: FloatArray, free: BoolArray
) -> None:
    """Raise `TopologyError` that names the joints whose motion moves no mass.

    Args:
        bird: the bird.
        inertia: of its tree.
        angles: of joints and hinges (2 A,) rad, those of the right wing first.
        free: which coordinates (c,) of the tree do not follow a given motion.
    """
    body = inertia.body_coordinates
    q = np.concatenate([np.zeros(body.size), angles])[None, :]
    with overflow_told(bird, "the mass matrix"):
        (mass,), _ = inertia.at(q, np.zeros_like(q))
        scale = np.sqrt(typical_inertias(bird, body, free.size)[free])
        values, vectors = np.linalg.eigh(mass[np.ix_(free, free)] / np.outer(scale, scale))
    names = np.array([*(COORDINATES[b] for b in body), *bird.angle_names, *bird.angle_names])[free]
    still = np.abs(vectors[:, values <= _NO_INERTIA]).max(axis=1, initial=0.0)
    if not still.any():
        return
    guilty = dict.fromkeys(names[still > _TAKES_PART * still.max()].tolist())
    raise TopologyError(
        f"{bird.name}: {' and '.join(guilty)} can turn freely without moving any mass: the "
        f"acceleration is not determined. Give the segments carried a mass or an inertia about the "
        f"axis, or prescribe one joint (mode = prescribed)."
    )
