"""What a morphology file gives in place of a topology's body, shoulder and segments.

Body: from the reference point, x forward, y right, z down. Segments: as in a topology, y along the
bone outwards, origin at the segment's root. All of it is of the right wing.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import ConfigDict, Field, RootModel, field_validator, model_validator

from birdmb.topology.messages import problem
from birdmb.topology.names import Label
from birdmb.topology.numbers import Angle, Coordinate, Distance, Length, Mass, MassOrNone, Real
from birdmb.topology.parts import Part

Point = tuple[Coordinate, Coordinate, Coordinate]
Position = Annotated[Real, Field(ge=0, le=1)]

_MOMENTS = ("inertia", "inertia_xx", "inertia_yy", "inertia_zz", "inertia_xz")


class BodyPart(Part):
    """A solid of uniform density in the plane of symmetry, its axes along the body's."""

    name: Label = Field(description='name of the part, such as "torso"')
    shape: Literal["ellipsoid", "cylinder", "plate"] = Field(
        description="shape of the part: ellipsoid, cylinder along x, or flat plate"
    )
    mass: Mass = Field(description="mass of the part, kg")
    length: Length = Field(description="length along x, m")
    width: Length = Field(description="whole width along y, m")
    height: Length | None = Field(
        default=None, description="whole height along z, m; by default the width, of a plate none"
    )
    x: Coordinate | None = Field(
        default=None,
        description="how far the part's centre is ahead of the reference point, m; by default the "
        "part begins where the one before it ends, the first at the reference point",
    )
    z: Coordinate = Field(
        default=0.0, description="how far the part's centre is below the reference point, m"
    )

    @model_validator(mode="after")
    def _plates_are_thin(self) -> Self:
        if self.shape == "plate" and self.height is not None:
            raise problem("a plate is thin; leave its height out", "height")
        return self


class MeasuredBody(Part):
    """The body without its wings, as the sum of its parts; other keys are as in a topology."""

    model_config = ConfigDict(extra="ignore")

    parts: tuple[BodyPart, ...] = Field(
        description="list of the body's parts, from the bill to the tail"
    )

    @field_validator("parts")
    @classmethod
    def _has_parts(cls, parts: tuple[BodyPart, ...]) -> tuple[BodyPart, ...]:
        if not parts:
            raise problem("empty; a body needs one part at least, as [[body.parts]]")
        return parts

    @model_validator(mode="before")
    @classmethod
    def _mass_is_of_the_parts(cls, data: Any) -> Any:
        for key in ("mass", *_MOMENTS):
            if isinstance(data, Mapping) and key in data:
                raise problem("follows from the body's parts; leave it out", key)
        return data


class MeasuredWing(Part):
    """Where the shoulder is; other keys are as in a topology."""

    model_config = ConfigDict(extra="ignore")

    shoulder: tuple[Coordinate, Distance, Coordinate] = Field(
        description="right shoulder from the reference point, [x, y, z] in m, x forward, z down"
    )
    half_thickness: Distance = Field(
        description="distance of the leading edge and of the feather roots from the bones, m"
    )
    skin_mass: MassOrNone = Field(
        default=0.0,
        description="mass of skin and coverts of one wing, kg, shared over the segments by length "
        "times skin_chord",
    )

    @model_validator(mode="before")
    @classmethod
    def _root_is_of_the_shoulder(cls, data: Any) -> Any:
        if isinstance(data, Mapping) and "root" in data:
            raise problem("follows from the shoulder and the body's parts; leave it out", "root")
        return data


class Shaft(Part):
    """A bone or muscle: a round bar of uniform density along the segment, from its root."""

    name: Label = Field(description='name of the bone or muscle, such as "ulna"')
    mass: Mass = Field(description="mass of the bone or muscle, kg")
    length: Length | None = Field(
        default=None, description="length from the segment's root, m; by default the segment's"
    )
    radius: Distance = Field(default=0.0, description="radius of the bar, m")


