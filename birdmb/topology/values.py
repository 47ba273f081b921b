"""Dotted names: one way to read and to vary every value of a bird, in files, Python and studies."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from birdmb.errors import TopologyError
from birdmb.text import nearest
from birdmb.topology.attachments import Attachment
from birdmb.topology.drivers import Harmonic
from birdmb.topology.joints import SIDES, Joint, JointSide
from birdmb.topology.messages import Location, shown
from birdmb.topology.parts import Part
from birdmb.topology.segments import Segments
from birdmb.topology.wings import Wing

_RESOLUTION = "wing.discretisation"
_LIKE_THE_JOINT = JointSide()


def parse_assignment(text: str) -> tuple[str, Any]:
    """Split `"shoulder.flap.stiffness=20"` into a dotted name and a value.

    The value is read as TOML; what is not TOML is a text, so that `wing.discretisation=published`
    needs no quotes. Raises `TopologyError` where the name, the `=` or the value is missing.
    """
    name, equals, value = (part.strip() for part in text.partition("="))
    if not (name and equals and value):
        raise TopologyError(f"{shown(text)} must read NAME=VALUE, for instance body.mass=1.3")
    try:
        document = tomllib.loads(f"value = {value}")
    except (ValueError, RecursionError):  # the latter of a thousand brackets
        return name, value
    if len(document) > 1:
        raise TopologyError(
            f"{shown(text)} must read NAME=VALUE; what follows on another line needs a --set of "
            "its own"
        )
    return name, document["value"]


def named_places(bird: Part) -> dict[str, Location]:
    """Every dotted name of a bird with the place of its value in the bird's document.

    The document is what `model_dump` returns: tables within tables.
    """
    return dict(_walk(bird, "", ()))


def _walk(part: Part, prefix: str, place: Location) -> Iterator[tuple[str, Location]]:
    fields = type(part).model_fields
    for key in fields:
        child, here, name = getattr(part, key), (*place, key), f"{prefix}{key}"
        if named := _named_parts(name, child):
            if key == "harmonics":
                yield name, here
            for label, where, item in named:
                yield from _walk(item, f"{label}.", (*here, where))
        elif key == "discretisation" and isinstance(part, Wing):
            yield name, here
            yield from _walk(part.resolved_discretisation, f"{name}.", here)
        elif key in SIDES and isinstance(part, Joint):
            yield name, here
            yield from _walk(child or _LIKE_THE_JOINT, f"{name}.", here)
        elif isinstance(child, Part):
            if fields[key].default is None:  # may be taken off as a whole
                yield name, here
            yield from _walk(child, f"{name}.", here)
        elif key == "position" and isinstance(part, Attachment):
            yield name, here
            yield from ((f"{name}.{axis}", (*here, i)) for i, axis in enumerate("xyz"))
        # What names lead to, as a joint or a harmonic, is not renamed.
        elif key not in ("name", "order") or not place:
            yield name, here
        if key in part.angles:
            yield f"{name}_deg", (*place, f"{key}_deg")
        if key == "shares":
            yield from ((f"{name}.{joint}", (*here, joint)) for joint, _ in child)


def _named_parts(name: str, child: object) -> list[tuple[str, str | int, Part]]:
    """The parts in a table or list of them, each with its dotted name and its place there."""
    if isinstance(child, Segments):
        return [(f"{name}.{label}", label, segment) for label, segment in child.items()]
    if not (isinstance(child, tuple) and child and isinstance(child[0], Part)):
        return []
    found: list[tuple[str, str | int, Part]] = []
    for i, item in enumerate(child):
        if isinstance(item, Joint):
            label = item.name
        elif isinstance(item, Harmonic):
            label = f"{name}.{item.order}"
        else:
            label = f"{name}.{item.name}"
        found.append((label, i, item))
    return found


def place_of(name: str, known: Mapping[str, Location], owner: str) -> Location:
    """The place of a dotted name among those `known`; `owner` is whose they are, for the error.

    Raises:
        TopologyError: there is no such name.
    """
    if name not in known:
        # Names of one side are too like those of the joint to be told apart by their letters.
        asked = any(part in SIDES for part in name.split("."))
        near = [k for k, place in known.items() if asked or not of_a_side(place)]
        raise TopologyError(
            f"{owner}: no value is called {shown(name)}; the nearest: {nearest(name, near)}"
        )
    return known[name]


def value_at(document: Mapping[str, Any], place: Location) -> Any:
    """The value at a place of a document; an angle also in the unit that is not written.

    One side of a joint has the joint's own value where it has none by itself; what a joint leaves
    out of the document is as by default.
    """
    *parents, key = place
    table: Any = document
    for part in parents:
        table = {**table, **table.get(part, {})} if part in SIDES else table[part]
    if isinstance(key, int) or key in table:
        return table[key]
    other = _other_unit(key)
    if other in table:
        return _in_degrees(table[other])
    return Joint.model_fields[str(key).removesuffix("_deg")].default


def _in_degrees(angle: Any) -> Any:
    if isinstance(angle, list | tuple):
        return tuple(map(math.degrees, angle))
    return None if angle is None else math.degrees(angle)


def of_a_side(place: Location) -> bool:
    """Whether a place in a bird's document is of one side of a joint."""
    return place[0] == "joints" and len(place) > 2 and place[2] in SIDES


