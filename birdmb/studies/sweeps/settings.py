"""What, besides the grid, the results of a study depend on."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import partial
from importlib.metadata import version
from typing import Any, get_args

from birdmb.arguments import checked
from birdmb.errors import ArgumentError
from birdmb.orbits.errors import require_tolerance
from birdmb.orbits.newton import Damping
from birdmb.orbits.search import SearchMethod
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.sweeps.errors import SweepError
from birdmb.summary import Summarised
from birdmb.topology import Bird

_NAMED = 3


@dataclass(frozen=True, repr=False)
class Search(Summarised):
    """How limit cycles are searched for; see `find_limit_cycle`."""

    tolerance: float
    accuracy: float
    max_iterations: int
    segments: int | None
    method: SearchMethod
    damping: Damping

    def __post_init__(self) -> None:
        """Refuse at once what would fail at every point."""
        for name, choices in (("method", SearchMethod), ("damping", Damping)):
            if getattr(self, name) not in get_args(choices):
                choice = " or ".join(f'"{each}"' for each in get_args(choices))
                raise ArgumentError(f'{name} must be {choice}, not "{getattr(self, name)}".')
        require_tolerance("tolerance", self.tolerance)
        require_tolerance("accuracy", self.accuracy)
        for name in ("max_iterations", "segments"):
            number = getattr(self, name)
            if number is not None and number < 1:
                raise ArgumentError(f"{name} must be 1 or more, not {getattr(self, name)}.")


@checked
@dataclass(frozen=True, repr=False)
class Trimming(Summarised):
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

    def __post_init__(self) -> None:
        """Refuse at once what would fail at every point."""
        wanted = "a climb rate" if self.speed is None else "a climb rate and a speed"
        targets = 1 if self.speed is None else 2
        if len(self.parameters) != targets:
            raise ArgumentError(
                f"a trim to {wanted} needs {targets} parameter(s), not {len(self.parameters)}."
            )
        for name, (low, high) in self.parameters.items():
            if not -math.inf < low < high < math.inf:
                raise ArgumentError(
                    f"the bounds of {name} must be finite and ascending, not {low} and {high}."
                )
        if not math.isfinite(self.climb_rate):
            raise ArgumentError(f"the climb rate must be finite, in m/s, not {self.climb_rate}.")
        if self.speed is not None and not abs(self.climb_rate) < self.speed < math.inf:
            raise ArgumentError(
                f"the speed must be positive and more than the climb rate, {self.climb_rate:g} "
                f"m/s, not {self.speed:g} m/s."
            )
        if not 0.0 < self.tolerance < math.inf:
            raise ArgumentError(f"the trim's tolerance must be positive, not {self.tolerance}.")

    @property
    def targets(self) -> dict[str, float]:
        """What the flight is trimmed to, m/s, by name."""
        climb = {"climb_rate": self.climb_rate}
        return climb if self.speed is None else climb | {"speed": self.speed}


def identity(
    bird: Bird,
    model: ModelFactory,
    search: Search,
    trimming: Trimming | None,
    *,
    keep_to_sheet: bool = False,
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
        "keep_to_sheet": keep_to_sheet,
    }


def model_name(model: ModelFactory) -> str:
    """The model as a text: `MultibodyModel`, `RigidModel(steps_per_beat=30)`.

    Raises:
        SweepError: workers could not import it, and no store could tell it from another.
    """
    if isinstance(model, partial):
        options = [*map(repr, model.args), *(f"{k}={v!r}" for k, v in model.keywords.items())]
        if nameless := next((option for option in options if " at 0x" in option), None):
            raise SweepError(
                f"The model of a sweep must have options that are the same in every run, for its "
                f"store to tell it from another; {nameless} is none."
            )
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
    wholes = ("birdmb", "the version of birdmb"), ("model", "the model")
    for key, what in (*wholes, ("keep_to_sheet", "keep_to_sheet")):
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
