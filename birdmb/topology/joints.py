"""The joints of the wings as a topology file gives them, and what one side has for itself."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, ClassVar, Literal, Self

from pydantic import (
    ConfigDict,
    Field,
    SerializerFunctionWrapHandler,
    StrictBool,
    field_validator,
    model_serializer,
    model_validator,
)
from pydantic.config import JsonDict

from birdmb.topology.drivers import (
    Count,
    Driver,
    DriverKeys,
    Harmonics,
    SamplePhases,
    Samples,
    contradictions,
    driver_of,
)
from birdmb.topology.messages import problem, shown
from birdmb.topology.names import Label
from birdmb.topology.numbers import Angle, Direction, DownstrokeFraction, Gain, Stiffness
from birdmb.topology.parts import NO_DIRECTION, Part
from birdmb.topology.samples import DriverFit

Side = Literal["right", "left"]
SIDES: tuple[Side, Side] = ("right", "left")
_OF_BOTH_SIDES = ("name", "segment", "axis", "mode", "twist")
_OF_THE_SPRING = ("stiffness", "damping", "cubic_stiffness", "stiffness_below")
_ANGLES = ("offset", "amplitude", "phase", "samples")
# Left out of a document where they are as by default: most joints have none of them.
_SELDOM_GIVEN = (
    *("gain", "harmonics", "downstroke_fraction"),
    *("samples", "sample_phases", "sample_harmonics"),
)


def split_side(name: str) -> tuple[str, str]:
    """Return a name without the side it ends in, and that side; "" where it names none.

    The joint `"shoulder.left"` ends in none: a side stands behind the name of a joint.
    """
    owner, _, side = name.rpartition(".")
    return (owner, side) if side in SIDES and "." in owner else (name, "")


def _tell_of_file(schema: JsonDict) -> None:
    """Put into a JSON schema that a file may give the samples."""
    properties = schema["properties"]
    assert isinstance(properties, dict)
    about = "CSV file of the samples, from the topology file's folder, in place of samples"
    properties["file"] = {"type": "string", "description": about}


def _without_file(data: Any) -> Any:
    if isinstance(data, Mapping) and "file" in data:
        raise problem(
            "is a key of topology files, which load_bird reads; give samples instead", "file"
        )
    return data


class JointSide(Part):
    """Driver, spring and damper of a joint on one side, where they are not those of both.

    What is left out is as the joint itself says.
    """

    model_config = ConfigDict(json_schema_extra=_tell_of_file)
    angles: ClassVar[tuple[str, ...]] = _ANGLES

    stiffness: Stiffness | None = Field(default=None, description="stiffness there, N m/rad")
    damping: Stiffness | None = Field(default=None, description="damping there, N m s/rad")
    cubic_stiffness: Stiffness | None = Field(
        default=None, description="stiffening with the cube of the deflection there, N m/rad^3"
    )
    stiffness_below: Stiffness | None = Field(
        default=None, description="stiffness there where the joint is below its driver, N m/rad"
    )
    offset: Angle | None = Field(
        default=None, description="mean angle there; rad, degrees as offset_deg"
    )
    amplitude: Angle | None = Field(
        default=None, description="amplitude there; rad, degrees as amplitude_deg"
    )
    phase: Angle | None = Field(
        default=None, description="phase at t = 0 there; rad, degrees as phase_deg"
    )
    gain: Gain | None = Field(default=None, description="factor on the motion there")
    harmonics: Harmonics | None = Field(
        default=None, description="higher harmonics there, a list of tables"
    )
    downstroke_fraction: DownstrokeFraction | None = Field(
        default=None, description="part of the beat that the downstroke takes there"
    )
    samples: Samples | None = Field(
        default=None, description="angles over a beat there; rad, degrees as samples_deg"
    )
    sample_phases: SamplePhases | None = Field(
        default=None, description="phases of the samples there, parts of a beat"
    )
    sample_harmonics: Count | None = Field(
        default=None, description="how many harmonics follow the samples there"
    )

    @model_validator(mode="before")
    @classmethod
    def _leaves_the_shape_to_the_joint(cls, data: Any) -> Any:
        for key in _OF_BOTH_SIDES:
            if isinstance(data, Mapping) and key in data:
                raise problem(
                    f"{key} is the same on both sides; give it to the joint itself, "
                    "beside left and right",
                    key,
                )
        return _without_file(data)

    @property
    def own(self) -> dict[str, Any]:
        """The values that are given."""
        return {key: value for key, value in self if value is not None}


class Joint(Part):
    """A one-axis joint at the root of the segment it carries, one in each wing.

    The driver is q_d(t) = offset + amplitude sin(2 pi f t + phase), with `harmonics` besides, or
    with a downstroke of another duration than the upstroke, or offset and a Fourier series through
    samples; `gain` multiplies all but its mean (docs/model.md). A prescribed joint follows it
    exactly, a compliant one through a spring and a damper in series with it, whose torque is
    -k (q - q_d) - k_3 (q - q_d)^3 - C (q' - q_d'), k another one below the driver if so given.
    Driver, spring and damper may be others on one side. The sense of rotation is mirrored.
    """

    _table: ClassVar[str] = "{self.name}"

    model_config = ConfigDict(json_schema_extra=_tell_of_file)
    angles: ClassVar[tuple[str, ...]] = _ANGLES

    name: Label = Field(description='name of the joint, "place.motion" such as "shoulder.flap"')
    segment: Label = Field(description="segment that the joint carries")
    axis: tuple[Direction, Direction, Direction] = Field(
        description="direction of the axis, [x, y, z] in the parent's frame"
    )
    mode: Literal["prescribed", "compliant"] = Field(
        default="prescribed", description="whether the joint follows its driver or a spring"
    )
    stiffness: Stiffness | None = Field(default=None, description="joint stiffness, N m/rad")
    damping: Stiffness | None = Field(default=None, description="joint damping, N m s/rad")
    cubic_stiffness: Stiffness = Field(
        default=0.0, description="stiffening with the cube of the deflection, N m/rad^3"
    )
    stiffness_below: Stiffness | None = Field(
        default=None,
        description="stiffness where the joint is below its driver, N m/rad, if another than above",
    )
    offset: Angle = Field(
        default=0.0, description="mean angle, added to samples; rad, degrees as offset_deg"
    )
    amplitude: Angle = Field(default=0.0, description="amplitude; rad, degrees as amplitude_deg")
    phase: Angle = Field(default=0.0, description="phase at t = 0; rad, degrees as phase_deg")
    gain: Gain = Field(default=1.0, description="factor on the driver's motion about its mean")
    harmonics: Harmonics = Field(
        default=(), description="higher harmonics of the driver, a list of tables"
    )
    downstroke_fraction: DownstrokeFraction | None = Field(
        default=None,
        description="part of the beat from the largest angle to the smallest, 0.5 if left out",
    )
    samples: Samples | None = Field(
        default=None,
        description="angles over a beat from t = 0, its end excluded; rad, degrees as samples_deg",
    )
    sample_phases: SamplePhases | None = Field(
        default=None, description="phases of the samples, parts of a beat; even if left out"
    )
    sample_harmonics: Count | None = Field(
        default=None,
        description="how many harmonics follow the samples; if left out, as few as leave 0.1 % of "
        "their range",
    )
    twist: StrictBool = Field(
        default=False, description="whether the angle grows along the segment from none at its root"
    )
    right: JointSide | None = Field(
        default=None, description="values of the right wing's joint alone, a table"
    )
    left: JointSide | None = Field(
        default=None, description="values of the left wing's joint alone, a table"
    )

    @model_validator(mode="before")
    @classmethod
    def _samples_are_read(cls, data: Any) -> Any:
        return _without_file(data)

    @model_serializer(mode="wrap")
    def _without_empty(self, dump: SerializerFunctionWrapHandler) -> dict[str, Any]:
        table: dict[str, Any] = dump(self)
        known = type(self).model_fields
        for key in _SELDOM_GIVEN:
            if getattr(self, key) == known[key].default:
                table.pop(key, None)
        # A side that is given no value is as none.
        for side in SIDES:
            if side in table:
                given = table.pop(side) or {}
                if own := {key: value for key, value in given.items() if value is not None}:
                    table[side] = own
        return table

    @property
    def driver(self) -> Driver:
        """The motion of the driver, that of one side by `on`."""
        return driver_of(self._driver_keys)

    @property
    def driver_fit(self) -> DriverFit | None:
        """How closely the driver follows the samples that it was given by, if it was."""
        return self.driver.fit

    @property
    def _driver_keys(self) -> DriverKeys:
        return DriverKeys(
            self.offset,
            self.amplitude,
            self.phase,
            self.gain,
            self.harmonics,
            self.downstroke_fraction,
            self.samples,
            self.sample_phases,
            self.sample_harmonics,
        )

    @property
    def is_symmetric(self) -> bool:
        """Whether both sides have the same values."""
        return not (self.right or self.left) or self.on("right") == self.on("left")

    def on(self, side: Side) -> Joint:
        """The joint with the values of one side on both."""
        own: JointSide | None = getattr(self, side)
        return self.model_copy(update={**(own.own if own else {}), "right": None, "left": None})

    @field_validator("name")
    @classmethod
    def _place_and_motion(cls, name: str) -> str:
        place, dot, motion = name.partition(".")
        if not (
            dot and all(p.replace("_", "").replace("-", "").isalnum() for p in (place, motion))
        ):
            raise problem(f'must read "<place>.<motion>", such as "wrist.sweep", not {shown(name)}')
        return name

    @field_validator("axis")
    @classmethod
    def _unit_axis(cls, axis: tuple[float, float, float]) -> tuple[float, float, float]:
        length = math.hypot(*axis)
        if length < NO_DIRECTION:
            given = ", ".join(f"{component:g}" for component in axis)
            raise problem(f"[{given}] has no direction; for instance [0, 1, 0] is outwards")
        if abs(length - 1) < 1e-12:  # so that an axis read back stays the same to the last bit
            return axis
        x, y, z = (component / length for component in axis)
        return x, y, z

    @model_validator(mode="after")
    def _springs_of_sides_are_used(self) -> Self:
        for side in SIDES if self.mode == "prescribed" else ():
            own: JointSide | None = getattr(self, side)
            for key in _OF_THE_SPRING if own else ():
                if own and getattr(own, key) not in (None, getattr(self, key)):
                    raise problem(
                        "a prescribed joint follows its driver whatever its spring; leave it out, "
                        'or give the joint mode = "compliant"',
                        f"{side}.{key}",
                    )
        return self

    @model_validator(mode="after")
    def _driver_is_one_motion(self) -> Self:
        for key, why in contradictions(self._driver_keys):
            raise problem(why, key)
        for side in SIDES:
            own: JointSide | None = getattr(self, side)
            for key, why in contradictions(self.on(side)._driver_keys) if own else ():
                raise problem(why, f"{side}.{key}")
        return self

    @model_validator(mode="after")
    def _compliance_is_complete(self) -> Self:
        for key in ("stiffness", "damping"):
            if self.mode == "compliant" and any(
                getattr(self.on(side), key) is None for side in SIDES
            ):
                raise problem(f"missing; a compliant joint needs a {key} of 0 or more", key)
        return self
