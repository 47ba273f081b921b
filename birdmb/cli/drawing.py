"""Pictures that do not depend on what the user has set up for matplotlib."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

from birdmb.cli.outcome import InputError


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


@contextmanager
def plain_style() -> Iterator[None]:
    """Draw within by matplotlib's own defaults: without LaTeX, whatever a file here asks for."""
    import matplotlib as mpl  # noqa: PLC0415 - takes a second

    with mpl.rc_context():
        mpl.rcdefaults()
        yield
