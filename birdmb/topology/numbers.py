"""The numbers of a topology file, by what they measure, each with the range that it must be in.

The ranges hold all that flies, from 1e-9 kg and a span of 0.1 mm to 1e5 kg and a kilometre, in air,
water or on another planet, with a wide margin. They keep out what is surely a mistake, and what
overflows or vanishes where a few of these numbers are multiplied or divided. Zero is no small
number: where it is allowed, it means that there is nothing of the kind.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler, Strict
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError
from pydantic_core.core_schema import no_info_after_validator_function

OUT_OF_RANGE = "out_of_range"

_SIZES = "wings span 0.1 mm to 1 km"
_WEIGHTS = "birds weigh 1e-9 to 1e5 kg"


@dataclass(frozen=True)
class _Range:
    """A check that a number is from `low` to `high`, or else 0 if that is allowed.

    `why` is a reason for the user, who gets a sentence from `birdmb.topology.messages`.
    """

    low: float
    high: float
    why: str
    or_zero: bool

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return no_info_after_validator_function(self._checked, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        number = handler(schema)
        kind: JsonSchemaValue = {"type": number["type"]}
        # A bound that is put on a range, Pydantic tells by its own name.
        lows = [number[key] for key in ("minimum", "ge") if key in number]
        highs = [number[key] for key in ("maximum", "le") if key in number]
        bounds = {"minimum": max([self.low, *lows]), "maximum": min([self.high, *highs])}
        return {**kind, "anyOf": [{"enum": [0]}, bounds]} if self.or_zero else {**kind, **bounds}

    def _checked(self, value: float) -> float:
        if self.low <= value <= self.high or (self.or_zero and value == 0):
            return value
        wanted = f"{'0 or ' if self.or_zero else ''}{self.low:g} to {self.high:g}"
        raise PydanticCustomError(OUT_OF_RANGE, "{wanted}", {"wanted": wanted, "why": self.why})


def _within(low: float, high: float, why: str, *, or_zero: bool = False) -> _Range:
    return _Range(low, high, why, or_zero)


# Strict: neither "4.0" nor true is a number.
Real = Annotated[float, Strict()]
_Positive = Annotated[Real, Field(gt=0)]
_NonNegative = Annotated[Real, Field(ge=0)]

Length = Annotated[_Positive, _within(1e-9, 1e4, _SIZES)]
Distance = Annotated[_NonNegative, _within(1e-9, 1e4, _SIZES, or_zero=True)]
Coordinate = Annotated[Real, _within(-1e4, 1e4, _SIZES)]
Area = Annotated[_Positive, _within(1e-18, 1e8, _SIZES)]
Volume = Annotated[_Positive, _within(1e-27, 1e12, _SIZES)]
Mass = Annotated[_Positive, _within(1e-20, 1e9, _WEIGHTS)]
MassOrNone = Annotated[_NonNegative, _within(1e-20, 1e9, _WEIGHTS, or_zero=True)]
LEAST_INERTIA = 1e-40
Inertia = Annotated[_Positive, _within(LEAST_INERTIA, 1e15, _WEIGHTS)]
Moment = Annotated[Real, _within(-1e15, 1e15, _WEIGHTS)]
Frequency = Annotated[
    _Positive, _within(1e-6, 1e6, "a mosquito beats its wings 800 times a second")
]
Angle = Annotated[Real, _within(-1e3, 1e3, "1000 rad are 159 turns")]
Share = Annotated[Real, _within(-1e3, 1e3, "a share of 1 is the whole angle")]
Density = Annotated[_NonNegative, _within(1e-9, 1e5, "air has 1.2 kg/m3, water 1000", or_zero=True)]
Viscosity = Annotated[_Positive, _within(1e-12, 1e6, "water has 1e-6 m2/s, honey 1e-2")]
Gravity = Annotated[_NonNegative, _within(1e-9, 1e4, "the sun has 274 m/s2", or_zero=True)]
Coefficient = Annotated[_NonNegative, _within(1e-9, 1e3, "a flat plate has 2", or_zero=True)]
LiftSlope = Annotated[_Positive, _within(1e-6, 1e3, "thin sections have 2 pi")]
LiftCoefficient = Annotated[Real, _within(-1e3, 1e3, "sections reach 1 to 2")]
MomentCoefficient = Annotated[Real, _within(-1e3, 1e3, "cambered sections have some -0.1")]
PolarAngle = Annotated[Real, _within(-math.pi, math.pi, "a polar goes once around")]
StallAngle = Annotated[_Positive, _within(1e-2, 1.5, "sections stall at 8 to 20 degrees")]
StallWidth = Annotated[_Positive, _within(1e-3, 1.5, "thin sections stall within 2 to 5 degrees")]
StallTime = Annotated[_Positive, _within(1e-2, 1e3, "4 chords is a usual one")]
Stiffness = Annotated[
    _NonNegative,
    _within(1e-40, 1e12, "a joint that hardly gives is prescribed", or_zero=True),
]
Fraction = Annotated[_Positive, Field(le=1), _within(1e-6, 1.0, "0.5 is a usual one")]
UnitInterval = Annotated[Real, Field(ge=0, le=1)]
Gain = Annotated[_NonNegative, _within(1e-9, 1e3, "1 is the motion as given", or_zero=True)]
Phase = Annotated[_NonNegative, Field(lt=1), _within(1e-12, 1.0, "parts of a beat", or_zero=True)]
DownstrokeFraction = Annotated[
    Real, _within(0.3, 0.7, "beyond, the shorter stroke would be too abrupt; give samples instead")
]
Order = Annotated[int, Strict(), Field(ge=1), _within(1, 500, "periods in a beat")]
Elements = Annotated[
    int, Strict(), Field(ge=2), _within(2, 1024, "time grows with the cube of their number")
]
WakePoints = Annotated[
    int, Strict(), Field(ge=4), _within(4, 1024, "a cubic spline leads through four points or more")
]
Direction = Annotated[Real, _within(-1e6, 1e6, "only the direction counts")]
