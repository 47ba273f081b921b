"""What of a bird meets the air besides its lifting line: the tail, and the drags."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Literal

from pydantic import Field, StrictBool, field_validator

from birdmb.topology.messages import problem
from birdmb.topology.numbers import Angle, Area, Coefficient, Coordinate, Length
from birdmb.topology.parts import Part


class Apex(Part):
    """The foremost point of the tail, from the body's centre of mass in the body frame."""

    _table: ClassVar[str] = "tail.apex"

    x: Coordinate = Field(
        description="how far the tail's apex is ahead of the centre of mass (negative: behind), m"
    )
    z: Coordinate = Field(default=0.0, description="how far it is below, m")


class Tail(Part):
    """A flat isosceles triangle that opens backwards from its apex, fixed to the body."""

    _table: ClassVar[str] = "tail"

    angles: ClassVar[tuple[str, ...]] = ("opening", "incidence")

    apex: Apex = Field(description="the tail's foremost point, a table of x and z in m")
    chord: Length = Field(description="length from the apex to the trailing edge, m")
    opening: Annotated[Angle, Field(ge=0)] = Field(
        description="angle between its two sides, 0 if furled; rad, degrees as opening_deg"
    )
    incidence: Angle = Field(
        default=0.0,
        description="angle to the body's x axis, leading edge up; rad, degrees as incidence_deg",
    )
    downwash: Literal["wake", "wake and bound", "none"] = Field(
        default="wake",
        description="what of the wings' vortices the tail feels: their whole wake, their wake and "
        "bound vortices, or none",
    )

    @field_validator("opening")
    @classmethod
    def _less_than_half_a_turn(cls, opening: float) -> float:
        if opening >= math.pi:
            raise problem(f"{math.degrees(opening):.6g} degrees is no triangle; stay below 180")
        return opening

    @property
    def span(self) -> float:
        """Width of the trailing edge, m."""
        return 2.0 * self.chord * math.tan(self.opening / 2.0)


class Drag(Part):
    """Drag that the lifting line does not have; none unless it is asked for."""

    _table: ClassVar[str] = "drag"

    profile_coefficient: Coefficient = Field(
        default=0.0, description="drag coefficient of the wing's sections, on their chord"
    )
    body: StrictBool = Field(default=False, description="whether the body has drag")
    frontal_area: Area | None = Field(
        default=None,
        description="area that the body's drag coefficient refers to, m2; by default 0.00813 times "
        "the body's mass to the power of 2/3",
    )
    body_coefficient: Coefficient | None = Field(
        default=None,
        description="drag coefficient of the body; by default Maybury's, which falls with speed",
    )
