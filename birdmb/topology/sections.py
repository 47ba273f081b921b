"""A wing's planform by sections along its bones, in place of feathers."""

from __future__ import annotations

from typing import ClassVar

from pydantic import Field

from birdmb.topology.names import Label
from birdmb.topology.numbers import Angle, Coordinate, Distance, UnitInterval
from birdmb.topology.parts import Part
from birdmb.topology.wings import Profile


class Section(Part):
    """A chord across a bone, rigidly fixed to it; the wing is spanned straight to the next one.

    Chords lie along the bone's x axis, turned by `twist` about the bone. Where the bone has joints
    that twist it, a section follows their part up to it; at a joint it stands midway between the
    directions of both bones.
    """

    _table: ClassVar[str] = "sections.{self.name}"

    angles: ClassVar[tuple[str, ...]] = ("twist",)

    name: Label = Field(description='name of the section, such as "tip"', pattern=r"^[\w-]+$")
    bone: Label = Field(description="bone that the section is fixed to")
    position: UnitInterval = Field(
        description="place along the bone, 0 at its root to 1 at its end"
    )
    chord: Distance = Field(
        description="length of the chord, m; 0 at the wing's tip alone, which is then pointed"
    )
    offset: Coordinate = Field(
        default=0.0, description="how far the quarter chord is ahead of the bone, m"
    )
    twist: Angle = Field(
        default=0.0,
        description="angle of the chord to the bone's x axis, leading edge up; rad, degrees as "
        "twist_deg",
    )
    profile: Profile | None = Field(
        default=None,
        description="profile of the section, a table of its own, in which what is left out is thin "
        "and symmetric; without it that of the wing",
    )
