"""What, besides the grid, the results of a study depend on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import partial
from importlib.metadata import version
from typing import Any

from birdmb.orbits.newton import SolverMethod
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.sweeps.errors import SweepError
from birdmb.topology import Bird

_NAMED = 3


@dataclass(frozen=True)
class Search:
    """How limit cycles are searched for; see `find_limit_cycle`."""

    tolerance: float
    max_iterations: int
    segments: int
    method: SolverMethod


@dataclass(frozen=True)
class Trimming:
    """How the flight of each point is trimmed; see `trim_flight`.

    Attributes:
        parameters: bounds by dotted name.
        climb_rate: wanted, m/s.
        speed: wanted, m/s, if two parameters are trimmed.
        tolerance: largest difference from a target, m/s.
    """

    parameters: Mapping[str, tuple[float, float]]
    climb_rate: float = 0.0
    speed: float | None = None
    tolerance: float = 1e-6


def identity(
    bird: Bird, model: ModelFactory, search: Search, trimming: Trimming | None
) -> dict[str, Any]:
    """Everything that results depend on besides the grid, fit for JSON.

    The bird as it was written, for what was left to its default follows what is varied.
    """
    return {
        "birdmb": version("birdmb"),
        "fingerprint": bird.fingerprint(),
        "bird": bird.model_dump(mode="json", exclude_unset=True),
        "model": model_name(model),
        "search": asdict(search),
        "trim": None if trimming is None else asdict(trimming),
    }


def model_name(model: ModelFactory) -> str:
    """The model as a text: `MultibodyModel`, `RigidModel(steps_per_beat=30)`.

    Raises:
        SweepError: workers could not import it, and no store could tell it from another.
    """
    if isinstance(model, partial):
        options = [*map(repr, model.args), *(f"{k}={v!r}" for k, v in model.keywords.items())]
        return f"{model_name(model.func)}({', '.join(options)})"
    name = str(getattr(model, "__qualname__", "<unnamed>"))
    if "<" in name:
        raise SweepError(
            f"The model of a sweep must be a class or function with a name of its own, or "
            f"functools.partial of one, for workers to import it; {name} is not."
        )
    return name


def difference(stored: Mapping[str, Any], asked: Mapping[str, Any]) -> str | None:
    """What sets two identities apart, as "body.mass is 1.2 there and 1.3 here"; `None` if nothing.

    "There" is the store.
    """
    for key, what in (("birdmb", "the version of birdmb"), ("model", "the model")):
        if stored[key] != asked[key]:
            return _apart(what, stored[key], asked[key])
    if stored["trim"] != asked["trim"]:
        return _apart("the trim", stored["trim"] or "none", asked["trim"] or "none")
    for key, value in asked["search"].items():
        if stored["search"].get(key) != value:
            return _apart(f"{key} of the search", stored["search"].get(key), value)
    if stored["fingerprint"] != asked["fingerprint"]:
        return _between_birds(*(Bird.model_validate(one["bird"]) for one in (stored, asked)))
    if stored["bird"] != asked["bird"]:
        return "the bird has the same values, but others of them were left to their defaults"
    return None


def _between_birds(there: Bird, here: Bird) -> str:
    names = [name for name in here.value_names() if not name.endswith("_deg")]
    if set(names) != {name for name in there.value_names() if not name.endswith("_deg")}:
        return "the bird has other joints or feathers"
    apart = [name for name in names if there.value(name) != here.value(name)]
    # A whole whose parts are listed, as the discretisation is, says nothing more.
    apart = [name for name in apart if not any(other.startswith(f"{name}.") for other in apart)]
    listed = [_apart(name, there.value(name), here.value(name)) for name in apart[:_NAMED]]
    more = [f"{len(apart) - _NAMED} other values differ"] if len(apart) > _NAMED else []
    return "; ".join(listed + more) or "a preset had other numbers"


def _apart(what: str, there: object, here: object) -> str:
    return f"{what} is {there} there and {here} here"
