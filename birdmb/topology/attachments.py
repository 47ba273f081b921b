"""Further rigid bodies on the body or on the wings' segments: a head, feet, a payload, motors."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field

from birdmb._typing import FloatArray
from birdmb.topology.inertia import RigidBody, Tensor, from_diagonal, joined, possible_inertia
from birdmb.topology.names import Label
from birdmb.topology.numbers import Coordinate, Mass
from birdmb.topology.parts import Body, Part
from birdmb.topology.segments import Segment

BODY = "body"


class Attachment(Part):
    """A rigid body that is fixed to the body, or to a segment of each wing.

    On the body and beside its plane of symmetry there is one on each side.
    """

    _table: ClassVar[str] = "attachments.{self.name}"

    name: Label = Field(description='name of the body, such as "head"', pattern=r"^[\w-]+$")
    on: Label = Field(description='what it is fixed to: "body" or a segment')
    mass: Mass = Field(description="mass of one, kg")
    position: tuple[Coordinate, Coordinate, Coordinate] = Field(
        description="its centre of mass, [x, y, z] in m: from the centre of mass that the body has "
        "by itself, in the body frame, or from the segment's root, in the segment's frame"
    )
    inertia: Annotated[Tensor, BeforeValidator(from_diagonal), AfterValidator(possible_inertia)] = (
        Field(
            default=((0.0,) * 3,) * 3,
            description="inertia about its centre of mass, kg m2: three moments about x, y, z or a "
            "3x3 tensor; a point mass by default",
        )
    )

    @property
    def copies(self) -> int:
        """How many there are on the body, or in each wing."""
        return 2 if self.on == BODY and self.position[1] != 0.0 else 1


def _joined(
    mass: float, centre: FloatArray, inertia: FloatArray, attached: list[Attachment]
) -> RigidBody:
    """A body with what is attached to it."""
    parts = [(mass, centre, inertia)]
    for one in attached:
        place, own = np.array(one.position), np.array(one.inertia)
        parts.append((one.mass, place, own))
        if one.copies == 2:
            mirror = np.diag([1.0, -1.0, 1.0])
            parts.append((one.mass, mirror @ place, mirror @ own @ mirror))
    return joined(parts)


def segment_with(segment: Segment, attached: list[Attachment]) -> Segment:
    """A segment with what is attached to it, as one rigid body."""
    mass, centre, inertia = _joined(
        segment.mass, np.array(segment.centre_of_mass), np.array(segment.inertia), attached
    )
    whole = {"mass": mass, "centre_of_mass": centre.tolist(), "inertia": inertia.tolist()}
    return Segment.model_validate(segment.model_dump() | whole)


def body_with(body: Body, attached: list[Attachment]) -> tuple[Body, FloatArray]:
    """A body with what is attached to it, as one, and how far (3,) m its centre of mass moved.

    Moments of inertia that the body leaves out stay out.
    """
    mass, centre, inertia = _joined(body.mass, np.zeros(3), body.inertia_tensor, attached)
    whole: dict[str, Any] = {"mass": mass, "inertia_yy": float(inertia[1, 1])}
    if not body.missing_moments:
        whole |= {
            "inertia_xx": float(inertia[0, 0]),
            "inertia_zz": float(inertia[2, 2]),
            "inertia_xz": float(inertia[0, 2]),
        }
    return body.model_copy(update=whole), centre
