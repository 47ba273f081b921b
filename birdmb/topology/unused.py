"""Values of a bird that its own other values leave without effect."""

from __future__ import annotations

from collections.abc import Iterator

from birdmb.topology.bird import Bird
from birdmb.topology.parts import Joint

SPRING = ("stiffness", "damping", "cubic_stiffness", "stiffness_below")


def unused_values(bird: Bird) -> dict[str, str]:
    """Return why values are not used, by dotted name, as "shoulder.flap is prescribed"."""
    unused = {"name": "it is a label"}
    for joint in bird.joints:
        unused |= dict(_of_joint(joint))
    if not bird.drag.body:
        off = "the body has no drag (drag.body is false)"
        unused |= {"drag.frontal_area": off, "drag.body_coefficient": off}
    if bird.body.side_area is None:
        unused["body.side_coefficient"] = "the body has no side_area"
    skin_friction = bird.drag.body and bird.drag.body_coefficient is None
    if bird.tail is None and not skin_friction:
        unused["air.kinematic_viscosity"] = "nothing has friction (a tail or drag.body would)"
    return unused


def unused_spring(joint: Joint) -> str:
    """Return why spring and damper of a joint are not used; empty if they are."""
    if joint.mode == "compliant":
        return ""
    more = (
        "" if joint.stiffness is not None else f"; {joint.name}.stiffness would make it compliant"
    )
    return f"{joint.name} is prescribed, it follows its driver whatever its spring{more}"


def _of_joint(joint: Joint) -> Iterator[tuple[str, str]]:
    if reason := unused_spring(joint):
        yield from ((f"{joint.name}.{key}", reason) for key in SPRING)
    if not joint.amplitude:
        reason = f"{joint.name} is not driven, its amplitude is 0"
        yield from ((f"{joint.name}.{key}", reason) for key in ("phase", "phase_deg"))
