"""Checks of a wing's parts: each on a segment that there is, and chords all along the wing."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import TypeVar

from pydantic import ValidationInfo

from birdmb.text import nearest
from birdmb.topology.feathers import Feather
from birdmb.topology.messages import problem, shown
from birdmb.topology.named import NamedParts
from birdmb.topology.sections import Section
from birdmb.topology.segments import Segments

ChordT = TypeVar("ChordT", Feather, Section)


def segment_names(info: ValidationInfo) -> tuple[str, ...] | None:
    """Names of the segments, or `None` where something is wrong with these."""
    segments: Segments | None = info.data.get("segments")
    return None if segments is None else segments.names


def no_segment(name: str, known: Sequence[str]) -> str:
    """Sentence about a name that is none of the `known` segments."""
    return f"no segment is called {shown(name)}; the nearest: {nearest(name, known)}"


def require_segment(name: str, known: Sequence[str], item: int, key: str) -> None:
    """Raise a validator's error about an item's key that must name one of the `known` segments."""
    if name not in known:
        raise problem(no_segment(name, known), item, key)


def from_shoulder_to_tip(
    chords: NamedParts[ChordT], kind: str, segments: tuple[str, ...] | None
) -> NamedParts[ChordT]:
    """Feathers or sections in their order along the wing, which must reach from end to end."""
    if twice := first_repeated(one.name for one in chords):
        raise problem(f"two {kind}s are called {shown(twice)}; each needs a name of its own")
    if segments is None or not chords:
        return chords
    for i, one in enumerate(chords):
        require_segment(one.bone, segments, i, "bone")

    def place(one: ChordT) -> float:
        return segments.index(one.bone) + one.position

    ordered = NamedParts(sorted(chords, key=place))
    for inner, outer in pairwise(ordered):
        if place(inner) == place(outer):
            raise problem(
                f"{shown(inner.name)} and {shown(outer.name)} have the same place; "
                f"each {kind} needs a place of its own"
            )
    if place(ordered[0]) != 0:
        raise problem(f"none is at the shoulder; one must be (bone {segments[0]}, position 0)")
    if place(ordered[-1]) != len(segments):
        last = segments[-1]
        raise problem(f"none is at the {last}'s tip; one must be (bone {last}, position 1)")
    return ordered


def first_repeated(names: Iterable[str]) -> str | None:
    """The first name that was there before; `None` if there is none."""
    seen: set[str] = set()
    for name in names:
        if name in seen:
            return name
        seen.add(name)
    return None
