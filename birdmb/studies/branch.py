"""A branch of limit cycles of a bird along one of its parameters, through folds and past them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias, cast

import numpy as np

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError, BirdmbError, StateError, TopologyError
from birdmb.models import FlightCycle, FlightModel, MultibodyModel
from birdmb.models.wing_model import BirdModel
from birdmb.orbits import (
    Bifurcation,
    Branch,
    BranchPoint,
    LimitCycle,
    Steps,
    continue_branch,
)
from birdmb.orbits.search import TOLERANCE, SearchMethod
from birdmb.quantities import Quantity, quantities
from birdmb.studies.relevance import check_relevant
from birdmb.studies.validity import Validity, assess_validity
from birdmb.topology import Bird
from birdmb.topology.roles import flap_joint

FamilyModel: TypeAlias = Callable[..., FlightModel]
"""Makes a model of a bird: `MultibodyModel`, `RigidModel`, or either with options bound."""

_SAMPLES = 9
_DEFAULT_STEPS = Steps()

_RECORDED = quantities(("mean_speed", "mean_climb_rate", "power", "mean_pitch"))
_VALID = quantities(("largest_angle_of_attack", "reduced_frequency"))
_CHECKED = quantities(("integration_error",))
OBSERVABLE_UNITS: Mapping[str, str] = {
    **{each.name: each.unit for each in _RECORDED},
    "highest_flap": "rad",
    "lowest_flap": "rad",
    **{each.name: each.unit for each in (*_VALID, *_CHECKED)},
}


@checked
def bird_branch(
    bird: Bird,
    name: str,
    parameter_range: tuple[float, float],
    model: FamilyModel = MultibodyModel,
    *,
    method: SearchMethod = "auto",
    steps_per_beat: int | None = None,
    segments: int | None = None,
    steps: Steps = _DEFAULT_STEPS,
    max_points: int = 200,
    max_bifurcations: int | None = None,
    tolerance: float = TOLERANCE,
    resume: Branch | None = None,
    store: str | Path | None = None,
    executor: Executor | None = None,
    callback: Callable[[BranchPoint | Bifurcation], None] | None = None,
) -> Branch:
    """Follow the limit cycles of a bird in one parameter by `continue_branch`.

    Of shooting, one method and number of integration steps holds for the whole branch: a model that
    chose its own from value to value would make the orbits jump.

    Args:
        bird: the bird.
        name: dotted name of the parameter, any number of the bird: a joint's stiffness or damping,
            of the gait, of the geometry.
        parameter_range: from where to where, in the unit of the name. The branch starts at the
            first, which it may come back to.
        model: makes the model of a bird.
        method: "collocation", "shooting" or "auto", as for `continue_branch`.
        steps_per_beat: integration steps; given, they make "auto" choose shooting. By default the
            most that the model chooses at any of 9 values over the range, and a multiple of
            `segments`.
        segments: number of shooting segments, by default 1; given, it makes "auto" choose shooting.
        steps: step sizes along the branch.
        max_points: number of points allowed, those resumed from included.
        max_bifurcations: end at the first point after so many bifurcations.
        tolerance: closure error accepted, in units of the state scale.
        resume: an unfinished branch of the same bird, range, model and settings to go on with.
        store: file in which the branch is saved after every point.
        executor: spreads flows over workers.
        callback: called with every point and every bifurcation as it is found.

    Returns:
        The branch. Observables of its points, in SI units and rad (`OBSERVABLE_UNITS`): mean
        `mean_speed`, `mean_climb_rate`, `power` and `mean_pitch` over a beat, `highest_flap` and
        `lowest_flap` that the joint reaches that flaps (`flap_joint`, if there is one), how far the
        flight is from the limits of the model (`largest_angle_of_attack`, `reduced_frequency`, see
        `assess_validity`), and `integration_error` (see `FlightCycle`). Its `settings` say which
        bird this is (`fingerprint`, that at the start of the range) and how it was computed.

    Raises:
        TopologyError: an unknown name, or an impossible value at the start of the range.
        ArgumentError: the name is not that of a number, or of one without effect, or `resume` is
            another branch.
        OrbitError: no limit cycle at the start of the range.
        StateError: the search there could not start.
    """
    first, last = map(float, parameter_range)
    if first == last:
        raise ArgumentError(f"{name} must have two different ends, not {first:g} twice.")
    _reject_no_number(bird, name)
    check_relevant(bird, {name: (first, last)}, model)
    start = bird.with_values({name: first})
    integration = _integration(bird, name, (first, last), model, steps_per_beat)
    if method == "auto" and (steps_per_beat is not None or segments is not None):
        method = "shooting"
    count = segments or 1
    if steps_per_beat is None:
        integration["steps_per_beat"] = -(-integration["steps_per_beat"] // count) * count
    family = partial(_member, bird, name, partial(model, **integration))
    settings: dict[str, str | float] = {
        "bird": start.name,
        "fingerprint": start.fingerprint(),
        "parameter": name,
        "from": first,
        "to": last,
        "model": type(family(first)).__name__,
        "method": method,
        **integration,
        "segments": count,
        "tolerance": tolerance,
        "longest_step": steps.longest,
    }
    if resume is not None:
        _reject_another(resume, settings)
    return continue_branch(
        family,
        (first, last),
        parameter_name=name,
        method=method,
        segments=segments,
        steps=steps,
        max_points=max_points,
        max_bifurcations=max_bifurcations,
        tolerance=tolerance,
        observables=flight_observables(bird),
        resume=resume,
        store=store,
        settings=settings,
        executor=executor,
        callback=callback,
    )


def _member(bird: Bird, name: str, model: FamilyModel, value: float) -> FlightModel:
    return model(bird.with_values({name: value}))


def _reject_no_number(bird: Bird, name: str) -> None:
    value = bird.value(name)
    # What is not given yet, such as the stiffness of a prescribed joint, may still be a number.
    if not isinstance(value, float | None):
        raise ArgumentError(f"{name} is not a real number: no branch can follow it.")


def _integration(
    bird: Bird,
    name: str,
    parameter_range: tuple[float, float],
    model: FamilyModel,
    steps_per_beat: int | None,
) -> dict[str, Any]:
    """Options of the model that meet its needs over the range, wherever it has an answer."""
    options = {} if steps_per_beat is None else {"steps_per_beat": steps_per_beat}
    members: list[BirdModel] = []
    failure: BirdmbError | None = None
    for value in np.linspace(*parameter_range, _SAMPLES):
        try:
            member = model(bird.with_values({name: float(value)}), **options)
            _ = member.steps_per_beat
            members.append(member)
        except (TopologyError, StateError) as error:
            failure = failure or error
    if not members:
        raise cast(BirdmbError, failure)
    implicit = [m for m in members if isinstance(m, MultibodyModel) and _is_implicit(m)]
    found: dict[str, Any] = {"steps_per_beat": max(m.steps_per_beat for m in implicit or members)}
    if isinstance(members[0], MultibodyModel):
        found["integrator"] = "implicit" if implicit else "explicit"
    return found


def _is_implicit(model: MultibodyModel) -> bool:
    return model.integration.method == "implicit"


def _reject_another(branch: Branch, settings: Mapping[str, str | float]) -> None:
    for key, wanted in settings.items():
        kept = branch.settings.get(key)
        if kept == wanted:
            continue
        if key == "fingerprint":
            raise ArgumentError(
                f"the branch to resume is of another {branch.settings.get('bird', 'system')}: "
                f"a value other than {settings['parameter']} differs."
            )
        raise ArgumentError(
            f"the branch to resume was computed with {key.replace('_', ' ')} {_shown(kept)}, "
            f"not {_shown(wanted)}."
        )


def _shown(value: str | float | None) -> str:
    return f"{value:g}" if isinstance(value, int | float) else str(value)


def flight_observables(bird: Bird) -> dict[str, Callable[[LimitCycle], float]]:
    """What `bird_branch` records of each flight, for `continue_branch` along other families.

    Functions of the limit cycle, in the units of `OBSERVABLE_UNITS`.
    """
    found: dict[str, Callable[[FlightCycle], float]] = {each.name: each.of for each in _RECORDED}
    if (flapping := flap_joint(bird)) is not None:
        joint = bird.joint_names.index(flapping.name)
        found["highest_flap"] = lambda cycle: float(_angles(cycle, joint).max())
        found["lowest_flap"] = lambda cycle: float(_angles(cycle, joint).min())
    validity = _LastValidity()
    found |= {each.name: _of_validity(validity, each) for each in _VALID}
    found |= {each.name: each.of for each in _CHECKED}
    return cast("dict[str, Callable[[LimitCycle], float]]", found)


def _of_validity(validity: _LastValidity, quantity: Quantity) -> Callable[[FlightCycle], float]:
    return lambda cycle: quantity.of(validity(cycle))


class _LastValidity:
    """`assess_validity`, which several observables of one cycle share."""

    def __init__(self) -> None:
        self._of: tuple[FlightCycle, Validity] | None = None

    def __call__(self, cycle: FlightCycle) -> Validity:
        if self._of is None or self._of[0] is not cycle:
            self._of = cycle, assess_validity(cycle)
        return self._of[1]


def _angles(cycle: FlightCycle, joint: int) -> FloatArray:
    """Angle (K,) rad of a joint over a beat."""
    model, beat = cycle.model, cycle.beat
    at = zip(beat.times, beat.states, strict=True)
    return np.array([model.joint_motion(t, x)[0][joint] for t, x in at])
