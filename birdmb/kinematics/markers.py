"""Where on the bird markers are, and where they are at given joint angles."""

from __future__ import annotations

import tomllib
from collections.abc import Collection, Iterable, Mapping
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import Array, FloatArray, IntArray
from birdmb.kinematics.errors import KinematicsError
from birdmb.text import nearest
from birdmb.topology import Bird
from birdmb.topology.messages import shown
from birdmb.wing.arrays import WingArrays
from birdmb.wing.chain import joint_chain
from birdmb.wing.edges import trailing_edge

Places: TypeAlias = Mapping[str, Mapping[str, Any]]

SHOULDER = "shoulder"
_OF_THREE = ("elbow", "wrist", "hand_tip")


class Markers(NamedTuple):
    """M markers: on a bone, at the tip of a feather, or fixed to the body."""

    names: tuple[str, ...]
    bone: IntArray  # (M,) -1: none
    position: FloatArray  # (M,) along the bone, 0 at its root, 1 at its end
    feather: IntArray  # (M,) -1: none
    fixed: FloatArray  # (M, 3) m from the shoulder in body axes, of those on neither

    @property
    def on_body(self) -> Array:
        """Which (M,) are fixed to the body; the shoulder is no place on it of its own."""
        return np.asarray((self.bone < 0) & (self.feather < 0))


def place_markers(names: Iterable[str], bird: Bird, places: Places, origin: str) -> Markers:
    """Find the places of markers by their names.

    Args:
        names: the markers of the file.
        bird: an assembled bird.
        places: of markers whose names do not tell it, see `read_places`.
        origin: the file, for sentences.

    Raises:
        KinematicsError: a marker's place is not known or is none of the bird.
    """
    names = tuple(names)
    known = {**_by_default(bird), **places}
    if unknown := [name for name in places if name not in names]:
        raise KinematicsError(
            f"{origin}: has no marker {shown(unknown[0])}, of which --markers tells the place; the "
            f"nearest: {nearest(unknown[0], names)}."
        )
    count = len(names)
    bone, feather = np.full(count, -1), np.full(count, -1)
    position, fixed = np.zeros(count), np.zeros((count, 3))
    for i, name in enumerate(names):
        if name not in known:
            raise KinematicsError(
                f"{origin}: the place of the marker {shown(name)} is not known; name it "
                f"{nearest(name, known)}, or tell its place by --markers."
            )
        place = known[name]
        kind = set(place)
        if kind in ({"segment"}, {"segment", "position"}):
            bone[i] = _index(place["segment"], bird.segments.names, f"{name}: segment")
            position[i] = _numbers([place.get("position", 1.0)], 1, f"{name}: position")[0]
        elif kind == {"feather"}:
            feathers = [each.name for each in bird.feathers]
            feather[i] = _index(place["feather"], feathers, f"{name}: feather")
        elif kind == {"body"}:
            root = bird.wing.root
            fixed[i] = _numbers(place["body"], 3, f"{name}: body") - (root.x, root.y, root.z)
        else:
            raise KinematicsError(
                f"the marker {name} must be on a segment, a feather or the body, as "
                '{ segment = "humerus", position = 1 }, { feather = "1" } or '
                "{ body = [0.1, 0, 0] }."
            )
    return Markers(names, bone, position, feather, fixed)


def read_places(places: Places | str | PathLike[str] | None) -> Places:
    """Places of markers, of a TOML file where its path is given.

    Raises:
        KinematicsError: the file cannot be read, or holds something else than tables.
    """
    if places is None:
        return {}
    origin = "the places of markers"
    if isinstance(places, str | PathLike):
        origin = str(places)
        try:
            places = tomllib.loads(Path(places).read_text(encoding="utf-8"))
        except (OSError, ValueError, RecursionError) as error:
            raise KinematicsError(f"{origin}: cannot be read as TOML ({error}).") from error
    for name, place in places.items():
        if not isinstance(place, Mapping):
            raise KinematicsError(
                f'{origin}: {name} must be a table, such as {{ segment = "humerus" }}.'
            )
    return places


@kernel
def places_along(
    wing: WingArrays,
    bone: IntArray,
    position: FloatArray,
    feather: IntArray,
    fixed: FloatArray,
    angles: Array,
) -> Array:
    """Places (N, M, 3) m of markers from the shoulder, body axes, at angles (N, A), rad."""
    frames, count = angles.shape[0], bone.size
    places = np.zeros((frames, count, 3), angles.dtype)
    on_feathers = feather.size > 0 and feather.max() >= 0
    for n in range(frames):
        chain = joint_chain(wing, angles[n])
        if on_feathers:
            tips = trailing_edge(wing, chain, angles[n])
        for m in range(count):
            if feather[m] >= 0:
                places[n, m] = tips[feather[m]]
            elif bone[m] >= 0:
                out = chain.rotation[bone[m]][:, 1]
                along = position[m] * wing.bone_length[bone[m]]
                places[n, m] = chain.origin[bone[m]] + along * out
            else:
                for i in range(3):
                    places[n, m, i] = fixed[m, i]
    return places


def _by_default(bird: Bird) -> dict[str, dict[str, Any]]:
    """The shoulder, ends of segments, tips of feathers, and the joints of a three-bone wing."""
    names = bird.segments.names
    known: dict[str, dict[str, Any]] = {SHOULDER: {"segment": names[0], "position": 0.0}}
    if len(names) == len(_OF_THREE):
        known |= {name: {"segment": bone} for name, bone in zip(_OF_THREE, names, strict=True)}
    known |= {f"{bone}.end": {"segment": bone} for bone in names}
    return known | {f"feathers.{one.name}": {"feather": one.name} for one in bird.feathers}


def _index(name: object, known: Collection[str], what: str) -> int:
    if name not in known:
        raise KinematicsError(
            f"the marker {what} {shown(name)} is none of the bird; there are {', '.join(known)}."
        )
    return list(known).index(str(name))


def _numbers(given: object, count: int, what: str) -> FloatArray:
    try:
        numbers = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        numbers = np.empty(0)
    if numbers.shape != (count,) or not np.isfinite(numbers).all():
        wanted = "a number" if count == 1 else "three numbers, [x, y, z] in m"
        raise KinematicsError(f"the marker {what} must be {wanted}.")
    return numbers
