"""How a command ends: its exit status, and errors as one sentence each."""

from __future__ import annotations

import json
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import typer

from birdmb.cli.interrupt import INTERRUPTED, INTERRUPTED_LINE
from birdmb.errors import BirdmbError, OrbitError, StateError

NO_CYCLE = 1
BAD_INPUT = 2


class InputError(BirdmbError):
    """The command line asks for something that cannot be done."""


class _WithReached(BirdmbError):  # noqa: N818 - what it is for is in the names below
    """An error that keeps what was reached in `reached`, fit for JSON."""

    def __init__(self, message: str, reached: dict[str, object]) -> None:
        super().__init__(message, reached)
        self.reached = reached

    def __str__(self) -> str:
        """The sentence alone."""
        return str(self.args[0])


class SearchFailed(_WithReached):
    """The search found no limit cycle; `reached` is what it had."""


class ResultUnwrittenError(_WithReached, InputError):
    """A file could not be written; `reached` is the result that it was for."""


@contextmanager
def reported(*, as_json: bool = False) -> Iterator[None]:
    """Turn every deliberate error into a sentence on standard error and an exit status.

    `as_json` puts an object with the key "error" on standard output besides.
    """
    try:
        with _warnings_as_sentences():
            yield
    except KeyboardInterrupt:
        typer.echo(INTERRUPTED_LINE, err=True)
        raise typer.Exit(INTERRUPTED) from None
    except OSError as error:
        if error.filename is None:  # of a standard stream
            raise
        typer.echo(f"Error: {error.filename}: {(error.strerror or str(error)).lower()}.", err=True)
        raise typer.Exit(BAD_INPUT) from None
    except BirdmbError as error:
        sentence = " ".join(str(error).split())  # arrays in it may have been broken over lines
        typer.echo(f"Error: {sentence}", err=True)
        if as_json:
            reached = error.reached if isinstance(error, _WithReached) else {}
            json.dump({"error": sentence, **reached}, sys.stdout, indent=2, allow_nan=False)
            typer.echo()
        raise typer.Exit(_status(error)) from None


@contextmanager
def _warnings_as_sentences() -> Iterator[None]:
    """Show Python's warnings as one line each, without the place in the source."""

    def show(message: Warning | str, *_: object, **__: object) -> None:
        typer.echo(f"Warning: {' '.join(str(message).split())}", err=True)

    with warnings.catch_warnings():
        warnings.showwarning = show
        yield


def _status(error: BirdmbError) -> int:
    # A wrong option, such as a negative tolerance, is an OrbitError by its origin.
    if isinstance(error, ValueError):
        return BAD_INPUT
    failed = isinstance(error, OrbitError | StateError | SearchFailed)
    return NO_CYCLE if failed else BAD_INPUT
