"""The terminal, or the file in its place, as the commands write to it."""

from __future__ import annotations

import shutil

import typer
from rich.console import Console

_NARROWEST = 24
_NARROWEST_FRAME = 76


def fit_help(app: typer.Typer) -> None:
    """Have help written without frames on a narrow terminal, where these would cut words."""
    columns = shutil.get_terminal_size().columns
    if columns < _NARROWEST_FRAME:
        app.rich_markup_mode = None
        settings = app.info.context_settings or {}
        app.info.context_settings = {**settings, "terminal_width": max(columns, _NARROWEST)}


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
