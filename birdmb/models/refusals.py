"""What a bird must have for the motion that a model is asked for."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError, TopologyError
from birdmb.models.motion import HELD, PLANAR, SPACE_STATES, Motion
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
    if why := impossible_moments(bird.assembled.body.inertia_tensor):
        raise TopologyError(f"{bird.name}: of the body's inertia, {why}.")


def held_state(motion: Motion, body_state: npt.ArrayLike | None) -> FloatArray | None:
    """State in space (8,) in which a body is held; `None` where it moves.

    Raises:
        ArgumentError: a held body has no state, or one that turns; or one that flies was given one.
    """
    if motion is not HELD:
        if body_state is not None:
            raise ArgumentError(
                'body_state is that of a body that is held (motion="held"); a bird that flies has '
                "it among its states."
            )
        return None
    given = np.array([] if body_state is None else body_state, dtype=float)
    if given.shape == (len(PLANAR.states),):
        given = PLANAR.in_space(given[None])[0]
    if given.shape != (len(SPACE_STATES),) or given[3:6].any():
        raise ArgumentError(
            'motion="held" needs body_state: u, w, q and theta of the body, or '
            f"{', '.join(SPACE_STATES)}, with no angular velocity: a held body cannot turn."
        )
    given.flags.writeable = False
    return given
