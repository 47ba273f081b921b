"""The feathers that span a wing, and the hinges some of them are on."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Self

from pydantic import (
    BeforeValidator,
    ConfigDict,
    Field,
    TypeAdapter,
    field_serializer,
    model_validator,
)

from birdmb.topology.messages import problem
from birdmb.topology.names import Label
from birdmb.topology.numbers import Angle, Length, Mass, Share, Stiffness, UnitInterval
from birdmb.topology.parts import Part

Shares = tuple[tuple[str, float], ...]

_ALONG_THE_BONE = 1e-6  # rad; a right angle in degrees is none to the last bit

_SHARES: TypeAdapter[dict[str, float]] = TypeAdapter(
    dict[str, Share], config=ConfigDict(allow_inf_nan=False)
)


def _pairs(shares: Any) -> Any:
    return shares if isinstance(shares, tuple) else tuple(_SHARES.validate_python(shares).items())


class Hinge(Part):
    """A spring and a damper about the bone's span axis, on which a feather is rooted.

    The hinge's angle phi turns the whole feather, leading edge up (the tip down) positive. It has
    no driver: its torque is -k (phi - phi_0) - C phi'.
    """

    angles: ClassVar[tuple[str, ...]] = ("rest",)

    stiffness: Stiffness = Field(description="stiffness of the hinge, N m/rad")
    damping: Stiffness = Field(description="damping of the hinge, N m s/rad")
    mass: Mass = Field(description="mass of the feather, spread evenly along it, kg")
    rest: Angle = Field(
        default=0.0,
        description="angle at which the spring is slack, leading edge up; rad, degrees as rest_deg",
    )


class Feather(Part):
    """A straight feather rooted on a bone, following that bone and shares of joint angles."""

    _table: ClassVar[str] = "feathers.{self.name}"

    angles: ClassVar[tuple[str, ...]] = ("rest_angle",)

    name: Label = Field(description='name of the feather, such as "1"', pattern=r"^[\w-]+$")
    bone: Label = Field(description="bone that the feather is rooted on")
    position: UnitInterval = Field(
        description="place of the root along the bone, 0 at its root to 1 at its end"
    )
    length: Length = Field(description="length of the feather, m")
    rest_angle: Angle = Field(
        default=0.0,
        description="angle outwards from straight aft; rad, degrees as rest_angle_deg",
    )
    shares: Annotated[Shares, BeforeValidator(_pairs)] = Field(
        default=(), description="shares of joint angles, each under the joint's name in quotes"
    )
    hinge: Hinge | None = Field(
        default=None, description="hinge of the feather, a table; rooted firmly if left out"
    )

    @field_serializer("shares")
    def _as_table(self, shares: Shares) -> dict[str, float]:
        return dict(shares)

    @model_validator(mode="after")
    def _hinge_can_turn_it(self) -> Self:
        if self.hinge and not self.shares and abs(math.cos(self.rest_angle)) < _ALONG_THE_BONE:
            raise problem(
                f"a feather at {math.degrees(self.rest_angle):.6g} degrees points along its bone, "
                "about which a hinge would turn it; it must be rooted firmly",
                "hinge",
            )
        return self

    @property
    def hinge_name(self) -> str:
        """Name of the hinge's angle among the states, and of its values."""
        return f"feathers.{self.name}.hinge"
