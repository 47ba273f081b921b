"""Which values it makes sense to vary: those that the results of a model depend on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import partial
from itertools import chain, islice
from typing import Any

from birdmb.errors import TopologyError
from birdmb.models import RigidModel
from birdmb.orbits import ArgumentError
from birdmb.studies.cycles import ModelFactory
from birdmb.topology import Bird
from birdmb.topology.parts import BONES
from birdmb.topology.unused import SPRING, unused_values

# So many birds are looked at: one that uses a value is most often the first.
_LOOKED_AT = 200


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
    unused = [unused_values(each) for each in _variations(bird, vary)]
    for name in vary:
        reason = ignored.get(name) or (
            unused[0][name] if unused and all(name in each for each in unused) else ""
        )
        if reason:
            hint = "; take the multibody model" if name in ignored else ""
            raise ArgumentError(f"{name} cannot be varied, it has no effect: {reason}{hint}.")


def ignored_values(bird: Bird, model: ModelFactory) -> dict[str, str]:
    """Why a model ignores values of any bird like this, by dotted name; empty if it uses all."""
    kind: Any = model
    while isinstance(kind, partial):
        kind = kind.func
    if not (isinstance(kind, type) and issubclass(kind, RigidModel)):
        return {}
    springs = "the rigid model has no springs, all joints follow their drivers"
    mass = "the wings of the rigid model have no mass"
    names = {f"{joint.name}.{key}": springs for joint in bird.joints for key in (*SPRING, "mode")}
    names |= {
        f"segments.{bone}.{key}": mass
        for bone in BONES
        for key in ("mass", "inertia", "centre_of_mass")
    }
    for feather in bird.hinged_feathers:  # a hinge stands at its rest
        names |= {f"{feather.hinge_name}.{key}": springs for key in ("stiffness", "damping")}
        names[f"{feather.hinge_name}.mass"] = mass
    return names


def _variations(bird: Bird, vary: Mapping[str, Sequence[Any]]) -> list[Bird]:
    """Birds with the first values, and with each other value of one of them; the possible ones."""
    first = {name: values[0] for name, values in vary.items()}
    others = (first | {name: value} for name, values in vary.items() for value in values[1:])
    birds = []
    for values in islice(chain([first], others), _LOOKED_AT):
        with suppress(TopologyError):  # the failure of its points
            birds.append(bird.with_values(values))
    return birds
