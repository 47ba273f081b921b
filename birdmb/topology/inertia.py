"""Inertia tensors as a topology file gives them, and what no body can have."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from functools import lru_cache
from typing import Annotated, Any, TypeAlias

import numpy as np
from pydantic import WithJsonSchema
from pydantic.config import JsonDict

from birdmb._typing import FloatArray
from birdmb.topology.messages import problem, shown
from birdmb.topology.numbers import LEAST_INERTIA, Moment

RigidBody: TypeAlias = "tuple[float, FloatArray, FloatArray]"
"""Mass (kg), centre of mass (3,) m, and inertia (3, 3) kg m2 about it."""

_Row = tuple[Moment, Moment, Moment]
_THREE: JsonDict = {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}
_FORMS: JsonDict = {"anyOf": [_THREE, {**_THREE, "items": _THREE}]}  # in a file
Tensor = Annotated[tuple[_Row, _Row, _Row], WithJsonSchema(_FORMS)]

_ROUND_OFF = 1e-9  # relative; inertia tensors are often typed with few digits


def from_diagonal(value: Any) -> Any:
    """The tensor of three moments about the axes; what is none of these as it is."""
    if not isinstance(value, list | tuple) or any(isinstance(row, list | tuple) for row in value):
        return value
    if len(value) != 3:
        raise problem(f"must be three moments or a 3x3 tensor, not {shown(value)}")
    return [[moment if i == j else 0.0 for j in range(3)] for i, moment in enumerate(value)]


def moments_by_key(value: Any) -> dict[str, Any]:
    """The body's moments of inertia by key, from three of them or a 3x3 tensor."""
    tensor = np.empty((0, 0))
    if isinstance(value, list | tuple) and len(value) == 3:
        rows = from_diagonal(value)
        with suppress(TypeError, ValueError):
            tensor = np.array(rows, dtype=float)
    if tensor.shape != (3, 3):
        raise problem(f"must be three moments or a 3x3 tensor, not {shown(value)}", "inertia")
    if tensor[0, 1] or tensor[1, 0] or tensor[1, 2] or tensor[2, 1] or tensor[0, 2] != tensor[2, 0]:
        raise problem(
            f"{shown(value)} is not that of a body with a plane of symmetry: of the elements off "
            "the diagonal only xz and zx, equal to each other, may differ from 0",
            "inertia",
        )
    return {
        "inertia_xx": rows[0][0],
        "inertia_yy": rows[1][1],
        "inertia_zz": rows[2][2],
        "inertia_xz": rows[0][2],
    }


def tell_of_tensor(schema: JsonDict) -> None:
    """Put into the JSON schema of a body that `inertia` may stand for its moments by key."""
    properties, required = schema["properties"], schema["required"]
    assert isinstance(properties, dict)
    assert isinstance(required, list)
    about = "all of the inertia tensor, kg m2: three moments about x, y, z or a 3x3 tensor"
    properties["inertia"] = {"description": about, **_FORMS}
    required.remove("inertia_yy")
    schema["oneOf"] = [{"required": ["inertia_yy"]}, {"required": ["inertia"]}]


# Of birds that are varied by the thousand, the same few tensors are checked again and again.
@lru_cache(maxsize=64)
def possible_inertia(inertia: Tensor) -> Tensor:
    """The tensor itself, if a body may have it; raises a validator's error otherwise."""
    tensor = np.array(inertia)
    round_off = _ROUND_OFF * np.abs(tensor).max()
    if np.abs(tensor - tensor.T).max() > round_off:
        raise problem(f"{shown(inertia)} is not symmetric; an inertia tensor must be")
    if 0 < np.abs(tensor).max() < LEAST_INERTIA:
        raise problem(
            f"{shown(inertia)} kg m2 is next to nothing; 0 makes the segment a point mass"
        )
    if why := impossible_moments(tensor):
        raise problem(why)
    return inertia


def impossible_moments(tensor: FloatArray) -> str:
    """Why no body has this inertia tensor (3, 3), kg m2; empty if one may."""
    round_off = _ROUND_OFF * np.abs(tensor).max()
    moments = np.linalg.eigvalsh(tensor)[::-1]
    listed = ", ".join(f"{moment:.6g}" for moment in moments)
    if moments[-1] < -round_off:
        return f"principal moments {listed} kg m2 must not be negative"
    if moments[0] > moments[1] + moments[2] + round_off:
        return (
            f"principal moments {listed} kg m2 break the triangle inequality (no body has them); "
            "each must be at most the sum of the other two"
        )
    return ""


def steiner(mass: float, r: FloatArray) -> FloatArray:
    """Inertia tensor (3, 3) kg m2 of a point mass at `r` (3,) m about the origin."""
    return mass * (float(r @ r) * np.eye(3) - np.outer(r, r))


def joined(bodies: Sequence[RigidBody]) -> RigidBody:
    """Several rigid bodies in one frame as one; one without mass has its centre at the origin."""
    mass = sum(own for own, _, _ in bodies)
    centre = np.zeros(3)
    if mass > 0.0:
        centre = np.sum([own * place for own, place, _ in bodies], axis=0) / mass
    about = [inertia + steiner(own, place - centre) for own, place, inertia in bodies]
    return mass, centre, np.sum(about, axis=0)
