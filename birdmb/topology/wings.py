"""The wing's sections as data, where it is attached and how finely it is computed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from types import MappingProxyType
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from pydantic import (
    AfterValidator,
    Discriminator,
    Field,
    Tag,
    WithJsonSchema,
    model_validator,
)
from pydantic_core import PydanticCustomError

from birdmb.topology.messages import BRANCH, problem, shown
from birdmb.topology.names import Label
from birdmb.topology.numbers import (
    Angle,
    Coefficient,
    Coordinate,
    Distance,
    Elements,
    Fraction,
    LiftCoefficient,
    LiftSlope,
    MomentCoefficient,
    PolarAngle,
    StallAngle,
    StallTime,
    StallWidth,
)
from birdmb.topology.parts import Part

_LEAST_ANGLES = 4
_LIFT_APART = 0.03  # of a polar's lift coefficient from that of attached flow
_STALL_ANGLE = ("stall", "angle")


class Discretisation(Part):
    """How finely, and by which construction, the lifting line is computed."""

    _table: ClassVar[str] = "wing.discretisation"

    scheme: Literal["orthogonal", "one-step"] = Field(
        description="construction of the lifting line: orthogonal, or one-step as published"
    )
    elements: Elements = Field(description="elements per wing, 2 or more")
    rounding: Fraction = Field(
        description="rounding of the edges' corners, a fraction above 0 up to 1"
    )


# Whoever changes these numbers changes every fingerprint of a bird that uses them.
PRESETS: Mapping[str, Discretisation] = MappingProxyType(
    {
        "converged": Discretisation(scheme="orthogonal", elements=32, rounding=0.5),
        "published": Discretisation(scheme="one-step", elements=8, rounding=0.5),
    }
)

_CHOICE = (
    f"must be {' or '.join(map(shown, PRESETS))}, a whole number of elements per wing, "
    "or a table of scheme, elements and rounding"
)


def _known_preset(name: str) -> str:
    if name not in PRESETS:
        raise PydanticCustomError("choice", _CHOICE)
    return name


def _kind_of_discretisation(value: object) -> str | None:
    if isinstance(value, str):
        return f"{BRANCH}preset"
    if isinstance(value, int) and not isinstance(value, bool):
        return f"{BRANCH}elements"
    return f"{BRANCH}table" if isinstance(value, Mapping | Discretisation) else None


class Root(Part):
    """The right shoulder joint, from the body's centre of mass in the body frame."""

    _table: ClassVar[str] = "wing.root"

    x: Coordinate = Field(description="how far the shoulder is ahead of the centre of mass, m")
    y: Distance = Field(description="how far the shoulder is to the right, m")
    z: Coordinate = Field(default=0.0, description="how far the shoulder is below, m")


class Polar(Part):
    """Measured or computed steady coefficients of a section over the angle of attack.

    Lists of one entry an angle. Between angles the coefficients go smoothly and without overshoot;
    from more than 15 degrees beyond either end on they are those of a separated plate.
    """

    angles: ClassVar[tuple[str, ...]] = ("angle",)

    angle: tuple[PolarAngle, ...] = Field(
        description="angles of attack, ascending from -pi to pi at most; rad, degrees as angle_deg"
    )
    lift: tuple[LiftCoefficient, ...] = Field(description="lift coefficients")
    drag: tuple[Coefficient, ...] = Field(description="drag coefficients, friction included")
    moment: tuple[MomentCoefficient, ...] = Field(
        default=(),
        description="moments about the quarter chord, nose up positive; without them as of a plate",
    )

    @model_validator(mode="after")
    def _a_curve(self) -> Self:
        count = len(self.angle)
        if count < _LEAST_ANGLES:
            raise problem(f"{count} angles make no curve; give {_LEAST_ANGLES} or more", "angle")
        for i, (before, after) in enumerate(pairwise(self.angle)):
            if not before < after:
                raise problem("must ascend from angle to angle", "angle", i + 1)
        for key in ("lift", "drag", "moment"):
            given = len(getattr(self, key))
            if given != count and (given or key != "moment"):
                raise problem(f"{given} entries for {count} angles; give one for each", key)
        return self


class Stall(Part):
    """How the flow over a section separates; only in air whose `wake` is "unsteady".

    The share of the chord over which flow is attached is 1/2 at the stall angle and falls from 1 to
    0 over about twice the width on either side of it; with a polar, that is what tells it.
    """

    angles: ClassVar[tuple[str, ...]] = ("angle", "width")

    angle: StallAngle | None = Field(
        default=None,
        description="angle of attack beyond that of zero lift, of either sign, at which half of "
        "the chord is separated; left out with a polar; rad, degrees as angle_deg",
    )
    width: StallWidth = Field(
        default=math.radians(3.0),
        description="angle over which separation spreads; rad, degrees as width_deg",
    )
    time_constant: StallTime = Field(
        default=4.0, description="chords travelled in which separation follows, to 63 %"
    )
    normal_coefficient: Coefficient = Field(
        default=1.98,
        description="normal force of the separated section at 90 degrees; at others it goes with "
        "the sine of the angle",
    )


