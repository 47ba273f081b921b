"""The numbers of a topology file, by what they measure, each with the range that it must be in.

The ranges hold all that flies, from 1e-9 kg and a span of 0.1 mm to 1e5 kg and a kilometre, in air,
water or on another planet, with a wide margin. They keep out what is surely a mistake, and what
overflows or vanishes where a few of these numbers are multiplied or divided. Zero is no small
number: where it is allowed, it means that there is nothing of the kind.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field, Strict
from pydantic_core import PydanticCustomError

OUT_OF_RANGE = "out_of_range"

_SIZES = "wings span 0.1 mm to 1 km"
_WEIGHTS = "birds weigh 1e-9 to 1e5 kg"


def _within(low: float, high: float, why: str, *, or_zero: bool = False) -> AfterValidator:
    """A check that a number is from `low` to `high`, or else 0 if that is allowed.

    `why` is a reason for the user, who gets a sentence from `birdmb.topology.messages`.
    """
    wanted = f"{'0 or ' if or_zero else ''}{low:g} to {high:g}"

    def check(value: float) -> float:
        if low <= value <= high or (or_zero and value == 0):
            return value
        raise PydanticCustomError(OUT_OF_RANGE, "{wanted}", {"wanted": wanted, "why": why})

    return AfterValidator(check)


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
Stiffness = Annotated[
    _NonNegative,
    _within(1e-40, 1e12, "a joint that hardly gives is prescribed", or_zero=True),
]
Fraction = Annotated[_Positive, Field(le=1), _within(1e-6, 1.0, "0.5 is a usual one")]
Gain = Annotated[_NonNegative, _within(1e-9, 1e3, "1 is the motion as given", or_zero=True)]
Phase = Annotated[_NonNegative, Field(lt=1), _within(1e-12, 1.0, "parts of a beat", or_zero=True)]
DownstrokeFraction = Annotated[
    Real, _within(0.3, 0.7, "beyond, the shorter stroke would be too abrupt; give samples instead")
]
Order = Annotated[int, Strict(), Field(ge=1), _within(1, 500, "periods in a beat")]
Elements = Annotated[
    int, Strict(), Field(ge=2), _within(2, 1024, "time grows with the cube of their number")
]
Direction = Annotated[Real, _within(-1e6, 1e6, "only the direction counts")]
