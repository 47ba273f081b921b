"""A bird whose masses follow from its morphology."""

from __future__ import annotations

from collections.abc import Iterator
from os import PathLike
from typing import Any

import numpy as np

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import TopologyError
from birdmb.morphology.parts import (
    BodyPart,
    MeasuredBody,
    MeasuredSegment,
    Morphology,
    Plume,
    Shaft,
)
from birdmb.morphology.solids import (
    MassProperties,
    combined,
    cylinder,
    ellipsoid,
    plate,
    point_mass,
    rod,
)
from birdmb.topology import Bird
from birdmb.topology.documents import read_document
from birdmb.topology.messages import validated

_DIGITS = 12  # significant; the rest is round-off, which a file need not show
_HOW_IT_FLAPS = ("gait", "joints")


@checked
def bird_from_morphology(path: str | PathLike[str], like: Bird | None = None) -> Bird:
    """Make the bird that a morphology file (TOML) describes.

    Masses, centres of mass and inertias of body and segments, the lengths of segments that are
    given by points, and the place of the shoulder are computed; the rest of the file is that of a
    topology.

    Args:
        path: the file; docs/morphology.md has its format.
        like: a bird whose gait and joints are taken where the file has none.

    Raises:
        TopologyError: the file cannot be read or does not describe a possible bird, in one
            sentence.
    """
    origin = str(path)
    _, document = read_document(path, "morphology")
    measured = validated(Morphology, document, origin)
    if like is not None:
        flapping = like.model_dump(exclude_unset=True, include=set(_HOW_IT_FLAPS))
        document = flapping | document
    body = combined(body_solids(measured.body))
    return validated(
        Bird,
        document
        | {
            "body": _others(document["body"], {"parts"}) | _body_table(body),
            "wing": _others(document["wing"], {"shoulder", "skin_mass"})
            | {"root": _root_table(measured, body)},
            "segments": _segment_tables(measured, origin),
        },
        origin,
    )


def body_solids(body: MeasuredBody) -> Iterator[MassProperties]:
    """The body's parts as solids, each behind the one before it where it has no place of its own.

    In m from the reference point, x forward and z down.
    """
    front = 0.0
    for part in body.parts:
        x = front - part.length / 2 if part.x is None else part.x
        yield _body_solid(part, np.array([x, 0.0, part.z]))
        front = x - part.length / 2


def segment_solids(
    segment: MeasuredSegment, length: float, half_thickness: float, skin_mass: float
) -> Iterator[MassProperties]:
    """What is in and on a segment of this length (m) as solids, in the segment's frame.

    `skin_mass` (kg) is the segment's part of the skin.
    """
    along = np.array([0.0, length, 0.0])
    for shaft in (*segment.bones, *segment.muscles):
        yield _shaft_solid(shaft, length)
    for point in segment.point_masses:
        yield point_mass(point.mass, point.position * along)
    if skin_mass:
        chord = np.array([-segment.skin_chord, 0.0, 0.0])
        leading = np.array([half_thickness, 0.0, 0.0])
        yield plate(skin_mass, leading + (along + chord) / 2, [along, chord])
    for feather in segment.feathers:
        yield _feather_solid(feather, length, half_thickness)


def skin_masses(measured: Morphology) -> dict[str, float]:
    """Masses (kg) of skin and coverts by segment, in proportion to length times chord."""
    lengths = measured.lengths
    areas = {name: lengths[name] * s.skin_chord for name, s in measured.segments.root.items()}
    whole = sum(areas.values())
    return {
        name: measured.wing.skin_mass * area / whole if whole else 0.0
        for name, area in areas.items()
    }


def _body_solid(part: BodyPart, centre: FloatArray) -> MassProperties:
    height = part.width if part.height is None else part.height
    length, width, depth = np.diag([part.length, part.width, height])
    if part.shape == "plate":
        return plate(part.mass, centre, [length, width])
    if part.shape == "cylinder":
        ends = centre + length / 2, centre - length / 2
        return cylinder(part.mass, *ends, [width / 2, depth / 2])
    return ellipsoid(part.mass, centre, [length / 2, width / 2, depth / 2])


def _shaft_solid(shaft: Shaft, length: float) -> MassProperties:
    end = [0.0, shaft.length or length, 0.0]
    across = [[shaft.radius, 0.0, 0.0], [0.0, 0.0, shaft.radius]]
    return cylinder(shaft.mass, np.zeros(3), end, across)


def _feather_solid(feather: Plume, length: float, half_thickness: float) -> MassProperties:
    root = np.array([-half_thickness, feather.position * length, 0.0])
    direction = np.array([-np.cos(feather.rest_angle), np.sin(feather.rest_angle), 0.0])
    return rod(feather.mass, root, root + feather.length * direction)


def _body_table(body: MassProperties) -> dict[str, float]:
    inertia = body.inertia
    return {
        "mass": _rounded(body.mass),
        "inertia_xx": _rounded(inertia[0, 0]),
        "inertia_yy": _rounded(inertia[1, 1]),
        "inertia_zz": _rounded(inertia[2, 2]),
        "inertia_xz": _rounded(inertia[0, 2]),
    }


def _root_table(measured: Morphology, body: MassProperties) -> dict[str, float]:
    place = np.array(measured.wing.shoulder) - body.centre
    return {axis: _rounded(value) for axis, value in zip("xyz", place, strict=True)}


def _segment_tables(measured: Morphology, origin: str) -> dict[str, Any]:
    tables: dict[str, Any] = {}
    skin = skin_masses(measured)
    for name, length in measured.lengths.items():
        segment = measured.segments.root[name]
        solids = list(segment_solids(segment, length, measured.wing.half_thickness, skin[name]))
        if not solids:
            raise TopologyError(
                f"{origin}: segments.{name}: nothing in it has a mass; give it bones, muscles, "
                "point_masses, feathers or a skin_chord"
            )
        whole = combined(solids)
        tables[name] = {
            "length": _rounded(length),
            "mass": _rounded(whole.mass),
            "inertia": [[_rounded(moment) for moment in row] for row in whole.inertia],
            "centre_of_mass": [_rounded(place) for place in whole.centre],
        }
    return tables


def _others(table: dict[str, Any], taken: set[str]) -> dict[str, Any]:
    return {key: value for key, value in table.items() if key not in taken}


def _rounded(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}") + 0.0  # no -0.0
