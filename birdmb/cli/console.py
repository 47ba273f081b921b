"""The terminal, or the file in its place, as the commands write to it."""

from __future__ import annotations

from rich.console import Console

_NARROWEST = 24


def output() -> Console:
    """Standard output, for tables and verdicts.

    A name is never markup, and digits are never cut off: on a narrow terminal tables become lists
    (`birdmb.cli.tables`), and one that is narrower than any number breaks the lines.
    """
    console = Console(markup=False, emoji=False)
    return Console(markup=False, emoji=False, width=max(console.width, _NARROWEST))


def messages() -> Console:
    """Standard error, for progress."""
    return Console(stderr=True, markup=False, emoji=False)
