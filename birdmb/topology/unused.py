"""Values of a bird that its own other values leave without effect."""

from __future__ import annotations

from collections.abc import Iterator

from birdmb.topology.bird import Bird
from birdmb.topology.joints import SIDES, Joint

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
        yield from ((f"{name}.{key}", reason) for name in own_names(joint) for key in SPRING)
    still = {side: not joint.on(side).amplitude for side in SIDES}
    places = [f"{joint.name}.{side}" for side in SIDES if still[side]]
    if all(still.values()):
        places.append(joint.name)
    for name in places:
        reason = f"{name} is not driven, its amplitude is 0"
        yield from ((f"{name}.{key}", reason) for key in ("phase", "phase_deg"))
    if joint.right and joint.left:
        for key in joint.right.own.keys() & joint.left.own.keys():
            reason = f"both sides of {joint.name} have {key} of their own"
            yield f"{joint.name}.{key}", reason
            if key in joint.angles:
                yield f"{joint.name}.{key}_deg", reason


def own_names(joint: Joint) -> tuple[str, ...]:
    """Return the dotted names of a joint and of its sides, before the names of their values."""
    return joint.name, *(f"{joint.name}.{side}" for side in SIDES)
