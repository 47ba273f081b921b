"""The bird: one immutable, validated value that everything else is computed from."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from itertools import pairwise
from os import PathLike
from pathlib import Path
from typing import Any, Self

from pydantic import Field, field_validator, model_validator

from birdmb.errors import TopologyError
from birdmb.topology.airframe import Drag, Tail
from birdmb.topology.joints import Joint, Side
from birdmb.topology.messages import Location, nearest, problem, shown, validated
from birdmb.topology.names import Label
from birdmb.topology.numbers import Gravity
from birdmb.topology.parts import (
    BONES,
    Air,
    Body,
    Feather,
    Gait,
    Part,
    Segment,
    Wing,
)
from birdmb.topology.values import is_resolution, named_places, place_of, put_values, value_at
from birdmb.topology.writing import write_bird


class Segments(Part):
    """The three segments of a wing, from the shoulder outwards."""

    humerus: Segment = Field(description="upper arm, shoulder to elbow, a table")
    forearm: Segment = Field(description="forearm, elbow to wrist, a table")
    hand: Segment = Field(description="hand, wrist to tip, a table")


class Bird(Part):
    """A bird with its gait: body, two mirror-image wings, tail, joints in order, feathers, air.

    Lengths in m, masses in kg, angles in rad. A variation is a new bird, see `with_values`.
    `Bird.model_validate(dict)` raises pydantic's own error, `load_bird` and the variations
    `TopologyError`.
    """

    name: Label = Field(description="short label of the bird")
    gravity: Gravity = Field(default=9.81, description="gravitational acceleration, m/s2")
    air: Air = Field(default=Air(), description="air the bird flies in, a table")
    gait: Gait = Field(description="gait, a table")
    body: Body = Field(description="body without its wings, a table")
    wing: Wing = Field(description="attachment and discretisation of the wing, a table")
    segments: Segments = Field(description="segments humerus, forearm and hand, tables")
    joints: tuple[Joint, ...] = Field(description="joints from the body outwards, in order")
    feathers: tuple[Feather, ...] = Field(
        description="feathers that span the wing, one at the shoulder and one at the hand's tip"
    )
    tail: Tail | None = Field(default=None, description="tail, a table; none if left out")
    drag: Drag = Field(default=Drag(), description="drag besides the induced one, a table")

    @field_validator("joints")
    @classmethod
    def _chain(cls, joints: tuple[Joint, ...]) -> tuple[Joint, ...]:
        if twice := _first_repeated(joint.name for joint in joints):
            raise problem(f"two joints are called {shown(twice)}; each needs a name of its own")
        for joint in joints:
            if (place := joint.name.partition(".")[0]) in cls.model_fields:
                raise problem(
                    f"{shown(joint.name)} must not start with {place}, a table of the file"
                )
        for inner, outer in pairwise(joints):
            if BONES.index(outer.segment) < BONES.index(inner.segment):
                raise problem(
                    f"{shown(outer.name)} (on the {outer.segment}) is listed after "
                    f"{shown(inner.name)} (on the {inner.segment}); "
                    "joints must be listed from the body outwards"
                )
        return joints

    @field_validator("feathers")
    @classmethod
    def _from_shoulder_to_tip(cls, feathers: tuple[Feather, ...]) -> tuple[Feather, ...]:
        if twice := _first_repeated(feather.name for feather in feathers):
            raise problem(f"two feathers are called {shown(twice)}; each needs a name of its own")
        ordered = tuple(sorted(feathers, key=lambda feather: feather.place))
        for inner, outer in pairwise(ordered):
            if inner.place == outer.place:
                raise problem(
                    f"{shown(inner.name)} and {shown(outer.name)} have the same place; "
                    "each feather needs a place of its own"
                )
        if not ordered or ordered[0].place != 0:
            raise problem("none is at the shoulder; one must be (bone humerus, position 0)")
        if ordered[-1].place != len(BONES):
            raise problem("none is at the hand's tip; one must be (bone hand, position 1)")
        return ordered

    @model_validator(mode="after")
    def _shares_are_of_joints(self) -> Self:
        for feather in self.feathers:
            for joint, _ in feather.shares:
                if joint not in self.joint_names:
                    raise problem(
                        f"no joint is called {shown(joint)}; "
                        f"the nearest: {nearest(joint, self.joint_names)}",
                        f"feathers.{feather.name}.shares",
                    )
        return self

    @property
    def is_symmetric(self) -> bool:
        """Whether all joints have the same values on both sides."""
        return all(joint.is_symmetric for joint in self.joints)

    def side(self, side: Side) -> Bird:
        """Return the symmetric bird whose joints have the values of one side on both."""
        if not any(joint.right or joint.left for joint in self.joints):
            return self
        return self.model_copy(update={"joints": tuple(joint.on(side) for joint in self.joints)})

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints, from the body outwards."""
        return tuple(joint.name for joint in self.joints)

    @property
    def compliant_joints(self) -> tuple[Joint, ...]:
        """The joints that follow their driver through a spring and damper, in chain order."""
        return tuple(joint for joint in self.joints if joint.mode == "compliant")

    @property
    def hinged_feathers(self) -> tuple[Feather, ...]:
        """The feathers on hinges, from the shoulder outwards."""
        return tuple(feather for feather in self.feathers if feather.hinge)

    @property
    def angle_names(self) -> tuple[str, ...]:
        """Names of all angles that place a wing: joints, then the hinges of feathers."""
        return self.joint_names + tuple(feather.hinge_name for feather in self.hinged_feathers)

    @property
    def period(self) -> float:
        """Duration of a wingbeat, s."""
        return 1 / self.gait.frequency

    @property
    def total_mass(self) -> float:
        """Mass of the body and both wings with their hinged feathers, kg."""
        one_wing = self.segments.humerus.mass + self.segments.forearm.mass + self.segments.hand.mass
        one_wing += sum(feather.hinge.mass for feather in self.feathers if feather.hinge)
        return self.body.mass + 2 * one_wing

    def joint(self, name: str) -> Joint:
        """Return the joint of that name; raise `TopologyError` if there is none."""
        for joint in self.joints:
            if joint.name == name:
                return joint
        raise TopologyError(
            f"{self.name}: no joint is called {shown(name)}; "
            f"the nearest: {nearest(name, self.joint_names)}"
        )

    def feather_shares(self, feather: Feather) -> tuple[float, ...]:
        """Return the share of each joint's angle that turns a feather, in the order of `joints`.

        The joints that carry the feather's bone turn it fully, those further out not at all, and a
        twist of its own bone as far as the bone is twisted at its root; the feather's own `shares`
        go before these.
        """
        own = dict(feather.shares)
        bone = BONES.index(feather.bone)

        def default(joint: Joint) -> float:
            carried = BONES.index(joint.segment)
            if joint.twist and carried == bone:
                return feather.position
            return 1.0 if carried <= bone else 0.0

        return tuple(own.get(joint.name, default(joint)) for joint in self.joints)

    # Studies vary one bird many thousand times; finding its names takes as long as all the rest.
    @cached_property
    def _places(self) -> dict[str, Location]:
        return named_places(self)

    def value_names(self) -> tuple[str, ...]:
        """Return every dotted name that `value`, `with_values` and `--set` understand."""
        return tuple(self._places)

    def value(self, name: str) -> Any:
        """Return the value of a dotted name such as `"wing.root.x"` or `"forearm.roll.offset_deg"`.

        In SI units and rad, or in degrees where the name ends in `_deg`. Raises `TopologyError` for
        an unknown name.
        """
        place = place_of(name, self._places, self.name)
        return value_at(self._document(resolved=is_resolution(name)), place)

    def with_values(self, values: Mapping[str, Any]) -> Bird:
        """Return a bird with other values under dotted names, as `{"body.mass": 1.3}`.

        A stiffness or damping given to a prescribed joint makes it compliant, unless its mode is
        given too; without a damping it gets none. Raises `TopologyError` for an unknown name or a
        value that a file must not have either.
        """
        # Defaults are left out where they must follow a change, as the mid-bone follows the length.
        document = self._document(resolved=any(map(is_resolution, values)), exclude_unset=True)
        put_values(document, values, self._places, self.name)
        changed = ", ".join(f"{name} = {shown(value)}" for name, value in values.items())
        return validated(type(self), document, f"{self.name} (with {changed})")

    def with_joint(self, name: str, **values: Any) -> Bird:
        """Return a bird with other values of one joint, as `stiffness=20` or `offset_deg=-5`.

        Works and raises as `with_values`.
        """
        self.joint(name)
        return self.with_values({f"{name}.{key}": value for key, value in values.items()})

    def save(
        self,
        path: str | PathLike[str],
        *,
        like: str | PathLike[str] | None = None,
        about: Sequence[str] = (),
    ) -> Path:
        """Write a topology file that `load_bird` reads as this bird.

        A file that is there is replaced once the new one is whole.

        Args:
            path: the file to write.
            like: the topology file, perhaps the same, whose comments, order and typed values are
                kept; only what is another value in this bird is changed.
            about: lines of comment to put at the top.

        Returns:
            The path.

        Raises:
            OutputError: the file cannot be written.
            TopologyError: `like` is no topology file, or its text cannot be kept.
        """
        return write_bird(self, path, about, like)

    def fingerprint(self) -> str:
        """Return a SHA-256 hash of all values, in hexadecimal, the same in any process.

        A preset counts by its numbers, so that results stored under an older preset are not taken
        for new ones.
        """
        document = self._document(resolved=True, mode="json")
        canonical = json.dumps(document, sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(canonical.encode()).hexdigest()

    def _document(self, *, resolved: bool, **options: Any) -> dict[str, Any]:
        """What `model_dump` returns; `resolved` with the numbers of the discretisation's preset."""
        document = self.model_dump(**options)
        if resolved:
            document["wing"]["discretisation"] = self.wing.resolved_discretisation.model_dump()
        return document


def _first_repeated(names: Iterable[str]) -> str | None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            return name
        seen.add(name)
    return None
