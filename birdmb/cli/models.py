"""The models that the option --model names."""

from __future__ import annotations

from typing import TypeAlias

from birdmb.models import MultibodyModel, RigidModel

ModelClass: TypeAlias = type[RigidModel] | type[MultibodyModel]

_CLASSES: dict[str, ModelClass] = {"rigid": RigidModel, "multibody": MultibodyModel}


def model_class(name: str) -> ModelClass:
    """The class of models of that name, one of `birdmb.cli.options.ModelName`."""
    return _CLASSES[name]
