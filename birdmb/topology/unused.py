"""Values of a bird that its own other values leave without effect."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from birdmb.topology.bird import Bird
from birdmb.topology.joints import SIDES, Joint
from birdmb.topology.wings import Profile

SPRING = ("stiffness", "damping", "cubic_stiffness", "stiffness_below")
_PHASE = ("phase", "phase_deg")
_SHAPE = ("amplitude", "amplitude_deg", *_PHASE, "harmonics", "downstroke_fraction")


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
    if bird.sections:
        spanned = "sections span the wing, not feathers"
        unused |= {"wing.half_thickness": spanned, "wing.propatagium": spanned}
    if bird.sections and all(section.profile for section in bird.sections):
        own = "every section has a profile of its own"
        unused |= {f"wing.profile.{key}": own for key in Profile.model_fields}
        unused["wing.profile.zero_lift_angle_deg"] = own
    if bird.air.wake == "quasi-steady":
        unused["air.wake_points"] = "the air has no memory (air.wake is quasi-steady)"
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
    for name in _places_where(joint, lambda own: not own.amplitude):
        reason = f"{name} has no sine that it would shape, its amplitude is 0"
        yield from ((f"{name}.{key}", reason) for key in (*_PHASE, "downstroke_fraction"))
    for name in _places_where(joint, lambda own: not own.gain):
        yield from ((f"{name}.{key}", f"the gain of {name} is 0") for key in _SHAPE)
    for name in _places_where(joint, lambda own: bool(own.gain) and own.driver.is_still):
        yield f"{name}.gain", f"{name} is not driven"
    if joint.right and joint.left:
        for key in joint.right.own.keys() & joint.left.own.keys():
            reason = f"both sides of {joint.name} have {key} of their own"
            yield f"{joint.name}.{key}", reason
            if key in joint.angles:
                yield f"{joint.name}.{key}_deg", reason


def _places_where(joint: Joint, holds: Callable[[Joint], bool]) -> list[str]:
    """Names of the sides of a joint of which it holds, and of the joint if it does of both."""
    places = [f"{joint.name}.{side}" for side in SIDES if holds(joint.on(side))]
    return [*places, joint.name] if len(places) == len(SIDES) else places


def own_names(joint: Joint) -> tuple[str, ...]:
    """Return the dotted names of a joint and of its sides, before the names of their values."""
    return joint.name, *(f"{joint.name}.{side}" for side in SIDES)
