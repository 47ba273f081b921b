"""The parts of a bird as a topology file gives them: immutable, validated, SI and radians.

Right wing; the left one is its mirror image. Body frame: x forward, y right, z down. Segment frame,
bone straight out: the same directions, with y along the bone outwards.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    TypeAdapter,
    field_serializer,
    model_validator,
)
from pydantic_core import PydanticCustomError

from birdmb._typing import FloatArray
from birdmb.topology.inertia import Tensor, from_diagonal, moments_by_key, possible_inertia
from birdmb.topology.messages import BRANCH, problem, shown
from birdmb.topology.names import Label
from birdmb.topology.numbers import (
    Angle,
    Area,
    Coefficient,
    Coordinate,
    Density,
    Distance,
    Elements,
    Fraction,
    Frequency,
    Inertia,
    Length,
    Mass,
    MassOrNone,
    Moment,
    Real,
    Share,
    Stiffness,
    Viscosity,
    Volume,
)

Bone = Literal["humerus", "forearm", "hand"]
BONES: tuple[Bone, ...] = ("humerus", "forearm", "hand")  # from the shoulder outwards

Shares = tuple[tuple[str, float], ...]

NO_DIRECTION = 1e-100  # of its square little is left
_ALONG_THE_BONE = 1e-6  # rad; a right angle in degrees is none to the last bit


class Part(BaseModel):
    """A table of the topology file. Keys in `angles` may be given in degrees as `<key>_deg`."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    angles: ClassVar[tuple[str, ...]] = ()

    @model_validator(mode="before")
    @classmethod
    def _degrees_to_radians(cls, data: Any) -> Any:
        if not isinstance(data, Mapping):
            return data
        given = dict(data)
        for angle in cls.angles:
            in_degrees = f"{angle}_deg"
            if in_degrees not in given:
                continue
            if angle in given:
                raise problem(f"given twice, as {angle} and {in_degrees}; keep one", in_degrees)
            value = given.pop(in_degrees)
            given[angle] = (
                [_in_radians(each) for each in value]
                if isinstance(value, list | tuple)
                else _in_radians(value)
            )
        return given


def _in_radians(value: Any) -> Any:
    """An angle in degrees; what is no number stays, for the check of its field to complain."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    return math.radians(value) if isinstance(value, float) or abs(value) < 1e9 else value


class Air(Part):
    """The air the bird flies in."""

    density: Density = Field(default=1.225, description="density of the air, kg/m3")
    kinematic_viscosity: Viscosity = Field(
        default=1.5e-5, description="viscosity over density, m2/s; friction of tail and body"
    )


class Gait(Part):
    """What all joint drivers have in common."""

    frequency: Frequency = Field(description="wingbeats per second, Hz")


class Body(Part):
    """The body without its wings."""

    mass: Mass = Field(description="mass of the body without its wings, kg")
    inertia_yy: Inertia = Field(
        description="pitch moment of inertia about the body's centre of mass, kg m2"
    )
    inertia_xx: Inertia | None = Field(
        default=None, description="roll moment of inertia, kg m2; only motion in space needs it"
    )
    inertia_zz: Inertia | None = Field(
        default=None, description="yaw moment of inertia, kg m2; only motion in space needs it"
    )
    inertia_xz: Moment = Field(
        default=0.0,
        description="off-diagonal element of the inertia tensor, minus the product of inertia, "
        "kg m2",
    )
    side_area: Area | None = Field(
        default=None,
        description="area that the coefficient of the body's side force refers to, m2; without it "
        "there is none",
    )
    side_coefficient: Coefficient = Field(
        default=0.0, description="side force per sideslip angle, dynamic pressure and area, 1/rad"
    )
    volume: Volume | None = Field(
        default=None,
        description="volume of the body, m3, whose moment across the stream is that of a slender "
        "one; without it there is none",
    )

    @model_validator(mode="before")
    @classmethod
    def _from_tensor(cls, data: Any) -> Any:
        if not isinstance(data, Mapping) or "inertia" not in data:
            return data
        given = dict(data)
        tensor = given.pop("inertia")
        if "inertia_yy" in given:
            raise problem("given twice, as inertia and inertia_yy; keep one", "inertia")
        return given | moments_by_key(tensor)

    @property
    def missing_moments(self) -> tuple[str, ...]:
        """Names of the moments of inertia that are not given."""
        return tuple(n for n in ("inertia_xx", "inertia_zz") if getattr(self, n) is None)

    @property
    def inertia_tensor(self) -> FloatArray:
        """Inertia tensor (3, 3) about the centre of mass, kg m2; diagonal where not all is given.

        A moment that is not given is taken as that in pitch; planar motion does not depend on it.
        """
        xx = self.inertia_yy if self.inertia_xx is None else self.inertia_xx
        zz = self.inertia_yy if self.inertia_zz is None else self.inertia_zz
        xz = 0.0 if self.missing_moments else self.inertia_xz
        return np.array([[xx, 0.0, xz], [0.0, self.inertia_yy, 0.0], [xz, 0.0, zz]])


class Discretisation(Part):
    """How finely, and by which construction, the lifting line is computed."""

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

    x: Coordinate = Field(description="how far the shoulder is ahead of the centre of mass, m")
    y: Distance = Field(description="how far the shoulder is to the right, m")
    z: Coordinate = Field(default=0.0, description="how far the shoulder is below, m")


class Wing(Part):
    """Where the wing is attached, how thick it is and how finely it is computed."""

    root: Root = Field(description="position of the right shoulder, a table of x, y and z in m")
    half_thickness: Distance = Field(
        description="distance of the leading edge and of the feather roots from the bones, m"
    )
    discretisation: Annotated[
        Annotated[str, AfterValidator(_known_preset), Tag(f"{BRANCH}preset")]
        | Annotated[Elements, Tag(f"{BRANCH}elements")]
        | Annotated[Discretisation, Tag(f"{BRANCH}table")],
        Discriminator(
            _kind_of_discretisation, custom_error_type="choice", custom_error_message=_CHOICE
        ),
    ] = "converged"

    @property
    def resolved_discretisation(self) -> Discretisation:
        """The numbers behind `discretisation`; a mere number of elements is else as converged."""
        if isinstance(self.discretisation, Discretisation):
            return self.discretisation
        if isinstance(self.discretisation, str):
            return PRESETS[self.discretisation]
        return PRESETS["converged"].model_copy(update={"elements": self.discretisation})


class Segment(Part):
    """A rigid segment of the wing; zero inertia makes it a point mass."""

    length: Length = Field(description="length of the bone, m")
    mass: MassOrNone = Field(description="mass of the segment of one wing, kg")
    inertia: Annotated[Tensor, BeforeValidator(from_diagonal), AfterValidator(possible_inertia)] = (
        Field(
            description="inertia about the segment's centre of mass, kg m2: three moments about "
            "x, y, z or a 3x3 tensor"
        )
    )
    centre_of_mass: tuple[Coordinate, Coordinate, Coordinate] = Field(
        default_factory=lambda validated: (0.0, validated["length"] / 2, 0.0),
        description="centre of mass from the segment's root, [x, y, z] in m",
    )


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

    angles: ClassVar[tuple[str, ...]] = ("rest_angle",)

    name: Label = Field(description='name of the feather, such as "1"', pattern=r"^[\w-]+$")
    bone: Bone = Field(description="bone that the feather is rooted on")
    position: Annotated[Real, Field(ge=0, le=1)] = Field(
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

    @property
    def place(self) -> float:
        """Where along the wing the root is: 0 shoulder, 1 elbow, 2 wrist, 3 hand tip."""
        return BONES.index(self.bone) + self.position
