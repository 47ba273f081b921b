"""All printed numbers with how to compute them."""

from __future__ import annotations

from birdmb.errors import ArgumentError
from birdmb.reproduction import (
    appendices,
    chapter3,
    chapter5,
    chapter6,
    chapter7,
    chapter8,
)
from birdmb.reproduction.published import Case

_MODULES = (chapter3, chapter5, chapter6, chapter7, chapter8, appendices)


def published_cases(chapter: str | None = None, *, long: bool = False) -> list[Case]:
    """The cases of a chapter or an appendix, or of all, those that take long only if asked for.

    Raises:
        ArgumentError: no case belongs to that chapter.
    """
    cases = [case for module in _MODULES for case in module.CASES]
    chapters = list(dict.fromkeys(case.chapter for case in cases))
    if chapter is not None and chapter not in chapters:
        raise ArgumentError(
            f"no printed numbers of chapter {chapter!r}; there are {', '.join(chapters)}."
        )
    return [
        case
        for case in cases
        if (chapter is None or case.chapter == chapter) and (long or not case.long)
    ]
