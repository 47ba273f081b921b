"""The models that the option --model names."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, TypeAlias

from birdmb.models import MultibodyModel, RigidModel
from birdmb.models.motion import FlightMotionName
from birdmb.topology import Bird

ModelClass: TypeAlias = type[RigidModel] | type[MultibodyModel]

_CLASSES: dict[str, ModelClass] = {"rigid": RigidModel, "multibody": MultibodyModel}


def model_class(name: str) -> ModelClass:
    """The class of models of that name, one of `birdmb.cli.options.ModelName`."""
    return _CLASSES[name]


def bound_model(
    name: str, motion: FlightMotionName, steps_per_beat: int | None
) -> Callable[[Bird], RigidModel | MultibodyModel]:
    """What makes the models that the options --model, --motion and --steps-per-beat name."""
    options: dict[str, Any] = {}
    if motion != "planar":
        options["motion"] = motion
    if steps_per_beat is not None:
        options["steps_per_beat"] = steps_per_beat
    kind = model_class(name)
    return partial(kind, **options) if options else kind
