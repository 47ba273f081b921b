"""A list of parts that each have a name: by position, or by name."""

from __future__ import annotations

from collections.abc import Iterator
from types import GenericAlias
from typing import Any, Protocol, SupportsIndex, TypeVar, get_args, overload

from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from birdmb.errors import UnknownKeyError
from birdmb.summary import Fact, Summarised
from birdmb.text import nearest


class HasName(Protocol):
    """What has a name."""

    @property
    def name(self) -> str:
        """The name."""


PartT = TypeVar("PartT", bound=HasName)


class NamedParts(Summarised, tuple[PartT, ...]):
    """Parts in order; `joints["shoulder.flap"]` is the one of that name, `joints[0]` the first."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parts, in order."""
        return tuple(part.name for part in self)

    @overload
    def __getitem__(self, key: SupportsIndex | str, /) -> PartT: ...

    @overload
    def __getitem__(self, key: slice, /) -> tuple[PartT, ...]: ...

    def __getitem__(self, key: SupportsIndex | slice | str, /) -> PartT | tuple[PartT, ...]:
        """Return a part by its name or its position, or some of them.

        Raises:
            UnknownKeyError: there is none of that name.
        """
        if not isinstance(key, str):
            return super().__getitem__(key)
        for part in self:
            if part.name == key:
                return part
        known = nearest(key, self.names) or "there are none"
        raise UnknownKeyError(f'none is called "{key}"; the nearest: {known}.')

    def _heading(self) -> str:
        return f"{len(self)} {type(self[0]).__name__.lower()}s" if self else "none"

    def _summary(self) -> Iterator[Fact]:
        yield from (Fact("", name) for name in self.names)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.names)

    @classmethod
    def __get_pydantic_core_schema__(
        cls, annotation: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Tell pydantic to take what it takes for a tuple of the parts."""
        return core_schema.no_info_after_validator_function(
            cls, handler(GenericAlias(tuple, (get_args(annotation)[0], ...)))
        )