class PointMass(Part):
    """A mass in one point of the segment, such as the bones of the wrist."""

    name: Label = Field(description='name of what has the mass, such as "wrist bones"')
    mass: Mass = Field(description="mass in the point, kg")
    position: Position = Field(
        default=1.0, description="place along the segment, 0 at its root to 1 at its end"
    )


class Plume(Part):
    """A feather with mass: a slender rod from its root, `half_thickness` behind the bone."""

    angles: ClassVar[tuple[str, ...]] = ("rest_angle",)

    name: Label = Field(description='name of the feather, such as "P9"')
    mass: Mass = Field(description="mass of the feather, calamus and vane, kg")
    length: Length = Field(description="length of the feather, calamus and vane, m")
    position: Position = Field(
        description="place of the root along the segment, 0 at its root to 1 at its end"
    )
    rest_angle: Angle = Field(
        default=0.0,
        description="angle outwards from straight aft of the segment; rad, degrees as "
        "rest_angle_deg",
    )


class MeasuredSegment(Part):
    """A segment of the wing, as the sum of what is in and on it."""

    length: Length | None = Field(
        default=None, description="length from joint to joint, m; or give its end"
    )
    end: Point | None = Field(
        default=None,
        description="where the segment ends in one pose of the wing, from the reference point, "
        "[x, y, z] in m; its length is the distance from the segment before it",
    )
    bones: tuple[Shaft, ...] = Field(default=(), description="list of bones")
    muscles: tuple[Shaft, ...] = Field(default=(), description="list of muscles")
    point_masses: tuple[PointMass, ...] = Field(default=(), description="list of point masses")
    feathers: tuple[Plume, ...] = Field(default=(), description="list of the feathers with mass")
    skin_chord: Distance = Field(
        default=0.0,
        description="chord of the strip of skin and coverts, from the leading edge backwards, m",
    )

    @model_validator(mode="after")
    def _has_one_length(self) -> Self:
        if self.length is not None and self.end is not None:
            raise problem("given twice, as length and end; keep one", "end")
        if self.length is None and self.end is None:
            raise problem("missing; it should give the length from joint to joint, m", "length")
        return self


class MeasuredSegments(RootModel[dict[str, MeasuredSegment]]):
    """The segments of a wing by name, from the shoulder outwards."""

    model_config = ConfigDict(frozen=True)


class Morphology(Part):
    """What is weighed and measured of a bird; other tables are as in a topology.

    Attributes:
        body: parts of the body.
        wing: place of the shoulder.
        segments: the wing's segments by name, from the shoulder outwards.
    """

    model_config = ConfigDict(extra="ignore")

    body: MeasuredBody = Field(description="body in parts, a table")
    wing: MeasuredWing = Field(description="shoulder and thickness of the wing, a table")
    segments: MeasuredSegments = Field(description="segments of the wing in parts, tables")

    @model_validator(mode="after")
    def _ends_follow_each_other(self) -> Self:
        for (inner, before), (name, segment) in pairwise(self.segments.root.items()):
            if segment.end is not None and before.end is None:
                raise problem(
                    f"there is no distance to measure, as {inner} has a length and no end",
                    f"segments.{name}.end",
                )
        for name, length in self.lengths.items():
            if not length > 0.0:
                raise problem(
                    "the segment has no length; it must end where none does before it",
                    f"segments.{name}.end",
                )
        return self

    @model_validator(mode="after")
    def _skin_has_an_area(self) -> Self:
        if self.wing.skin_mass and not any(s.skin_chord for s in self.segments.root.values()):
            raise problem(
                "no segment has a skin_chord that it could lie on; give one or more",
                "wing.skin_mass",
            )
        return self

    @property
    def lengths(self) -> dict[str, float]:
        """Lengths (m) of the segments, as given or between their ends."""
        found, start = {}, self.wing.shoulder
        for name, segment in self.segments.root.items():
            end = segment.end or start
            found[name] = segment.length or math.dist(start, end)
            start = end
        return found
