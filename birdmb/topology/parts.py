"""The parts of a bird as a topology file gives them: immutable, validated, SI and radians.

Right wing; the left one is its mirror image. Body frame: x forward, y right, z down.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from birdmb._typing import FloatArray
from birdmb.errors import ImmutableError, no_attribute
from birdmb.summary import Fact, Summarised, brief
from birdmb.topology.inertia import moments_by_key, tell_of_tensor
from birdmb.topology.messages import problem, shown
from birdmb.topology.numbers import (
    Area,
    Coefficient,
    Density,
    Frequency,
    Inertia,
    Mass,
    Moment,
    Viscosity,
    Volume,
    WakePoints,
)

NO_DIRECTION = 1e-100  # of its square little is left
OF_PYDANTIC = {name for name in dir(BaseModel) if not name.startswith("__")}


class Part(Summarised, BaseModel):
    """A table of the topology file. Keys in `angles` may be given in degrees as `<key>_deg`."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    angles: ClassVar[tuple[str, ...]] = ()
    _table: ClassVar[str] = "..."  # dotted name of the table; dots where the part does not know it

    def __dir__(self) -> list[str]:
        """Names of the part's own, for completion: without those of pydantic's base class."""
        return [name for name in super().__dir__() if name not in OF_PYDANTIC]

    # Hidden from type checkers, which would else take any name for one of a part's.
    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Raise `UnknownNameError` for a name that the part has not."""
            if name.startswith("_"):
                return super().__getattr__(name)
            raise no_attribute(type(self).__name__, name, dir(self))

    def __setattr__(self, name: str, value: Any) -> None:
        """Raise `ImmutableError`."""
        raise ImmutableError(f"{self._unchangeable} {self._changed_by(name, shown(value))}")

    def __delattr__(self, name: str) -> None:
        """Raise `ImmutableError`."""
        raise ImmutableError(f"{self._unchangeable} {self._changed_by(name, 'VALUE')}")

    @property
    def _unchangeable(self) -> str:
        return "A bird and its parts are immutable; a variation is a new bird:"

    def _changed_by(self, key: str, value: str) -> str:
        return f'bird.with_values({{"{self._dotted(key)}": {value}}}).'

    def _dotted(self, key: str) -> str:
        """Dotted name of one of the part's values, as `Bird.with_values` takes it."""
        return f"{self._table.format(self=self)}.{key}"

    def __str__(self) -> str:
        """Return the same as for a console."""
        return repr(self)

    def _title(self) -> str:
        return str(getattr(self, "name", ""))

    def _summary(self) -> Iterable[Fact]:
        values = {key: value for key, value in self if key != "name" and value is not None}
        known = type(self).model_fields
        others = {key: value for key, value in values.items() if value != known[key].default}
        for key, value in (others or values).items():
            if key in self.angles and isinstance(value, float):
                yield Fact(key, f"{math.degrees(value):.6g}", "°")
            else:
                yield Fact(key, brief(value))

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

    _table: ClassVar[str] = "air"

    density: Density = Field(default=1.225, description="density of the air, kg/m3")
    kinematic_viscosity: Viscosity = Field(
        default=1.5e-5, description="viscosity over density, m2/s; friction of tail and body"
    )
    wake: Literal["quasi-steady", "unsteady"] = Field(
        default="quasi-steady",
        description='"unsteady": circulations lag behind the motion, and the air about the wing '
        "has inertia",
    )
    wake_points: WakePoints = Field(
        default=6, description="points along a wing at which lags of an unsteady wake are kept"
    )


class Gait(Part):
    """What all joint drivers have in common."""

    _table: ClassVar[str] = "gait"

    frequency: Frequency = Field(description="wingbeats per second, Hz")


class Body(Part):
    """The body without its wings."""

    _table: ClassVar[str] = "body"

    model_config = ConfigDict(json_schema_extra=tell_of_tensor)

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
