"""Pictures that do not depend on what the user has set up for matplotlib."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from birdmb.cli.outcome import InputError
from birdmb.errors import ArgumentError

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def ignore_settings() -> None:
    """Keep matplotlib, before it is imported, from the user's backend and settings.

    A notebook's backend need not be installed here, and a file of settings may be damaged.
    """
    os.environ["MPLBACKEND"] = "agg"
    os.environ["MATPLOTLIBRC"] = os.devnull
    if Path("matplotlibrc").is_file():  # which matplotlib prefers to all others
        try:
            import_module("matplotlib")
        except UnicodeDecodeError as error:
            raise InputError(
                f"{Path('matplotlibrc').absolute()}: is no text in UTF-8, so that matplotlib does "
                "not start in this directory; mend it or remove it."
            ) from error


@dataclass(frozen=True)
class Pictures:
    """What `--format` and `--width` ask for.

    Attributes:
        formats: of the files, "png" and others.
        width: of the page or column, as "90mm"; `None` for the screen.
    """

    formats: tuple[str, ...] = ("png",)
    width: str | None = None

    @contextmanager
    def style(self) -> Iterator[None]:
        """Draw within by the defaults of matplotlib and of this package.

        Without LaTeX, whatever a file here asks for.
        """
        import matplotlib as mpl  # noqa: PLC0415 - takes a second

        from birdmb.figures.page import paper  # noqa: PLC0415 - takes time

        with mpl.rc_context():
            mpl.rcdefaults()
            with paper(self.width):
                yield

    def names(self, stem: str) -> list[str]:
        """Names of the files of a figure."""
        return [f"{stem}.{kind}" for kind in self.formats]

    def write(self, directory: Path, stem: str, figure: Figure) -> list[Path]:
        """Write a figure in all formats."""
        from birdmb.figures.saving import save_figure  # noqa: PLC0415 - takes time

        return [save_figure(figure, directory / name) for name in self.names(stem)]


def requested_pictures(
    formats: str | None, width: str | None, file: Path | None = None
) -> Pictures:
    """What the options say, and the ending of a file where they leave the format to it.

    Raises:
        InputError: there is no such format, or width.
    """
    formats = formats or (file.suffix.removeprefix(".") if file is not None else None)
    if formats is None and width is None:  # matplotlib is slow to import
        return Pictures()
    from birdmb.figures.page import inches  # noqa: PLC0415 - takes time
    from birdmb.figures.saving import formats_of  # noqa: PLC0415 - takes time

    try:
        if width is not None:
            inches(width)
        return Pictures(formats_of(formats or "png"), width)
    except ArgumentError as error:
        raise InputError(f"--{error}") from error
