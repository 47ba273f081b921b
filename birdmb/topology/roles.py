"""What the joints of a wing are for, told by their axes: names are the user's."""

from __future__ import annotations

import math

from birdmb.topology.bird import Bird
from birdmb.topology.joints import Joint

_MOSTLY = math.cos(math.radians(45.0))


def flap_joint(bird: Bird) -> Joint | None:
    """The joint at the shoulder that raises and lowers the wing; `None` if there is none.

    The one whose axis is closest to the body's x axis, and less than 45 degrees from it.
    """
    return _about(bird, 0)


def sweep_joint(bird: Bird) -> Joint | None:
    """The joint at the shoulder that moves the wing fore and aft; `None` if there is none.

    The one whose axis is closest to the body's z axis, and less than 45 degrees from it.
    """
    return _about(bird, 2)


def incidence_joint(bird: Bird) -> Joint | None:
    """The joint that turns chords about the span; `None` if none does, or it is not clear which.

    The one joint that twists a segment, or else the one at the shoulder whose axis is closest to
    the body's y axis, and less than 45 degrees from it.
    """
    twisting = [joint for joint in bird.joints if joint.twist]
    if len(twisting) > 1:
        return None
    return twisting[0] if twisting else _about(bird, 1)


def _about(bird: Bird, component: int) -> Joint | None:
    """The joint at the shoulder whose axis is closest to one of the body's."""
    first = bird.segments.names[0]
    at_shoulder = [joint for joint in bird.joints if joint.segment == first]
    found = max(at_shoulder, key=lambda joint: abs(joint.axis[component]), default=None)
    return found if found is not None and abs(found.axis[component]) > _MOSTLY else None