class Profile(Part):
    """What a wing section does to the air about it; a thin symmetric one by default.

    While flow is attached its circulation is half of chord times lift slope times speed times the
    angle of attack beyond that of zero lift, and its pitching moment about the quarter chord is the
    coefficient times dynamic pressure and chord squared, whatever the incidence. A polar or a stall
    angle tells what separation makes of these.
    """

    angles: ClassVar[tuple[str, ...]] = ("zero_lift_angle",)

    lift_slope: LiftSlope = Field(
        default=2.0 * math.pi, description="lift coefficient per angle of attack, 1/rad"
    )
    zero_lift_angle: Angle = Field(
        default=0.0,
        description="angle of attack without lift, negative of cambered sections; rad, degrees as "
        "zero_lift_angle_deg",
    )
    moment_coefficient: MomentCoefficient = Field(
        default=0.0, description="moment about the quarter chord, nose up positive"
    )
    polar: Polar | None = Field(
        default=None,
        description="steady lift, drag and moment over incidence, a table of lists; its drag is "
        "all that the section has",
    )
    stall: Stall | None = Field(
        default=None,
        description="how the flow separates, a table; without it and a polar it never does",
    )

    @model_validator(mode="after")
    def _polar_fits(self) -> Self:
        if self.polar is None:
            if self.stall is not None and self.stall.angle is None:
                raise problem(
                    "missing; without a polar it tells when flow separates", *_STALL_ANGLE
                )
            return self
        if self.stall is not None and self.stall.angle is not None:
            raise problem(
                "given beside a polar, which tells it; keep one of the two", *_STALL_ANGLE
            )
        self._refuse_other_lift(self.polar)
        return self

    def _refuse_other_lift(self, polar: Polar) -> None:
        """Raise where a polar's lift is not that of attached flow wherever flow is attached."""
        angle, lift = np.array(polar.angle), np.array(polar.lift)
        if not angle[0] < self.zero_lift_angle < angle[-1]:
            raise problem("must hold the zero_lift_angle within its range", "polar", "angle")
        at_zero = float(np.interp(self.zero_lift_angle, angle, lift))
        if abs(at_zero) > _LIFT_APART:
            raise problem(
                f"is {at_zero:.3g} at the zero_lift_angle of "
                f"{math.degrees(self.zero_lift_angle):.4g} degrees; give the profile the "
                "zero_lift_angle of its polar",
                *("polar", "lift"),
            )
        beyond = angle - self.zero_lift_angle
        attached = self.lift_slope * beyond
        above = np.abs(lift) - np.abs(attached)
        above[(lift * attached < 0.0) | (np.abs(beyond) > 0.5 * math.pi)] = 0.0
        worst = int(np.argmax(above))
        if above[worst] > _LIFT_APART:
            raise problem(
                f"is {lift[worst]:.4g} at {math.degrees(angle[worst]):.4g} degrees, above the "
                f"{attached[worst]:.4g} of attached flow; give the profile a lift_slope of "
                f"{lift[worst] / beyond[worst]:.4g} or more",
                *("polar", "lift"),
            )


class Wing(Part):
    """Where the wing is attached, how thick it is and how finely it is computed."""

    _table: ClassVar[str] = "wing"

    root: Root = Field(description="position of the right shoulder, a table of x, y and z in m")
    half_thickness: Distance = Field(
        default=0.0,
        description="distance of the leading edge and of the feather roots from the bones, m; a "
        "wing of sections has no use for it",
    )
    propatagium: Label | None = Field(
        default=None,
        description="segment to whose end the leading edge runs straight from the shoulder, as the "
        "skin before an elbow does; by default the second one of three or more, else the first",
    )
    profile: Profile = Field(
        default=Profile(), description="profile of all sections that have none of their own"
    )
    discretisation: Annotated[
        Annotated[
            str,
            AfterValidator(_known_preset),
            WithJsonSchema({"type": "string", "enum": [*PRESETS]}),
            Tag(f"{BRANCH}preset"),
        ]
        | Annotated[Elements, Tag(f"{BRANCH}elements")]
        | Annotated[Discretisation, Tag(f"{BRANCH}table")],
        Discriminator(
            _kind_of_discretisation, custom_error_type="choice", custom_error_message=_CHOICE
        ),
    ] = Field(default="converged", description="how finely the wing's loads are computed")

    @property
    def resolved_discretisation(self) -> Discretisation:
        """The numbers behind `discretisation`; a mere number of elements is else as converged."""
        if isinstance(self.discretisation, Discretisation):
            return self.discretisation
        if isinstance(self.discretisation, str):
            return PRESETS[self.discretisation]
        return PRESETS["converged"].model_copy(update={"elements": self.discretisation})
