"""Files of figures: their formats."""

from __future__ import annotations

import io
from pathlib import Path

from matplotlib.figure import Figure

from birdmb.errors import ArgumentError
from birdmb.files import write_whole

FORMATS = ("png", "pdf", "svg")
_DOTS_PER_INCH = 150  # on a screen; on paper twice as many
_PAPER = 5.0  # in: narrower figures are printed
# The same figure is the same file, whenever it is drawn.
_UNDATED = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}


def formats_of(text: str) -> tuple[str, ...]:
    """Formats listed in a text as "pdf,svg,png"; raises `ArgumentError` for what is none."""
    listed = tuple(dict.fromkeys(each.strip().lower() for each in text.split(",")))
    for each in listed:
        if each not in FORMATS:
            raise ArgumentError(
                f"format: {each!r} is no format of figures; it must be one or more of "
                f"{', '.join(FORMATS)}, separated by commas."
            )
    return listed


def save_figure(figure: Figure, path: Path) -> Path:
    """Write a figure in the format of the file's name, whole or not at all.

    Raises:
        ArgumentError: the name ends in no format of figures.
        OutputError: the file cannot be written.
    """
    (kind,) = formats_of(path.suffix.removeprefix("."))
    content = io.BytesIO()
    dots = _DOTS_PER_INCH * (2 if figure.get_figwidth() < _PAPER else 1)
    figure.savefig(content, format=kind, dpi=dots, metadata=_UNDATED.get(kind))
    return write_whole(path, content.getvalue())
