"""The segments of a wing, from the shoulder outwards, by names of the user's.

Segment frame, bone straight out: the directions of the body frame, with y along the bone outwards.
"""

from __future__ import annotations

from collections.abc import ItemsView, Iterator
from typing import Annotated

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field, RootModel

from birdmb.errors import UnknownKeyError, no_attribute
from birdmb.summary import Fact, Summarised
from birdmb.text import nearest
from birdmb.topology.inertia import Tensor, from_diagonal, possible_inertia
from birdmb.topology.messages import problem, shown
from birdmb.topology.names import Label
from birdmb.topology.numbers import Coordinate, Length, MassOrNone
from birdmb.topology.parts import OF_PYDANTIC, Part


class Segment(Part):
    """A rigid segment of the wing; zero inertia makes it a point mass."""

    length: Length = Field(description="length of the bone, m")
    mass: MassOrNone = Field(description="mass of the segment of one wing, kg")
    inertia: Annotated[Tensor, BeforeValidator(from_diagonal), AfterValidator(possible_inertia)] = (
        Field(
            description="inertia about the segment's centre of mass, kg m2: three moments about "
            "x, y, z or a 3x3 tensor"
        )
    )
    centre_of_mass: tuple[Coordinate, Coordinate, Coordinate] = Field(
        default_factory=lambda validated: (0.0, validated["length"] / 2, 0.0),
        description="centre of mass from the segment's root, [x, y, z] in m; halfway along the "
        "bone if left out",
    )


def _named(segments: dict[str, Segment]) -> dict[str, Segment]:
    if not segments:
        raise problem("empty; a wing needs one segment at least, as [segments.arm]")
    for name in segments:
        if not name.replace("_", "").replace("-", "").isalnum():
            raise problem(f"{shown(name)} is no name; it must be of letters, digits, _ and - only")
    return segments


class Segments(Summarised, RootModel[Annotated[dict[Label, Segment], AfterValidator(_named)]]):
    """The segments of a wing by name, from the shoulder outwards.

    `segments["hand"]` and `segments.hand` are the same; iteration goes over the names.
    """

    model_config = ConfigDict(frozen=True)

    def __getitem__(self, name: str) -> Segment:
        """Return the segment of that name; raise `UnknownKeyError` if there is none."""
        if name not in self.root:
            known = nearest(str(name), self.root)
            raise UnknownKeyError(f"no segment is called {shown(name)}; the nearest: {known}.")
        return self.root[name]

    def __getattr__(self, name: str) -> Segment:
        """Return the segment of that name; raise `UnknownNameError` if there is none."""
        if name.startswith("_"):
            raise AttributeError(name)
        segments: dict[str, Segment] = self.__dict__["root"]
        if name not in segments:
            raise no_attribute(type(self).__name__, name, dir(self))
        return segments[name]

    def __dir__(self) -> list[str]:
        """Names for completion: the segments, and what is not of pydantic's base class."""
        own = [name for name in super().__dir__() if name not in OF_PYDANTIC | {"root"}]
        return [*own, *filter(str.isidentifier, self.root)]

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.root)

    def __str__(self) -> str:
        """Return the same as for a console."""
        return repr(self)

    def _summary(self) -> Iterator[Fact]:
        for name, segment in self.root.items():
            yield Fact(name, f"{segment.length:.4g} m, {segment.mass:.4g} kg")

    def __iter__(self) -> Iterator[str]:  # type: ignore[override]
        """Iterate over the names, from the shoulder outwards."""
        return iter(self.root)

    def __len__(self) -> int:
        """Number of segments."""
        return len(self.root)

    def __hash__(self) -> int:
        """Hash of names and segments."""
        return hash(tuple(self.root.items()))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the segments, from the shoulder outwards."""
        return tuple(self.root)

    def items(self) -> ItemsView[str, Segment]:
        """Names and segments, from the shoulder outwards."""
        return self.root.items()
