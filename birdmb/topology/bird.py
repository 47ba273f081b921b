"""The bird: one immutable, validated value that everything else is computed from."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from itertools import pairwise
from os import PathLike
from pathlib import Path
from typing import Any, Self

from pydantic import Field, ValidationInfo, field_validator, model_validator

from birdmb.arguments import checked
from birdmb.errors import TopologyError
from birdmb.summary import Fact
from birdmb.text import nearest
from birdmb.topology.airframe import Drag, Tail
from birdmb.topology.attachments import BODY, Attachment, body_with, segment_with
from birdmb.topology.feathers import Feather
from birdmb.topology.joints import Joint, Side
from birdmb.topology.messages import Location, problem, shown, validated
from birdmb.topology.named import NamedParts
from birdmb.topology.names import Label
from birdmb.topology.numbers import Gravity
from birdmb.topology.parts import (
    Air,
    Body,
    Gait,
    Part,
)
from birdmb.topology.sections import Section
from birdmb.topology.segments import Segments
from birdmb.topology.spanning import (
    first_repeated,
    from_shoulder_to_tip,
    no_segment,
    require_segment,
    segment_names,
)
from birdmb.topology.values import is_resolution, named_places, place_of, put_values, value_at
from birdmb.topology.wings import Profile, Wing
from birdmb.topology.writing import write_bird


class Bird(Part):
    """A bird with its gait: body, two mirror-image wings, tail, joints in order, air.

    A wing is a chain of segments, spanned by feathers or by sections along its bones. Lengths in m,
    masses in kg, angles in rad. A variation is a new bird, see `with_values`.
    `Bird.model_validate(dict)` raises pydantic's own error, `load_bird` and the variations
    `TopologyError`.
    """

    name: Label = Field(description="short label of the bird")
    gravity: Gravity = Field(default=9.81, description="gravitational acceleration, m/s2")
    air: Air = Field(default=Air(), description="air the bird flies in, a table")
    gait: Gait = Field(description="gait, a table")
    body: Body = Field(description="body without its wings, a table")
    wing: Wing = Field(description="attachment and discretisation of the wing, a table")
    segments: Segments = Field(
        description="segments of a wing from the shoulder outwards, a table each, as "
        "[segments.humerus]"
    )
    joints: NamedParts[Joint] = Field(
        description="joints from the body outwards, in order; joints = [] if there are none"
    )
    feathers: NamedParts[Feather] = Field(
        default=(),
        validate_default=True,
        description="feathers that span the wing, one at the shoulder and one at the last "
        "segment's end; or else sections do",
    )
    sections: NamedParts[Section] = Field(
        default=(),
        validate_default=True,
        description="sections that span the wing in place of feathers, one at the shoulder and one "
        "at the last segment's end",
    )
    attachments: NamedParts[Attachment] = Field(
        default=(),
        validate_default=True,
        description="further rigid bodies on the body or on segments",
    )
    tail: Tail | None = Field(default=None, description="tail, a table; none if left out")
    drag: Drag = Field(default=Drag(), description="drag besides the induced one, a table")

    @field_validator("joints")
    @classmethod
    def _chain(cls, joints: NamedParts[Joint], info: ValidationInfo) -> NamedParts[Joint]:
        if twice := first_repeated(joint.name for joint in joints):
            raise problem(f"two joints are called {shown(twice)}; each needs a name of its own")
        tables = cls.model_fields
        for joint in joints:
            if (place := joint.name.partition(".")[0]) in tables:
                raise problem(
                    f"{shown(joint.name)} must not start with {place}, a table of the file"
                )
        if (known := segment_names(info)) is None:
            return joints
        for i, joint in enumerate(joints):
            require_segment(joint.segment, known, i, "segment")
        for inner, outer in pairwise(joints):
            if known.index(outer.segment) < known.index(inner.segment):
                raise problem(
                    f"{shown(outer.name)} (on the {outer.segment}) is listed after "
                    f"{shown(inner.name)} (on the {inner.segment}); "
                    "joints must be listed from the body outwards"
                )
        return joints

    @field_validator("feathers")
    @classmethod
    def _feathers_to_the_tip(
        cls, feathers: NamedParts[Feather], info: ValidationInfo
    ) -> NamedParts[Feather]:
        return from_shoulder_to_tip(feathers, "feather", segment_names(info))

    @field_validator("sections")
    @classmethod
    def _sections_to_the_tip(
        cls, sections: NamedParts[Section], info: ValidationInfo
    ) -> NamedParts[Section]:
        ordered = from_shoulder_to_tip(sections, "section", segment_names(info))
        for section in ordered[:-1]:
            if section.chord == 0:
                text = "must be more than 0; only the section at the wing's tip may be a point"
                raise problem(text, sections.index(section), "chord")
        return ordered

    @field_validator("attachments")
    @classmethod
    def _on_what_there_is(
        cls, attachments: NamedParts[Attachment], info: ValidationInfo
    ) -> NamedParts[Attachment]:
        if twice := first_repeated(one.name for one in attachments):
            raise problem(f"two are called {shown(twice)}; each needs a name of its own")
        if (known := segment_names(info)) is not None:
            for i, one in enumerate(attachments):
                require_segment(one.on, (BODY, *known), i, "on")
        return attachments

    @model_validator(mode="after")
    def _wing_is_spanned(self) -> Self:
        if self.feathers and self.sections:
            raise problem("given beside feathers; keep one of the two to span the wing", "sections")
        if not (self.feathers or self.sections):
            raise problem(
                "missing; a wing is spanned by [[feathers]] or by [[sections]]", "feathers"
            )
        skin = self.wing.propatagium
        if skin is not None and skin not in self.segments:
            raise problem(no_segment(skin, self.segments.names), "wing", "propatagium")
        return self

    @model_validator(mode="after")
    def _one_profile_drag(self) -> Self:
        if self.drag.profile_coefficient and any(p.polar for p in self.profiles):
            raise problem(
                "given beside a polar, whose drag is all that a section has; keep one of the two",
                *("drag", "profile_coefficient"),
            )
        return self

    @model_validator(mode="after")
    def _shares_are_of_joints(self) -> Self:
        known = self.joint_names
        for i, feather in enumerate(self.feathers):
            for joint, _ in feather.shares:
                if joint not in known:
                    raise problem(
                        f"no joint is called {shown(joint)}; the nearest: {nearest(joint, known)}",
                        "feathers",
                        i,
                        "shares",
                    )
        return self

    def _dotted(self, key: str) -> str:
        return key

    def _summary(self) -> Iterator[Fact]:
        yield Fact("mass", f"{self.total_mass:.4g}", "kg")
        yield Fact("wingbeat", f"{self.gait.frequency:.4g}", "Hz")
        yield Fact("segments", ", ".join(self.segments.names))
        for parts in ("joints", "feathers", "hinged_feathers", "sections", "attachments"):
            if count := len(getattr(self, parts)):
                yield Fact(parts.replace("_", " "), str(count))
        yield from (Fact("compliant", joint.name) for joint in self.compliant_joints)
        yield Fact("tail", "none" if self.tail is None else "yes")
        yield Fact("air", self.air.wake)

    @property
    def profiles(self) -> tuple[Profile, ...]:
        """Profile of each section from the shoulder outwards, or one where they have none."""
        own = [section.profile for section in self.sections]
        return tuple(profile or self.wing.profile for profile in own or [None])

    @property
    def stalls(self) -> bool:
        """Whether flow separates from the wings' sections."""
        return any(profile.polar or profile.stall for profile in self.profiles)

    @property
    def is_symmetric(self) -> bool:
        """Whether all joints have the same values on both sides."""
        return all(joint.is_symmetric for joint in self.joints)

    @checked
    def side(self, side: Side) -> Bird:
        """Return the symmetric bird whose joints have the values of one side on both."""
        if not any(joint.right or joint.left for joint in self.joints):
            return self
        joints = NamedParts(joint.on(side) for joint in self.joints)
        return self.model_copy(update={"joints": joints})

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints, from the body outwards."""
        return tuple(joint.name for joint in self.joints)

    @property
    def compliant_joints(self) -> NamedParts[Joint]:
        """The joints that follow their driver through a spring and damper, in chain order."""
        return NamedParts(joint for joint in self.joints if joint.mode == "compliant")

    @property
    def hinged_feathers(self) -> NamedParts[Feather]:
        """The feathers on hinges, from the shoulder outwards."""
        return NamedParts(feather for feather in self.feathers if feather.hinge)

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
        """Mass of the body and both wings with their hinged feathers and attachments, kg."""
        one_wing = sum(segment.mass for _, segment in self.segments.items())
        one_wing += sum(feather.hinge.mass for feather in self.feathers if feather.hinge)
        one_wing += sum(one.mass for one in self.attachments if one.on != BODY)
        on_body = sum(one.copies * one.mass for one in self.attachments if one.on == BODY)
        return self.body.mass + on_body + 2 * one_wing

    @property
    def assembled(self) -> Bird:
        """The same bird with all attachments made part of body and segments.

        The body's centre of mass, from which the shoulder and the tail are measured, is then that
        of the body with all that is attached to it.
        """
        if not self.attachments:
            return self
        carriers: dict[str, list[Attachment]] = {}
        for one in self.attachments:
            carriers.setdefault(one.on, []).append(one)
        body, moved = body_with(self.body, carriers.get(BODY, []))
        ahead, below = float(moved[0]), float(moved[2])
        root = self.wing.root
        root = root.model_copy(update={"x": root.x - ahead, "z": root.z - below})
        segments = {
            name: segment_with(segment, carriers[name]) if name in carriers else segment
            for name, segment in self.segments.items()
        }
        joined: dict[str, Any] = {
            "body": body,
            "wing": self.wing.model_copy(update={"root": root}),
            "segments": Segments(segments),
            "attachments": NamedParts(),
        }
        if self.tail is not None:
            apex = self.tail.apex
            apex = apex.model_copy(update={"x": apex.x - ahead, "z": apex.z - below})
            joined["tail"] = self.tail.model_copy(update={"apex": apex})
        return self.model_copy(update=joined)

    @checked
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
        names = self.segments.names
        bone = names.index(feather.bone)
        shares = []
        for joint in self.joints:
            carried = names.index(joint.segment)
            by_default = 1.0 if carried <= bone else 0.0
            if joint.twist and carried == bone:
                by_default = feather.position
            shares.append(own.get(joint.name, by_default))
        return tuple(shares)

    # Studies vary one bird many thousand times; finding its names takes as long as all the rest.
    @cached_property
    def _places(self) -> dict[str, Location]:
        return named_places(self)

    def value_names(self) -> tuple[str, ...]:
        """Return every dotted name that `value`, `with_values` and `--set` understand."""
        return tuple(self._places)

    @checked
    def value(self, name: str) -> Any:
        """Return the value of a dotted name such as `"wing.root.x"` or `"forearm.roll.offset_deg"`.

        In SI units and rad, or in degrees where the name ends in `_deg`. Raises `TopologyError` for
        an unknown name.
        """
        place = place_of(name, self._places, self.name)
        return value_at(self._document(resolved=is_resolution(name)), place)

    @checked
    def with_values(self, values: Mapping[str, Any]) -> Bird:
        """Return a bird with other values under dotted names, as `{"body.mass": 1.3}`.

        A stiffness or damping given to a prescribed joint makes it compliant, unless its mode is
        given too; without a damping it gets none. Raises `TopologyError` for an unknown name or a
        value that a file must not have either.
        """
        # Defaults are left out where they must follow a change, as the mid-bone follows the length;
        # parts that do not change stay as they are, for studies vary one bird many thousand times.
        document: dict[str, Any] = {key: part for key, part in self if key in self.model_fields_set}
        if any(map(is_resolution, values)):
            document["wing"] = self._resolved(self.wing.model_dump(exclude_unset=True))
        put_values(document, values, self._places, self.name)

        def origin() -> str:
            changed = ", ".join(f"{name} = {shown(value)}" for name, value in values.items())
            return f"{self.name} (with {changed})"

        return validated(type(self), document, origin)

    @checked
    def with_joint(self, name: str, **values: Any) -> Bird:
        """Return a bird with other values of one joint, as `stiffness=20` or `offset_deg=-5`.

        Works and raises as `with_values`.
        """
        self.joint(name)
        return self.with_values({f"{name}.{key}": value for key, value in values.items()})

    @checked
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
            document["wing"] = self._resolved(document["wing"])
        return document

    def _resolved(self, wing: dict[str, Any]) -> dict[str, Any]:
        """The wing's table with the numbers of the discretisation's preset."""
        return {**wing, "discretisation": self.wing.resolved_discretisation.model_dump()}
