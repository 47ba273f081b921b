"""The bird that a command line asks for."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from birdmb.cli.outcome import InputError
from birdmb.topology import Bird, load_bird, parse_assignment
from birdmb.topology.unused import SPRING, own_names, unused_spring


def requested_bird(
    topology: str, assignments: Sequence[str], varied: Mapping[str, object] | None = None
) -> Bird:
    """The bird of a topology file with the values of `NAME=VALUE` assignments, in any order.

    `varied` are the first values, by dotted name, of what the command varies. A joint whose damping
    is assigned and whose stiffness is varied is whole only with both: it gets them together.

    Raises:
        TopologyError: the file, a name or a value is wrong.
        InputError: a name is assigned twice, or a spring or damper to a joint without use for it.
    """
    bird = load_bird(topology)
    values: dict[str, object] = {}
    for name, value in map(parse_assignment, assignments):
        if name in values:
            raise InputError(f"--set gives {name} twice; keep one of the two.")
        values[name] = value
    if not values:
        return bird
    completed = {**_completing(bird, values, varied or {}), **values}
    found = bird.with_values(completed)
    for joint in found.joints:
        reason = unused_spring(joint)
        names = [f"{own}.{key}" for own in own_names(joint) for key in SPRING]
        unused = [name for name in names if name in values]
        if reason and unused and f"{joint.name}.mode" not in (varied or {}):
            raise InputError(f"--set {unused[0]} has no effect: {reason}.")
    return found


def lasting(assignments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Split assignments into what makes another bird and what is for a computation alone.

    The latter is how finely a bird is computed: a file that is written has what it had before.
    """
    passing = [text for text in assignments if _is_discretisation(parse_assignment(text)[0])]
    return [text for text in assignments if text not in passing], passing


def _is_discretisation(name: str) -> bool:
    return name.split(".")[:2] == ["wing", "discretisation"]


def _completing(
    bird: Bird, assigned: Collection[str], varied: Mapping[str, object]
) -> dict[str, object]:
    """What is varied of the springs and dampers that are also assigned to."""
    found: dict[str, object] = {}
    for joint in bird.joints:
        names = [f"{own}.{key}" for own in own_names(joint) for key in SPRING]
        if any(name in assigned for name in names):
            found |= {name: varied[name] for name in names if name in varied}
    return found
