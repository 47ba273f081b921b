"""What a bird must have for the motion that a model is asked for."""

from __future__ import annotations

from birdmb.errors import TopologyError
from birdmb.models.motion import PLANAR, Motion
from birdmb.topology import Bird
from birdmb.topology.inertia import impossible_moments


def refuse_asymmetric(bird: Bird, motion: Motion) -> None:
    """Raise `TopologyError` if left and right differ in a motion that is symmetric."""
    if motion is PLANAR and not bird.is_symmetric:
        raise TopologyError(
            f"{bird.name}: the joints of the left and the right wing differ, so that it does not "
            'fly in its plane of symmetry; let it move in space (motion="free", --motion free), or '
            "give both sides the same values."
        )


def require_inertia(bird: Bird) -> None:
    """Raise `TopologyError` if a bird lacks moments of inertia in space, or has impossible ones."""
    if missing := bird.body.missing_moments:
        raise TopologyError(
            f"{bird.name}: motion in space needs {' and '.join(f'body.{m}' for m in missing)}, the "
            "moments of inertia about the body's other axes (kg m2); give them in the topology "
            "file or with --set."
        )
    if why := impossible_moments(bird.body.inertia_tensor):
        raise TopologyError(f"{bird.name}: of the body's inertia, {why}.")