def put_values(
    document: dict[str, Any],
    values: Mapping[str, Any],
    known: Mapping[str, Location],
    owner: str,
) -> None:
    """Put other values into a bird's document, under the dotted names `known`.

    In place of tables may stand parts of a bird; those that change become tables.

    Raises:
        TopologyError: a name is unknown, or set as a whole and in parts; `owner` is whose.
    """
    for whole in values:
        if any(name.startswith(f"{whole}.") for name in values):
            raise TopologyError(
                f"{owner}: {whole} is set as a whole and in parts; keep one of the two"
            )
    changes = []
    for name, value in values.items():
        *parents, key = place_of(name, known, owner)
        table: Any = document
        for part in parents:
            inside = table[part] if isinstance(part, int) else table.setdefault(part, {})
            table[part] = inside = _open_to_change(inside)
            table = inside
        if isinstance(key, str):
            table.pop(_other_unit(key), None)
        changes.append((table, key, value))
    for table, key, value in changes:
        table[key] = value.tolist() if isinstance(value, np.ndarray | np.generic) else value
    for joint in document["joints"]:
        if not isinstance(joint, Joint):  # of which nothing is given
            _free_if_sprung(joint, values)


def _open_to_change(inside: Any) -> Any:
    """A part as a table without its defaults, several parts or numbers as such; else itself."""
    if isinstance(inside, Segments):
        return dict(inside.items())
    if isinstance(inside, Part):
        return inside.model_dump(exclude_unset=True)
    return list(inside) if isinstance(inside, tuple) else inside


def is_resolution(name: str) -> bool:
    """Whether a dotted name is of a number that the discretisation's preset stands for."""
    return name.startswith(f"{_RESOLUTION}.")


def _free_if_sprung(joint: dict[str, Any], values: Mapping[str, Any]) -> None:
    """Make a joint compliant that was given a spring or a damper, unless its mode was given too."""
    name = joint["name"]
    given = {
        key
        for key in ("stiffness", "damping")
        for owner in (name, *(f"{name}.{side}" for side in SIDES))
        if values.get(f"{owner}.{key}") is not None
    }
    if given and f"{joint['name']}.mode" not in values:
        joint["mode"] = "compliant"
    if "stiffness" in given and joint.get("damping") is None:
        joint["damping"] = 0.0


def _other_unit(key: str | int) -> str:
    """The key of the same angle in the other unit."""
    key = str(key)
    return key.removesuffix("_deg") if key.endswith("_deg") else f"{key}_deg"
