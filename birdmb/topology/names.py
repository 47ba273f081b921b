"""Names in a topology file: one short line each, since reports, figures and files carry them."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator

from birdmb.topology.messages import problem, shown

_LONGEST = 100  # characters, the width of a report


def _one_short_line(name: str) -> str:
    if not name.strip():
        raise problem(f"{shown(name)} is no name; it must have a letter or digit")
    if len(name) > _LONGEST:
        raise problem(f"has {len(name)} characters; it must have {_LONGEST} or less")
    if not name.isprintable():
        raise problem(f"{shown(name)} has a control character; it must be one line of text")
    return name


Label = Annotated[str, AfterValidator(_one_short_line)]
