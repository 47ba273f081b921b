"""Which values it makes sense to vary: those that the results of a model depend on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from itertools import chain, islice
from typing import Any

from birdmb.errors import ArgumentError, TopologyError
from birdmb.models import BirdModel, RigidModel
from birdmb.studies.cycles import ModelFactory
from birdmb.topology import Bird
from birdmb.topology.attachments import BODY
from birdmb.topology.unused import SPRING, own_names, unused_values
from birdmb.topology.values import named_places, of_a_side

# So many birds are looked at, before a value that none of them uses is refused.
_LOOKED_AT = 200
_OF_MOTION_IN_SPACE = tuple(
    f"body.{name}"
    for name in ("inertia_xx", "inertia_zz", "inertia_xz", "side_area", "side_coefficient")
)
_PLANAR = 'the bird flies in its plane of symmetry; take a model with motion="free"'


def check_relevant(bird: Bird, vary: Mapping[str, Sequence[Any]], model: ModelFactory) -> None:
    """Refuse to vary what changes nothing: what the model ignores, or other values override.

    Args:
        bird: the bird that is varied.
        vary: values by dotted name; what one of them leaves unused another one may bring into use.
        model: makes the model of a bird.

    Raises:
        ArgumentError: a value without effect.
    """
    ignored = ignored_values(bird, model)
    for name in vary:
        if name in ignored:
            raise _without_effect(name, ignored[name])
    reasons = dict.fromkeys(vary, "")
    for varied in _variations(bird, vary):
        unused = unused_values(varied)
        reasons = {name: unused[name] for name in reasons if name in unused}
        if not reasons:
            return
    for name, reason in reasons.items():
        if reason:
            raise _without_effect(name, reason)


def _without_effect(name: str, reason: str) -> ArgumentError:
    return ArgumentError(f"{name} cannot be varied, it has no effect: {reason}.")


def ignored_values(bird: Bird, model: ModelFactory) -> dict[str, str]:
    """Why a model ignores values of any bird like this, by dotted name; empty if it uses all."""
    kind: Any = model
    options: dict[str, Any] = {}
    while isinstance(kind, partial):
        options, kind = kind.keywords | options, kind.func
    if not (isinstance(kind, type) and issubclass(kind, BirdModel)):
        return {}  # of a function of the user's nothing is known
    planar = options.get("motion", kind.motion.name) == "planar"
    of_one_side = [name for name, place in named_places(bird).items() if of_a_side(place)]
    names = dict.fromkeys([*_OF_MOTION_IN_SPACE, *of_one_side], _PLANAR) if planar else {}
    if not issubclass(kind, RigidModel):
        return names
    springs = (
        "the rigid model has no springs, all joints follow their drivers; take the multibody model"
    )
    mass = "the wings of the rigid model have no mass; take the multibody model"
    for joint in bird.joints:
        names |= {f"{name}.{key}": springs for name in own_names(joint) for key in SPRING}
        names[f"{joint.name}.mode"] = springs
    names |= {
        f"segments.{bone}.{key}": mass
        for bone in bird.segments.names
        for key in ("mass", "inertia", "centre_of_mass")
    }
    names |= {
        f"attachments.{one.name}.{key}": mass
        for one in bird.attachments
        if one.on != BODY
        for key in ("mass", "inertia", "position")
    }
    for feather in bird.hinged_feathers:  # a hinge stands at its rest
        names |= {f"{feather.hinge_name}.{key}": springs for key in ("stiffness", "damping")}
        names[f"{feather.hinge_name}.mass"] = mass
    return names


def _variations(bird: Bird, vary: Mapping[str, Sequence[Any]]) -> Iterator[Bird]:
    """Birds with the first values, and with each other value of one of them; the possible ones."""
    first = {name: values[0] for name, values in vary.items()}
    others = (first | {name: value} for name, values in vary.items() for value in values[1:])
    for values in islice(chain([first], others), _LOOKED_AT):
        with suppress(TopologyError):  # the failure of its points
            yield bird.with_values(values)
